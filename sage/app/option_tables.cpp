#include "sage/app/option_tables.hpp"

#include <map>

#include "sage/deck/layout.hpp"
#include "sage/messages/messages.hpp"
#include "sage/messages/split_at.hpp"

namespace sage::app {

namespace {

template <class Entry>
std::vector<std::string> names_of(const Registry<Entry>& registry) {
  std::vector<std::string> names;
  for (const auto& [code, entry] : registry.entries()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> quadrilaterals(const Catalogue& catalogue) {
  std::vector<std::string> names;
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.solid() && entry.square()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> fields(const Catalogue& catalogue) {
  std::vector<std::string> names;
  for (const FieldEntry& row : catalogue.fields.rows()) names.push_back(row.name);
  return names;
}

// "a", "b" of a type's name like "TEXT:{a,b}"; none of another.
std::vector<std::string> choices_of_type(const std::string& type) {
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  const std::vector<std::string_view> choices =
      split_at(',', std::string_view(type).substr(begin + 1, end - begin - 1));
  return {choices.begin(), choices.end()};
}

// Values of options that check them by a function, which the parser can't list.  `name`: without its dashes and
// without the -b of the second deck of `compare`.
std::vector<std::string> choices_of_name(const std::string& name, const Catalogue& catalogue) {
  if (name == "solver") return names_of(catalogue.solvers);
  if (name == "element") return quadrilaterals(catalogue);
  if (name == "field") return fields(catalogue);
  if (name == "picture") {
    std::vector<std::string> names = fields(catalogue);
    for (const char* other : {"conf", "dev", "SL", "head", "flow_net", "stream_function", "pore_pressure"})
      names.emplace_back(other);
    return names;
  }
  if (name == "kernels") return {"auto", "avx2", "avx512"};
  if (name == "geometry") return {"1", "2"};
  if (name == "layout") return built_in_layouts();
  return {};
}

std::vector<std::string> codes() {
  std::vector<std::string> all;
  for (const MessageEntry& message : messages()) all.push_back(to_string(message.code));
  return all;
}

std::vector<std::string> choices_of(const CLI::Option& option, const Catalogue& catalogue) {
  if (option.get_items_expected_max() == 0) return {};
  std::vector<std::string> choices = choices_of_type(option.get_type_name());
  if (option.get_positional() && option.get_name(true) == "CODE") return codes();
  if (!choices.empty() || option.get_positional()) return choices;
  for (std::string name : option.get_lnames()) {
    if (name.ends_with("-b")) name.resize(name.size() - 2);
    choices = choices_of_name(name, catalogue);
    if (!choices.empty()) break;
  }
  return choices;
}

OptionRow option_row(const CLI::Option& option, const Catalogue& catalogue) {
  OptionRow row;
  row.positional = option.get_positional();
  if (row.positional) row.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  row.about = option.get_description();
  row.required = option.get_required();
  row.repeated = option.get_items_expected_max() > 1;
  row.choices = choices_of(option, catalogue);
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();
    row.value = row.positional ? row.names.front() : type.substr(0, type.find(':'));
    if (row.value.empty()) row.value = "TEXT";
  }
  return row;
}

}  // namespace

CommandRow command_row(const CLI::App& parser, const Catalogue& catalogue, const std::string& words) {
  CommandRow row;
  row.words = words;
  row.about = parser.get_description();
  row.footer = parser.get_footer();
  for (const CLI::Option* option : parser.get_options())
    if (!option->get_group().empty()) row.options.push_back(option_row(*option, catalogue));
  for (const CLI::App* part : parser.get_subcommands([](const CLI::App*) { return true; }))
    if (!part->get_group().empty())
      row.parts.push_back(command_row(*part, catalogue, words + " " + part->get_name()));
  return row;
}

}  // namespace sage::app
