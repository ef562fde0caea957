#include <algorithm>
#include <array>
#include <charconv>

#include "sage/deck/read_deck.hpp"
#include "sage/deck/text.hpp"
#include "sage/deck/wide_layout.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model_file/keys.hpp"
#include "sage/model_file/model_file.hpp"

namespace sage {

namespace model_file {

namespace {

std::string in_quotes(std::string_view text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c;
  }
  return all + '"';
}

std::string real_text(double value) {
  std::string text = number_text(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string whole_text(double value) {
  return std::to_string(static_cast<long>(value));
}

template <class Entry>
std::string name_of(const Registry<Entry>& registry, double code) {
  const Entry* entry = registry.find(static_cast<int>(code));
  return entry != nullptr ? in_quotes(entry->name) : whole_text(code);
}

// The cards of a deck of layout sage1_wide as tables.
class Writer {
 public:
  Writer(const Deck& deck, const Catalogue& catalogue) : deck_(deck), catalogue_(catalogue) {}

  std::string text();

 private:
  using Pairs = std::vector<std::pair<std::string, std::string>>;

  // Keys and values of a card's fields that are not blank.
  Pairs pairs(const CardView& card, const Table& table) const;
  std::string value(const CardView& card, const Key& key) const;
  std::string list(const CardView& card, const Key& key) const;
  std::string formulation(const CardView& card, double code) const;
  void add_materials();
  void add_stages();
  void add_reports();
  // key = [ {...}, {...} ], a line each.
  void add_lines(std::string_view key, const std::vector<CardView>& cards, const Table& table);
  // [[key]] and a line for each pair.
  void add_table(const std::string& heading, const Pairs& all);

  const Deck& deck_;
  const Catalogue& catalogue_;
  std::string text_;
};

std::string Writer::formulation(const CardView& card, double code) const {
  const ElementEntry* entry = catalogue_.elements.find(card.integer("element"));
  if (entry != nullptr)
    for (const Formulation& one : entry->formulations)
      if (one.code == static_cast<int>(code)) return in_quotes(one.name);
  return whole_text(code);
}

std::string Writer::list(const CardView& card, const Key& key) const {
  std::string text;
  if (key.want == Want::nodes || key.want == Want::values) {
    int count = 0;
    for (int i = 1; i <= kWideNodes; ++i)
      if (!card.blank(key.field + std::to_string(i))) count = i;
    for (int i = 1; i <= count; ++i) {
      const double one = card.real(key.field + std::to_string(i));
      text += (i > 1 ? ", " : "") + (key.want == Want::nodes ? whole_text(one) : real_text(one));
    }
    return count > 0 ? "[" + text + "]" : "";
  }
  const ValueList all = card.list(key.field);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].blank) continue;
    if (key.want == Want::pairs) {
      text += i % 2 == 0 ? std::string(i > 0 ? ", [" : "[") + real_text(all[i].number) + ", "
                         : real_text(all[i].number) + "]";
    } else {
      text += (text.empty() ? "" : ", ") + whole_text(all[i].number);
    }
  }
  return text.empty() ? "" : "[" + text + "]";
}

std::string Writer::value(const CardView& card, const Key& key) const {
  const double number = card.real(key.field);
  switch (key.want) {
    case Want::text:
      return in_quotes(card.text(key.field));
    case Want::real:
      return real_text(number);
    case Want::flag:
      return number != 0.0 ? "true" : "false";
    case Want::code:
      for (const CodeName& one : key.codes)
        if (one.code == static_cast<int>(number)) return in_quotes(one.name);
      return whole_text(number);
    case Want::law:
      return name_of(catalogue_.materials, number);
    case Want::element:
      return name_of(catalogue_.elements, number);
    case Want::solver:
      return name_of(catalogue_.solvers, number);
    case Want::formulation:
      return formulation(card, number);
    default:
      return whole_text(number);
  }
}

// What the layout has a value for goes without saying: a zero of a code that is no first choice of its own.
bool says_nothing(const CardView& card, const Key& key) {
  const bool zero = !card.blank(key.field) && card.real(key.field) == 0.0;
  const bool optional = key.want == Want::integer || key.want == Want::flag || key.want == Want::formulation ||
                        key.want == Want::solver || key.want == Want::group;
  return zero && optional && !key.required && !key.fallback;
}

Writer::Pairs Writer::pairs(const CardView& card, const Table& table) const {
  Pairs all;
  for (const Key& key : table.keys) {
    if (key.field.empty()) continue;
    const bool is_list = key.want == Want::nodes || key.want == Want::values || key.want == Want::integers ||
                         key.want == Want::groups || key.want == Want::pairs;
    if (is_list) {
      if (std::string text = list(card, key); !text.empty()) all.emplace_back(key.key, std::move(text));
    } else if (!card.blank(key.field) && !says_nothing(card, key)) {
      all.emplace_back(key.key, value(card, key));
    }
  }
  return all;
}

void Writer::add_lines(std::string_view key, const std::vector<CardView>& cards, const Table& table) {
  if (cards.empty()) return;
  text_.append(key) += " = [\n";
  for (const CardView& card : cards) {
    std::string line;
    for (const auto& [name, value] : pairs(card, table))
      line += (line.empty() ? "" : ", ") + name + " = " + value;
    text_ += "  {" + line + "},\n";
  }
  text_ += "]\n";
}

void Writer::add_table(const std::string& heading, const Pairs& all) {
  text_ += "\n" + heading + "\n";
  for (const auto& [name, value] : all) text_ += name + " = " + value + "\n";
}

void Writer::add_materials() {
  for (const CardView& card : deck_.all("material")) {
    Pairs all = pairs(card, table("material"));
    const MaterialEntry* entry = catalogue_.materials.find(card.integer("law"));
    std::size_t i = 0;
    std::string properties;
    for (const CardView& values : deck_.all("parameters", card))
      for (const FieldValue& one : values.list("values")) {
        if (!one.blank && entry != nullptr && i < entry->parameters.size())
          all.emplace_back(entry->parameters[i].name, real_text(one.number));
        else if (entry != nullptr && entry->open_ended && i >= entry->parameters.size())
          properties += (properties.empty() ? "" : ", ") + real_text(one.blank ? 0.0 : one.number);
        ++i;
      }
    if (!properties.empty()) all.emplace_back("props", "[" + properties + "]");
    add_table("[[material]]", all);
  }
  for (const CardView& card : deck_.all("group")) add_table("[[group]]", pairs(card, table("group")));
}

void Writer::add_stages() {
  const std::vector<CardView> titles = deck_.all("stage_title");
  std::size_t number = 0;
  for (const CardView& card : deck_.all("stage")) {
    Pairs all = pairs(card, table("stage"));
    if (number < titles.size() && !titles[number].blank("title"))
      all.insert(all.begin(), {"title", in_quotes(titles[number].text("title"))});
    ++number;
    for (const char* key : {"birth", "death"})
      for (const CardView& groups : deck_.all(key, card))
        all.emplace_back(key, list(groups, *table("stage").find(key)));
    add_table("[[stage]]", all);
    for (const char* key : {"fixity", "load", "pressure", "initial"})
      add_lines(key, deck_.all(key, card), table(std::string("stage.") + key));
  }
}

void Writer::add_reports() {
  constexpr std::string_view kOfPoint[] = {"x", "y", "name", "end_x", "end_y"};
  for (const CardView& card : deck_.all("report")) {
    Pairs all = pairs(card, table("report"));
    for (const CardView& place : deck_.all("point", card))
      for (const auto& pair : pairs(place, table("report")))
        if (std::ranges::find(kOfPoint, pair.first) != std::end(kOfPoint)) all.push_back(pair);
    add_table("[[report]]", all);
  }
  for (const CardView& card : deck_.all("water")) add_table("[[water]]", pairs(card, table("water")));
}

// Cards of stages have an owner; what stands outside of stages has none.
std::vector<CardView> without_owner(const std::vector<CardView>& cards) {
  std::vector<CardView> list;
  for (const CardView& card : cards)
    if (card.card().owner < 0) list.push_back(card);
  return list;
}

std::string Writer::text() {
  if (deck_.has("title")) text_ += "title = " + in_quotes(deck_.one("title").text("title")) + "\n";
  for (const auto& [name, value] : pairs(deck_.one("control"), table("")))
    if (name != "title") text_ += name + " = " + value + "\n";
  for (const char* key : {"node", "fill", "element"}) add_lines(key, deck_.all(key), table(key));
  for (const char* key : {"fixity", "initial"}) add_lines(key, without_owner(deck_.all(key)), table(key));
  if (deck_.has("units")) add_table("[units]", pairs(deck_.one("units"), table("units")));
  add_materials();
  add_stages();
  add_reports();
  return std::move(text_);
}

}  // namespace
}  // namespace model_file

std::string model_file_text(const Model& model, const Catalogue& catalogue, Diagnostics& diagnostics) {
  const Layout layout = load_layout(std::string(kWideLayout));
  const std::string cards = sage1_text(model, diagnostics, FieldWidth::wide);
  std::string plugins;
  for (const std::string& one : model.plugins)
    plugins += (plugins.empty() ? "" : ", ") + model_file::in_quotes(one);
  const std::string head = plugins.empty() ? "" : "plugins = [" + plugins + "]\n";
  return head + model_file::Writer(read_deck_text(cards, model.file, layout), catalogue).text();
}

}  // namespace sage
