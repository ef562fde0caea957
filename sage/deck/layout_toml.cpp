// Layout files: TOML -> Layout, with the layout file's own line in every complaint.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "sage/deck/layout.hpp"
#include "sage/deck/layout_names.hpp"
#include "sage/deck/text.hpp"
#include "sage/deck/toml_file.hpp"
#include "sage/messages/near_names.hpp"

namespace sage {

namespace {

constexpr std::size_t most_cards = 10000, most_fields = 1000;

class LayoutReader : private TomlFile {
 public:
  LayoutReader(const toml::table& root, std::string file) : TomlFile(std::move(file)), root_(root) {}

  Layout read() {
    layout_.file = file_;
    known_keys(root_,
               {"name", "title", "draft", "blanks", "comment", "record_length", "sequence_columns",
                "card_separator", "card_name_columns", "introduction", "closing", "example", "marks", "card"});
    layout_.name = text(root_, "name", true);
    layout_.title = text(root_, "title");
    layout_.draft = flag(root_, "draft");
    layout_.introduction = text(root_, "introduction");
    layout_.closing = text(root_, "closing");
    layout_.example = text(root_, "example");
    read_record_rules();
    read_marks();
    const toml::array* cards = root_["card"].as_array();
    if (!cards) fail(root_, "a layout needs [[card]] entries");
    read_entries(*cards, layout_.entries, 1);
    return std::move(layout_);
  }

 private:
  void read_record_rules() {
    const std::string blanks = text(root_, "blanks");
    if (!blanks.empty() && blanks != "null" && blanks != "zero")
      fail(*root_.get("blanks"), "blanks must be \"null\" or \"zero\"");
    layout_.records.blanks = blanks == "zero" ? BlankMode::zero : BlankMode::null;
    const std::string comment = text(root_, "comment");
    if (comment.size() > 1) fail(*root_.get("comment"), "comment must be one character");
    layout_.records.comment = comment.empty() ? '\0' : comment[0];
    layout_.records.record_length = integer(root_, "record_length", 0, 0, 10000);
    layout_.card_separator = text(root_, "card_separator");
    layout_.card_name_columns = integer(root_, "card_name_columns", 0, 0, 1000);
    if (!layout_.card_separator.empty())
      layout_.records.skip_columns =
          layout_.card_name_columns + static_cast<int>(layout_.card_separator.size());
    layout_.records.separator = layout_.card_separator;
    if (const toml::node* node = root_.get("sequence_columns")) {
      const toml::array* pair = node->as_array();
      if (!pair || pair->size() != 2 || !(*pair)[0].is_integer() || !(*pair)[1].is_integer())
        fail(*node, "sequence_columns must be [first, last]");
      layout_.first_sequence_column = static_cast<int>((*pair)[0].value_or(0));
      layout_.last_sequence_column = static_cast<int>((*pair)[1].value_or(0));
    }
  }

  void read_marks() {
    const toml::node* node = root_.get("marks");
    if (!node) return;
    const toml::array* marks = node->as_array();
    if (!marks) fail(*node, "marks must be an array of {line, column, text}");
    for (const toml::node& entry : *marks) {
      const toml::table* table = entry.as_table();
      if (!table) fail(entry, "a mark is {line, column, text}");
      known_keys(*table, {"line", "column", "text"});
      LayoutMark mark{integer(*table, "line", 1, 1, 1000), integer(*table, "column", 1, 1, 1000), {}};
      std::string rest = text(*table, "text", true);
      for (std::size_t bar = rest.find('|'); bar != std::string::npos; bar = rest.find('|')) {
        mark.texts.push_back(rest.substr(0, bar));
        rest.erase(0, bar + 1);
      }
      mark.texts.push_back(rest);
      layout_.marks.push_back(mark);
    }
  }

