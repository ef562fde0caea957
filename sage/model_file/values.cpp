#include "sage/model_file/values.hpp"

#include <algorithm>
#include <cmath>

#include "sage/messages/near_names.hpp"
#include "sage/model_file/unit_of.hpp"

namespace sage::model_file {

namespace {

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

template <class Entry>
std::vector<CodeName> entries_of(const Registry<Entry>& registry) {
  std::vector<CodeName> list;
  for (const auto& [code, entry] : registry.entries()) list.push_back({code, entry.name});
  return list;
}

// What may stand for the number of a material or a group.
}  // namespace

SourcePosition Values::place(const toml::source_region& region) const {
  constexpr unsigned kLast = 60000;  // columns are kept in 16 bits
  const unsigned first = std::min<unsigned>(region.begin.column, kLast);
  const bool one_line = region.end.line == region.begin.line && region.end.column > region.begin.column;
  const unsigned last = one_line ? std::min<unsigned>(region.end.column - 1, kLast) : first;
  return {from_.file, static_cast<int>(region.begin.line), static_cast<int>(first), static_cast<int>(last)};
}

std::vector<const toml::table*> Values::entries(const toml::table& given, std::string_view key) {
  std::vector<const toml::table*> list;
  const toml::node* node = given.get(key);
  if (node == nullptr) return list;
  const std::string name(key);
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    error("S152", where(*node),
          name + " is a list of tables: [[" + name + "]], or " + name + " = [{...}, {...}]");
    return list;
  }
  for (const toml::node& one : *array) {
    if (const toml::table* entry = one.as_table())
      list.push_back(entry);
    else
      error("S152", where(one), "an entry of " + name + " is a table of keys and values");
  }
  return list;
}

void Values::know_keys(const toml::table& given, const Table& table, const MaterialEntry* law) {
  std::vector<std::string> known;
  for (const Key& key : table.keys) known.push_back(key.key);
  const std::string prefix = table.key.empty() ? "" : table.key + ".";
  for (const Table& other : tables())
    if (other.key.size() > prefix.size() && other.key.starts_with(prefix) &&
        other.key.find('.', prefix.size()) == std::string::npos)
      known.push_back(other.key.substr(prefix.size()));
  if (table.key.empty()) known.push_back("plugins");
  if (law != nullptr) {
    for (const Parameter& parameter : law->parameters) known.push_back(parameter.name);
    if (law->open_ended) known.push_back("props");
  }
  for (const auto& [key, node] : given) {
    const std::string name(key.str());
    if (std::ranges::find(known, name) != known.end()) continue;
    const std::string whose = table.key.empty() ? "a model file" : "the table " + table.key;
    error("S151", place(key.source()),
          whose + " has no key \"" + name + "\"" + did_you_mean(name, known) + "; known: " + list_of(known));
  }
}

void Values::list_names(const toml::table& root, Numbered& all) {
  int last = 0;
  for (const toml::table* one : entries(root, all.what)) {
    const toml::node* given = one->get("number");
    last = given != nullptr ? given->value<int>().value_or(0) : last + 1;
    const toml::node* name = one->get("name");
    if (name == nullptr || !name->is_string()) continue;
    const auto [at, added] = all.by_name.try_emplace(name->value_or(std::string()), last);
    if (!added) at->second = 0;
  }
}

bool Values::flag(const toml::node& node, const std::string& label) {
  if (!node.is_boolean()) error("S152", where(node), "the " + label + " is true or false");
  return node.value_or(false);
}

double Values::integer(const toml::node& node, const std::string& label) {
  const auto value = node.value_exact<std::int64_t>();
  if (value && std::abs(*value) < std::int64_t{1} << 31) return static_cast<double>(*value);
  error("S152", where(node), "the " + label + " is a whole number");
  return 0.0;
}

