// A layout says which cards a deck holds, in which order, and what their fields mean.  It is data: a TOML file.
// legacy_inputs/layouts/README.md describes the file.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/expression.hpp"
#include "sage/deck/format.hpp"
#include "sage/deck/record.hpp"

namespace sage {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// What a layout says of a field beyond the FieldSpec.
struct FieldRule {
  std::string codes;  // allowed codes, for the manual: "1 plane strain, 2 axisymmetric"
  std::vector<std::pair<std::string, double>>
      map;                                 // foreign code -> ours; keys are the field's trimmed characters
  std::vector<double> allowed;             // the field reads one of these; empty = anything
  std::vector<std::string> allowed_texts;  // the same of a text
  double least = -kUnbounded, most = kUnbounded;  // the number lies between them
  std::string must_equal;                         // the card is wrong unless the field reads this
  Expression count;                               // how many values the last field repeats; empty = one
  std::vector<Expression> values;  // of a computed field: its value, or those of a list one by one
  bool ignored = false;            // no meaning is wanted for it
  int line = 0;                    // of the layout file
  bool bounded() const { return least > -kUnbounded || most < kUnbounded; }
  bool restricted() const { return !allowed.empty() || !allowed_texts.empty() || bounded(); }
};

struct CardRule {
  CardSpec spec;                 // spec.name is the canonical name, spec.label the layout's own
  std::string key;               // the layout's own name, used in expressions and messages
  std::string about;             // a sentence for the manual
  std::vector<FieldRule> rules;  // one a field of spec.fields
  bool list_directed = false;
  bool same_read = false;  // goes on in the READ of the list-directed card before, instead of a new record
  Format format;
  int items_card = -1;  // the cards that the rest of this READ makes, one an item; -1 = none
  Expression items_count;
  bool is_item = false;
  bool ignored = false;  // no meaning is wanted for its fields
  int line = 0;          // of the layout file
};

// One entry of the sequence of cards: a card, or a block of entries read together.
struct LayoutEntry {
  enum class Run { once, counted, named, until };
  int card = -1;                     // index into Layout::cards; -1 = a block
  std::vector<LayoutEntry> entries;  // of a block
  bool opens = false;                // the cards after it in its block belong to it
  Run run = Run::once;
  Expression when;         // read only if true
  Expression count;        // Run::counted
  Expression until;        // Run::until: the run ends after the card for which it is true
  bool drop_last = false;  // that card only ends the run and is not kept
  int headings = 0;        // lines before the first card of the run that are passed over
  int made_from = -1;      // a made card: it stands behind every card of this kind; -1 = at its own place
  int line = 0;
};

// A deck starts like this: how a layout recognises its own.
struct LayoutMark {
  int line = 1;
  int column = 1;
  std::vector<std::string> texts;  // one of these
};

struct Layout {
  std::string name, title, file;
  bool draft = false;  // names are not looked at yet: decks can be read under it, and no model made of them
  RecordRules records;
  int first_sequence_column = 0, last_sequence_column = 0;  // 0 = the layout has none
  std::string card_separator;  // "!!" between the card's name and the record; empty = cards have no names
  int card_name_columns = 0;
  std::string introduction, closing, example;  // for the manual
  std::vector<LayoutMark> marks;               // all must be found
  std::vector<CardRule> cards;
  std::vector<LayoutEntry> entries;
};

// Every expression of a layout, in any order.
template <class Visit>
void for_each_expression(const std::vector<LayoutEntry>& entries, const Visit& visit) {
  for (const LayoutEntry& entry : entries) {
    for (const Expression* one : {&entry.when, &entry.count, &entry.until})
      if (!one->empty()) visit(*one);
    for_each_expression(entry.entries, visit);
  }
}
template <class Visit>
void for_each_expression(const Layout& layout, const Visit& visit) {
  for_each_expression(layout.entries, visit);
  for (const CardRule& card : layout.cards) {
    if (!card.items_count.empty()) visit(card.items_count);
    for (const FieldRule& field : card.rules) {
      if (!field.count.empty()) visit(field.count);
      for (const Expression& one : field.values) visit(one);
    }
  }
}

// A built-in layout by name, or a layout file by its path.  Throws InputError at the layout file's own line.
// checked: also at names that nothing uses.
Layout load_layout(const std::string& path_or_name, bool checked = true);
Layout load_layout_text(std::string_view toml, const std::string& file);
std::vector<std::string> built_in_layouts();

// An error for each name that nothing uses, and for each that a model needs and the layout has not.
Diagnostics name_problems(const Layout& layout);
// Every name of the layout and who uses it, and the names that the program also knows for its cards.
std::string names_listing(const Layout& layout);

// Name of the layout that this deck names or has the marks of; empty if there are none.  file: of the deck; a layout
// file that the deck names is searched beside it, then in the folder of the command.  Throws InputError (S101).
std::string recognised_layout(std::string_view deck_text, const std::string& file = {});
// The same; "sage1" if there are none.
std::string detect_layout(std::string_view deck_text, const std::string& file = {});

// The manual of a layout, as Markdown.
std::string layout_manual(const Layout& layout);

}  // namespace sage