  void read_entries(const toml::array& array, std::vector<LayoutEntry>& entries, int depth) {
    if (depth > 8) fail(array, "blocks are nested too deeply");
    for (const toml::node& node : array) {
      const toml::table* table = node.as_table();
      if (!table) fail(node, "a [[card]] entry is a table");
      entries.push_back(read_entry(*table, depth));
    }
  }

  LayoutEntry read_entry(const toml::table& table, int depth) {
    known_keys(table,
               {"name", "as", "label", "about", "format", "fields", "items", "block", "card", "opens", "repeat",
                "until", "until_dropped", "when", "headings", "same_read", "ignored", "made", "made_from"});
    LayoutEntry entry;
    entry.line = static_cast<int>(table.source().begin.line);
    const bool block = table.contains("block");
    read_source(table, block, entry);
    if (!block) {
      entry.card = read_card(table, false);
      bare_card_ = entry.card;
    }
    read_run(table, entry);
    source_card_ = -1;
    made_ = false;
    entry.opens = flag(table, "opens");
    entry.headings = integer(table, "headings", 0, 0, 1000);
    if (const toml::node* inner = table.get("card")) {
      if (!block) fail(*inner, "only a block holds cards: give it block = \"name\"");
      if (!inner->as_array()) fail(*inner, "[[card.card]] entries were expected");
      read_entries(*inner->as_array(), entry.entries, depth + 1);
    }
    if (block) {
      if (entry.entries.empty()) fail(table, "a block needs cards");
      finish_block(table, entry);
    }
    return entry;
  }

  // A made card: which card it stands behind, and what it can't have.
  void read_source(const toml::table& table, bool block, LayoutEntry& entry) {
    source_card_ = -1;
    made_ = flag(table, "made") || table.contains("made_from");
    if (!made_) return;
    if (block) fail(table, "a block is not made: its cards are");
    for (const char* key : {"format", "items", "same_read", "headings", "until", "until_dropped"})
      if (const toml::node* node = table.get(key))
        fail(*node, "a made card stands in no record: it has no " + std::string(key));
    if (!table.contains("made_from")) return;
    const std::string source = text(table, "made_from");
    source_card_ = entry.made_from = find_card(source);
    if (source_card_ < 0) fail(*table.get("made_from"), "no card \"" + source + "\" stands before this");
  }

  // When, count and until of an entry.  A block's `until` is read after its cards, since it speaks of them.
  void read_run(const toml::table& table, LayoutEntry& entry) {
    if (table.contains("when")) entry.when = expression(table, "when", source_card_);
    const bool repeat = table.contains("repeat");
    const bool until = table.contains("until") || table.contains("until_dropped");
    if (repeat) {
      const toml::node& node = *table.get("repeat");
      if (node.value_exact<std::string>() == "named") {
        if (layout_.card_separator.empty())
          fail(node, "repeat = \"named\" needs cards with names (card_separator)");
        entry.run = LayoutEntry::Run::named;
      } else {
        entry.run = LayoutEntry::Run::counted;
        entry.count = expression(table, "repeat", source_card_);
      }
    }
    if (until && entry.card >= 0) read_until(table, entry);
  }

  void read_until(const toml::table& table, LayoutEntry& entry) {
    if (entry.run == LayoutEntry::Run::counted) fail(table, "repeat = a count and until can't both be given");
    if (entry.run == LayoutEntry::Run::once) entry.run = LayoutEntry::Run::until;
    entry.drop_last = table.contains("until_dropped");
    reads_values_ = entry.drop_last && entry.card >= 0;  // what only ends a run has no computed fields
    entry.until = expression(table, entry.drop_last ? "until_dropped" : "until", entry.card);
    reads_values_ = false;
  }