// "50 MPa" in the unit that the model has for it.
double Values::with_unit(const toml::node& node, const std::string& text, const std::string& label,
                         const std::string& unit) {
  std::size_t digits = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &digits);
  } catch (const std::exception&) {
    digits = 0;
  }
  if (digits == 0) {
    error("S152", where(node), "the " + label + " is a number, or a number and its unit in quotes: \"50 MPa\"");
    return 0.0;
  }
  const std::optional<Unit> given = unit_of(std::string_view(text).substr(digits)), own = unit_of(unit);
  if (!given) {
    error("S154", where(node),
          "\"" + text.substr(digits) + "\" is no unit that the program knows (docs/manual/model_file.md)");
  } else if (!own) {
    error("S154", where(node),
          "the " + label + " takes no unit here: the model measures it in \"" + unit + "\"");
  } else if (!given->same_kind(*own)) {
    error("S154", where(node),
          "the " + label + " is measured in " + unit + ", which \"" + text.substr(digits) +
              "\" can't be turned into");
  } else {
    return value * (given->size / own->size);
  }
  return 0.0;
}

double Values::number(const toml::node& node, const std::string& label, const std::string& unit) {
  if (const auto whole = node.value_exact<std::int64_t>()) return static_cast<double>(*whole);
  if (const auto text = node.value_exact<std::string>()) return with_unit(node, *text, label, unit);
  const auto value = node.value_exact<double>();
  if (value && std::isfinite(*value)) return *value;
  error("S152", where(node), value ? "the " + label + " is not finite" : "the " + label + " is a number");
  return 0.0;
}

double Values::code(const toml::node& node, const std::string& label, const std::vector<CodeName>& codes) {
  if (const auto value = node.value_exact<std::int64_t>(); value && std::abs(*value) < 1'000'000'000)
    return static_cast<double>(*value);
  std::vector<std::string> names;
  for (const CodeName& one : codes) names.push_back(one.name);
  if (const auto name = node.value_exact<std::string>()) {
    for (const CodeName& one : codes)
      if (one.name == *name) return one.code;
    error("S153", where(node),
          "the " + label + " \"" + *name + "\" is unknown" + did_you_mean(*name, names) +
              "; known: " + list_of(names));
  } else {
    error("S152", where(node), "the " + label + " is one of these in quotes: " + list_of(names));
  }
  return 0.0;
}

std::string Values::text(const toml::node& node, const std::string& label) {
  const auto value = node.value_exact<std::string>();
  if (!value) error("S152", where(node), "the " + label + " is a text in quotes");
  return value.value_or("");
}

double Values::one_of(const toml::node& node, const Numbered& all) {
  if (const auto value = node.value_exact<std::int64_t>(); value && std::abs(*value) < 1'000'000'000)
    return static_cast<double>(*value);
  const auto name = node.value_exact<std::string>();
  if (!name) {
    error("S152", where(node), "a " + all.what + " is given by its name or number");
    return 0.0;
  }
  if (const auto found = all.by_name.find(*name); found != all.by_name.end()) {
    if (found->second == 0)
      error("S153", where(node),
            "several of [[" + all.what + "]] have the name \"" + *name + "\": give the number");
    return found->second;
  }
  std::vector<std::string> names;
  for (const auto& [one, number] : all.by_name) names.push_back(one);
  error("S153", where(node),
        "no [[" + all.what + "]] has the name \"" + *name + "\"" + did_you_mean(*name, names));
  return 0.0;
}

double Values::formulation(const toml::table& group, const toml::node& node) {
  std::vector<CodeName> codes;
  const toml::node* element = group.get("element");
  const ElementEntry* entry = nullptr;
  if (element != nullptr) {
    const auto name = element->value_exact<std::string>();
    entry = catalogue.elements.find(name ? catalogue.elements.code_of(*name) : element->value_or(0));
  }
  if (entry == nullptr) return 0.0;  // that is an error by itself
  for (const Formulation& one : entry->formulations) codes.push_back({one.code, one.name});
  return code(node, "formulation of " + entry->name, codes);
}

void Values::add_list(const Key& key, const toml::node& node, std::vector<NewField>& to) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    error("S152", where(node), "the " + key.label + " stands in a list: [...]");
    return;
  }
  std::size_t i = 0;
  for (const toml::node& one : *array) {
    if (key.want == Want::groups) {
      add_groups(key, one, to);
      continue;
    }
    const bool own_field = key.want == Want::nodes || key.want == Want::values;
    const std::string field = own_field ? key.field + std::to_string(++i) : key.field;
    const double value = key.want == Want::values ? number(one, key.label, {}) : integer(one, key.label);
    to.push_back({field, value, where(one), {}});
  }
}