  // The first card of a block opens it unless another says so.
  void finish_block(const toml::table& table, LayoutEntry& entry) {
    if (table.contains("until") || table.contains("until_dropped")) read_until(table, entry);
    const bool chosen = std::any_of(entry.entries.begin(), entry.entries.end(),
                                    [](auto& e) { return e.opens && e.made_from < 0; });
    if (!chosen) entry.entries.front().opens = true;
    for (const LayoutEntry& inner : entry.entries)
      if (inner.opens && inner.made_from < 0 && (inner.card < 0 || inner.run != LayoutEntry::Run::once))
        fail(table, "the card that opens a block must be a single card");
    const int first = entry.entries.front().card;
    if (entry.run == LayoutEntry::Run::named && (first < 0 || layout_.cards[first].spec.made))
      fail(table, "a block repeated by name must begin with a card that is read");
  }

  int read_card(const toml::table& table, bool is_item) {
    CardRule card;
    card.line = static_cast<int>(table.source().begin.line);
    card.key = text(table, "name", true);
    card.spec.name = table.contains("as") ? text(table, "as") : card.key;
    card.spec.label = table.contains("label") ? text(table, "label") : card.key;
    card.about = text(table, "about");
    card.is_item = is_item;
    card.same_read = flag(table, "same_read");
    card.spec.made = made_ && !is_item;
    card.ignored = flag(table, "ignored");
    const auto [place, added] = index_of_.try_emplace(card.key, static_cast<int>(layout_.cards.size()));
    if (!added) fail(table, "card \"" + card.key + "\" is defined twice");
    if (layout_.cards.size() == most_cards)
      fail(table, "a layout has at most " + std::to_string(most_cards) + " kinds of cards");
    if (!is_item && !made_) read_format(table, card);
    if (card.same_read && !card.list_directed) fail(table, "same_read belongs to list-directed cards");
    if (!card.list_directed && !made_)
      if (const toml::node* items = table.get("items")) fail(*items, "items belong to list-directed cards");
    const auto index = layout_.cards.size();
    layout_.cards.push_back(card);  // its own fields may be named by its counts
    bare_card_ = static_cast<int>(index);
    reads_values_ = true;
    read_fields(table, layout_.cards[index]);
    read_values(table, layout_.cards[index]);
    reads_values_ = false;
    if (!layout_.cards[index].list_directed && !is_item && !made_) check_format(table, layout_.cards[index]);
    read_items(table, static_cast<int>(index));
    return static_cast<int>(index);
  }

  void read_format(const toml::table& table, CardRule& card) {
    const std::string format = text(table, "format", true);
    card.list_directed = format == "*";
    if (card.list_directed) return;
    card.spec.format = format;
    try {
      card.format = compile_format(format);
    } catch (const FormatError& error) {
      fail("S142", *table.get("format"),
           "FORMAT " + format + ", character " + std::to_string(error.column()) + ": " + error.what());
    }
  }

  void read_fields(const toml::table& table, CardRule& card) {
    const toml::node* node = table.get("fields");
    const toml::array* fields = node ? node->as_array() : nullptr;
    if (!node && table.contains("items")) return;  // the whole READ is a list of items
    if (fields && fields->size() > most_fields)
      fail(*node, "card \"" + card.key + "\" has more than " + std::to_string(most_fields) + " fields");
    if (!fields || fields->empty())
      fail(node ? *node : table, "card \"" + card.key + "\" needs fields = [ ... ]");
    for (const toml::node& entry : *fields) {
      const toml::table* field = entry.as_table();
      if (!field) fail(entry, "a field is { name = ..., ... }");
      if (!card.rules.empty() && !card.rules.back().count.empty())
        fail(entry, field->contains("value") ? "computed fields stand before the field that repeats (count)"
                                             : "only the last field of a card can repeat (count)");
      read_field(*field, card);
    }
  }

  void read_field(const toml::table& table, CardRule& card) {
    known_keys(table, {"name", "label", "unit", "kind", "required", "default", "codes", "map", "allowed",
                       "between", "equals", "count", "blank", "ignored", "use", "value"});
    FieldSpec spec;
    FieldRule rule;
    spec.name = text(table, "name", true);
    for (const FieldSpec& other : card.spec.fields)
      if (other.name == spec.name)
        fail(table, "field \"" + spec.name + "\" is named twice in card \"" + card.key + "\"");
    spec.label = table.contains("label") ? text(table, "label") : spec.name;
    spec.unit = text(table, "unit");
    spec.computed = table.contains("value");
    if (spec.computed) check_computed(table);
    if (card.spec.made && !spec.computed) fail(table, "a field of a made card needs its value");
    spec.kind = spec.computed ? named_kind(table).value_or(FieldKind::real) : field_kind(table, card);
    spec.required = flag(table, "required");
    if (const toml::node* node = table.get("default")) {
      const auto value = number(*node);
      if (!value) fail(*node, "default must be a number");
      spec.has_fallback = true;
      spec.fallback = *value;
    }
    if (const std::string blank = text(table, "blank"); blank == "noted" || blank == "compared")
      spec.blank_note = blank == "noted" ? BlankNote::always : BlankNote::compared;
    else if (!blank.empty())
      fail(*table.get("blank"), "blank must be noted or compared");
    spec.use = text(table, "use");
    rule.codes = text(table, "codes");
    rule.must_equal = text(table, "equals");
    read_map(table, rule);
    read_allowed(table, spec.kind, rule);
    read_between(table, spec.kind, rule);
    rule.line = static_cast<int>(table.source().begin.line);
    rule.ignored = flag(table, "ignored");
    card.spec.fields.push_back(spec);
    card.rules.push_back(rule);
    if (table.contains("count")) card.rules.back().count = expression(table, "count", -1);
  }

  void check_computed(const toml::table& table) const {
    for (const char* key : {"required", "default", "map", "equals", "blank"})
      if (const toml::node* node = table.get(key))
        fail(*node, "a computed field (value) is never read: it has no " + std::string(key));
  }

  // Values of computed fields, once all fields of the card are known.
  void read_values(const toml::table& table, CardRule& card) {
    const toml::node* fields = table.get("fields");
    if (!fields) return;
    for (std::size_t i = 0; i < card.spec.fields.size(); ++i) {
      FieldSpec& spec = card.spec.fields[i];
      if (!spec.computed) continue;
      const toml::table& field = *(*fields->as_array())[i].as_table();
      computed_field_ = static_cast<int>(i);
      read_value(field, card, i);
      computed_field_ = -1;
      const bool words = card.rules[i].values.front().words;
      for (const Expression& one : card.rules[i].values)
        if (one.words != words)
          fail(*field.get("value"), "the values of a list are numbers or texts, not both");
      const FieldKind kind = named_kind(field).value_or(words ? FieldKind::text : FieldKind::real);
      if ((kind == FieldKind::text) != words)
        fail(*field.get("value"), words ? "the value is a text, the field's kind is another"
                                        : "the value is a number, the field's kind is text");
      spec.kind = kind;
      if (!field.contains("label")) name_after_copied(card.rules[i].values, spec);
    }
  }

  // A field that only copies one of another card bears that one's label in messages.
  void name_after_copied(const std::vector<Expression>& values, FieldSpec& spec) const {
    if (values.size() != 1 || values[0].nodes.size() != 1) return;
    const ExpressionNode& node = values[0].nodes[0];
    if (node.kind != ExpressionNode::Kind::field || node.card == bare_card_) return;
    spec.label = layout_.cards[node.card].spec.fields[node.field].label;
  }

  void read_value(const toml::table& field, CardRule& card, std::size_t i) {
    const toml::node& node = *field.get("value");
    const toml::array* list = node.as_array();
    if (list && (i + 1 < card.spec.fields.size() || list->empty() || field.contains("count")))
      fail(node, "a list of values, [a, b, ...], belongs to the last field of a card and has no count");
    if (!list) return card.rules[i].values.push_back(expression(node, "value", -1));
    for (const toml::node& one : *list) card.rules[i].values.push_back(expression(one, "value", -1));
  }