// All that a line or an area of the drawing has made, or one group.
void Values::add_groups(const Key& key, const toml::node& node, std::vector<NewField>& to) {
  const auto drawn = groups.drawn.find(node.value_or(std::string()));
  if (drawn == groups.drawn.end()) return to.push_back({key.field, one_of(node, groups), where(node), {}});
  for (const int number : drawn->second)
    to.push_back({key.field, static_cast<double>(number), where(node), {}});
}

void Values::add_pairs(const Key& key, const toml::node& node, std::vector<NewField>& to) {
  const toml::array* array = node.as_array();
  bool fits = array != nullptr;
  for (std::size_t i = 0; fits && i < array->size(); ++i) {
    const toml::array* pair = (*array)[i].as_array();
    fits = pair != nullptr && pair->size() == 2;
  }
  if (!fits) return error("S152", where(node), "the " + key.label + "s stand in pairs: [[x, y], [x, y]]");
  for (const toml::node& pair : *array)
    for (const toml::node& one : *pair.as_array())
      to.push_back({key.field, number(one, key.label, {}), where(one), {}});
}

// "length or degrees", "unit weights": no unit of the model's.
std::string Values::unit_of_key(const Key& key) const {
  if (key.unit.starts_with("length or"))
    return units.length;  // or degrees, of polar coordinates: without a unit
  if (key.unit == "length") return units.length;
  if (key.unit == "stress") return units.stress;
  if (key.unit == "force") return units.force;
  if (key.unit == "length^2") return units.length + "^2";
  if (key.unit == "force/length^3") return units.force + "/" + units.length + "^3";
  return key.unit;
}

void Values::add_value(const Key& key, const toml::table& given, const toml::node& node,
                       std::vector<NewField>& to) {
  double value = 0.0;
  switch (key.want) {
    case Want::integers:
    case Want::groups:
    case Want::nodes:
    case Want::values:
      return add_list(key, node, to);
    case Want::pairs:
      return add_pairs(key, node, to);
    case Want::text:
      if (const std::string words = text(node, key.label); !words.empty())
        to.push_back({key.field, 0.0, where(node), words});
      return;
    case Want::integer:
      value = integer(node, key.label);
      break;
    case Want::real:
      value = number(node, key.label, unit_of_key(key));
      break;
    case Want::flag:
      value = flag(node, key.label) ? 1.0 : 0.0;
      break;
    case Want::code:
      value = code(node, key.label, key.codes);
      break;
    case Want::law:
      value = code(node, "law", entries_of(catalogue.materials));
      break;
    case Want::element:
      value = code(node, "element", entries_of(catalogue.elements));
      break;
    case Want::solver:
      value = code(node, "solver", entries_of(catalogue.solvers));
      break;
    case Want::formulation:
      value = formulation(given, node);
      break;
    case Want::material:
      value = one_of(node, materials);
      break;
    case Want::group:
      value = one_of(node, groups);
      break;
    case Want::point:
    case Want::points:
    case Want::outlines:
    case Want::table:
      return;  // the drawing's
  }
  to.push_back({key.field, value, where(node), {}});
}

std::vector<NewField> Values::fields(const toml::table& given, const Table& table,
                                     std::initializer_list<std::string_view> without) {
  std::vector<NewField> list, last;  // lists stand behind all others
  for (const Key& key : table.keys) {
    if (key.field.empty() || std::ranges::find(without, key.key) != without.end()) continue;
    const toml::node* node = given.get(key.key);
    const bool is_list = key.want == Want::integers || key.want == Want::groups || key.want == Want::pairs;
    if (node != nullptr)
      add_value(key, given, *node, is_list ? last : list);
    else if (key.required && !key.fallback && key.key != "number")
      error("S155", where(given),
            (table.key.empty() ? "the model" : "the table " + table.key) + " needs its " + key.key + ", the " +
                key.label);
  }
  list.insert(list.end(), last.begin(), last.end());
  return list;
}

}  // namespace sage::model_file