  std::optional<FieldKind> named_kind(const toml::table& table) const {
    const std::string kind = text(table, "kind");
    if (kind == "integer") return FieldKind::integer;
    if (kind == "real") return FieldKind::real;
    if (kind == "text") return FieldKind::text;
    if (kind == "logical") return FieldKind::logical;
    if (!kind.empty()) fail(*table.get("kind"), "kind must be integer, real, text or logical");
    return std::nullopt;
  }

  FieldKind field_kind(const toml::table& table, const CardRule& card) const {
    if (const auto kind = named_kind(table)) return *kind;
    if (card.list_directed || card.is_item) fail(table, "a field of a list-directed card needs its kind");
    return kind_from_format(table, card);
  }

  // The FORMAT tells the kind of its n-th field.
  FieldKind kind_from_format(const toml::table& table, const CardRule& card) const {
    FormatWalker walker(card.format);
    auto wanted = std::ranges::count_if(card.spec.fields, [](const FieldSpec& f) { return !f.computed; });
    for (int passes = 0;;) {
      const FormatStep& step = walker.next();
      if (step.edit == Edit::end) {
        if (!card.format.reversion_has_data || ++passes > 10000)
          fail("S142", table, "the FORMAT has no field for this");
        walker.revert();
      }
      if (!is_data(step.edit)) continue;
      if (wanted-- > 0) continue;
      if (step.edit == Edit::integer) return FieldKind::integer;
      if (step.edit == Edit::text) return FieldKind::text;
      if (step.edit == Edit::logical) return FieldKind::logical;
      return FieldKind::real;
    }
  }

  // Of a node that holds one; TOML's inf and nan are values that no card can mean.
  std::optional<double> number(const toml::node& node) const {
    const std::optional<double> value = node.value<double>();
    if (value && !std::isfinite(*value))
      fail(node, number_text(*value) + " is no number that a layout can hold");
    return value;
  }

  void read_map(const toml::table& table, FieldRule& rule) const {
    const toml::node* node = table.get("map");
    if (!node) return;
    const toml::table* map = node->as_table();
    if (!map) fail(*node, "map must be { foreign = ours, ... }");
    for (const auto& [key, value] : *map) {
      const auto ours = number(value);
      if (!ours) fail(value, "a map gives numbers");
      rule.map.emplace_back(std::string(key.str()), *ours);
    }
  }

  void read_allowed(const toml::table& table, FieldKind kind, FieldRule& rule) const {
    const toml::node* node = table.get("allowed");
    if (!node) return;
    const toml::array* allowed = node->as_array();
    if (!allowed || allowed->empty()) fail(*node, "allowed must be [ number, ... ], or texts for a text");
    if (kind == FieldKind::text && rule.map.empty()) {
      for (const toml::node& entry : *allowed) {
        const auto one = entry.value_exact<std::string>();
        if (!one) fail(entry, "allowed must be [ 'text', ... ] for a text");
        rule.allowed_texts.push_back(*one);
      }
      return;
    }
    for (const toml::node& entry : *allowed) {
      const auto one = number(entry);
      if (!one) fail(entry, "allowed must be [ number, ... ]");
      rule.allowed.push_back(*one);
    }
  }

  void read_between(const toml::table& table, FieldKind kind, FieldRule& rule) const {
    const toml::node* node = table.get("between");
    if (!node) return;
    const toml::array* ends = node->as_array();
    const auto low = ends && ends->size() == 2 ? number((*ends)[0]) : std::nullopt;
    const auto high = low ? number((*ends)[1]) : std::nullopt;
    if (!high || !(*low <= *high) || kind == FieldKind::text)
      fail(*node, "between must be [ lowest, highest ], two numbers, for a number");
    rule.least = *low;
    rule.most = *high;
  }

  // Every field must meet an edit descriptor of its kind.
  // A list goes on with the edits behind it and, on reversion, with the last group: two passes show them all.
  void check_format(const toml::table& table, const CardRule& card) const {
    FormatWalker walker(card.format);
    std::vector<const FieldSpec*> fields;
    for (const FieldSpec& spec : card.spec.fields)
      if (!spec.computed) fields.push_back(&spec);
    if (fields.empty()) fail(table, "no field of the card is read: give made = true instead of a FORMAT");
    const bool list = !card.rules.back().count.empty() && !card.spec.fields.back().computed;
    std::size_t field = 0;
    int passes = 0;
    for (int steps = 0; steps < 100000; ++steps) {
      const bool complete = field == fields.size();
      if (complete && (!list || passes > 2)) return;
      const FormatStep& step = walker.next();
      if (step.edit == Edit::end) {
        ++passes;
        if (!card.format.reversion_has_data && !(complete && !list))
          fail("S142", table, "the FORMAT has fewer fields than the card");
        walker.revert();
      }
      if (!is_data(step.edit)) continue;
      const FieldSpec& spec = *fields[std::min(field, fields.size() - 1)];
      if (!edit_fits(step.edit, spec.kind))
        fail("S142", *table.get("format"),
             "FORMAT " + card.spec.format + " doesn't suit field \"" + spec.name + "\": its kind is another" +
                 (complete ? " where a longer list goes on (brackets of its own, as in "
                             "(I5,(10F5.0)), let it go on with "
                             "itself)"
                           : ""));
      if (!complete) ++field;
    }
  }

  void read_items(const toml::table& table, int index) {
    const toml::node* node = table.get("items");
    if (!node) return;
    const toml::table* items = node->as_table();
    if (!items) fail(*node, "items must be a table");
    known_keys(*items, {"name", "as", "label", "about", "fields", "count", "ignored"});
    if (!items->contains("count")) fail(*node, "items need a count");
    const int item = read_card(*items, true);
    bare_card_ = index;
    CardRule& card = layout_.cards[index];
    card.items_card = item;
    card.items_count = expression(*items, "count", -1);
  }

  int find_card(std::string_view key) const {
    const auto it = index_of_.find(key);
    return it == index_of_.end() ? -1 : it->second;
  }

  // `own` is the card that a bare field name means; -1 = the card being read.
  Expression expression(const toml::table& table, std::string_view key, int own) const {
    return expression(*table.get(key), key, own);
  }

  Expression expression(const toml::node& node, std::string_view key, int own) const {
    Expression result;
    if (const auto constant = node.is_number() ? number(node) : std::nullopt) {
      result.source = number_text(*constant);
      result.nodes.emplace_back().number = *constant;
    } else if (const auto source = node.value_exact<std::string>()) {
      const int bare = own >= 0 ? own : bare_card_;
      try {
        result = compile_expression(*source, [&](std::string_view card, std::string_view field,
                                                 ExpressionNode& found) { resolve(card, field, bare, found); });
      } catch (const ExpressionError& error) {
        fail("S146", node, error.what());
      }
      if (result.words && key != "value")
        fail("S146", node, "\"" + std::string(key) + "\" must give a number, not a text");
    } else {
      fail("S146", node, "\"" + std::string(key) + "\" must be a number or an expression in quotes");
    }
    result.line = static_cast<int>(node.source().begin.line);
    return result;
  }

  // Place of a field that has its value by now; -1 = the card has none of this name.
  int field_place(int card, std::string_view name) const {
    const auto& fields = layout_.cards[card].spec.fields;
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (fields[i].name == name) return static_cast<int>(i);
    return -1;
  }
  // A computed field of the card being read whose turn has not come.
  bool is_later(int card, int field) const {
    const CardRule& rule = layout_.cards[card];
    return card == bare_card_ && reads_values_ && rule.spec.fields[field].computed && field >= computed_field_;
  }

  std::string near_card(std::string_view card) const {
    std::vector<std::string> names;
    for (const auto& [name, index] : index_of_) names.push_back(name);
    return did_you_mean(card, names);
  }
  static std::string near_field(const CardRule& rule, std::string_view field) {
    std::vector<std::string> names;
    for (const FieldSpec& one : rule.spec.fields) names.push_back(one.name);
    return did_you_mean(field, names);
  }

  void resolve(std::string_view card, std::string_view field, int bare, ExpressionNode& found) const {
    int index = card.empty() ? bare : find_card(card);
    if (index < 0)
      throw ExpressionError("no card \"" + std::string(card) + "\" stands before this" + near_card(card));
    found.card = index;
    if (field.empty()) return;
    int place = field_place(index, field);
    const bool before = found.kind == ExpressionNode::Kind::previous;  // of the card before: complete
    // A bare name in a card made from another is of that card first: the same name means the same in every field.
    if (card.empty() && source_card_ >= 0) {
      if (const int of_source = field_place(source_card_, field); of_source >= 0) {
        index = source_card_;
        place = of_source;
      }
    }
    const CardRule& rule = layout_.cards[index];
    if (place < 0)
      throw ExpressionError("card \"" + rule.key + "\" has no field \"" + std::string(field) + "\"" +
                            near_field(rule, field));
    if (!before && is_later(index, place))
      throw ExpressionError("field \"" + std::string(field) + "\" of card \"" + rule.key +
                            "\" is computed later than this");
    found.card = index;
    found.field = place;
    found.words = rule.spec.fields[place].kind == FieldKind::text && rule.rules[place].map.empty();
  }

  const toml::table& root_;
  Layout layout_;
  std::map<std::string, int, std::less<>> index_of_;  // cards by their keys
  int bare_card_ = -1;
  int source_card_ = -1;       // the card that the one being read is made from
  int computed_field_ = -1;    // whose value is being read
  bool reads_values_ = false;  // the card's fields and its items are not complete
  bool made_ = false;          // the card being read
};

constexpr std::size_t most_characters = 16u << 20;
constexpr int most_key_parts = 16;  // toml++ walks tables within tables by recursion

// "a.b.c" has three parts.  Texts and comments are passed over; a number has one point.
void check_key_parts(std::string_view text, const std::string& file) {
  int line = 1, parts = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') i = std::min(text.find('\n', i), text.size() - 1);
    if (c == '"' || c == '\'') {
      const std::string_view mark =
          text.substr(i, 3) == std::string(3, c) ? text.substr(i, 3) : text.substr(i, 1);
      std::size_t end = i + mark.size();
      while (end < text.size() && text.substr(end, mark.size()) != mark &&
             (mark.size() == 3 || text[end] != '\n'))
        end += c == '"' && text[end] == '\\' ? 2 : 1;
      end = std::min(end, text.size());
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                          text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      i = end < text.size() && text[end] == '\n' ? end - 1 : end + mark.size() - 1;
      continue;
    }
    if (i < text.size() && text[i] == '\n') ++line;
    if (c == '.' && ++parts > most_key_parts)
      throw InputError(
          "S141", {file, line, 0, 0},
          "a key of more than " + std::to_string(most_key_parts) + " parts with points between them");
    const bool ends =
        c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n' || c == '#';
    if (ends) parts = 1;
  }
}

toml::table parse(std::string_view text, const std::string& file) {
  if (text.size() > most_characters)
    throw InputError("S102", {file, 0, 0, 0}, "the layout file is larger than 16 MiB");
  check_key_parts(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw InputError("S141", {file, static_cast<int>(at.line), static_cast<int>(at.column), 0},
                     std::string(error.description()));
  }
}

}  // namespace

Layout load_layout_text(std::string_view toml_text, const std::string& file) {
  const toml::table root = parse(toml_text, file);
  return LayoutReader(root, file).read();
}

Layout load_checked_layout(std::string_view toml_text, const std::string& file) {
  const toml::table root = parse(toml_text, file);
  Layout layout = LayoutReader(root, file).read();
  if (!layout.draft) check_names(layout);
  return layout;
}

}  // namespace sage
