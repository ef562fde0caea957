#include "sage/layout_draft/layout_draft.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "sage/deck/layout.hpp"
#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"
#include "sage/layout_draft/cards.hpp"
#include "sage/layout_draft/scan.hpp"
#include "sage/layout_draft/write_toml.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

using layout_draft::CardDraft;

constexpr int kMostTrials = 6;

// A count with its items behind it fills lines exactly: chance for a few, not for many.
bool counts_items(const std::vector<CardDraft>& cards) {
  return std::any_of(cards.begin(), cards.end(), [](const CardDraft& card) {
    return !card.items.empty() && card.last_line >= card.first_line + 2;
  });
}

// Neat tables of list-directed decks stand in columns too, but not at multiples of five.
std::vector<CardDraft> first_cards(layout_draft::Scan& scan) {
  if (!scan.facts.separator.empty()) return layout_draft::named_cards(scan);
  if (!scan.facts.listed && scan.facts.grid) return layout_draft::column_cards(scan);
  std::vector<CardDraft> listed = layout_draft::listed_cards(scan);
  if (scan.facts.listed) return listed;
  if (!counts_items(listed)) return layout_draft::column_cards(scan);
  scan.facts.listed = true;
  scan.facts.reasons.push_back("but a count fits the items behind it, over lines: taken as list-directed");
  return listed;
}

// Records from a line on: comments are none.
int records_between(const layout_draft::Scan& scan, int first, int last) {
  return static_cast<int>(
      std::count_if(scan.lines.begin() + (first - 1), scan.lines.begin() + last,
                    [](const layout_draft::Line& l) { return l.sort != layout_draft::Sort::comment; }));
}

// Reads as text what did not read as it was guessed.
class Trial {
 public:
  Trial(layout_draft::Scan& scan, std::string deck, std::string deck_name, std::string layout_name)
      : scan_(scan),
        deck_(std::move(deck)),
        deck_name_(std::move(deck_name)),
        layout_name_(std::move(layout_name)),
        cards_(first_cards(scan)) {}

  LayoutDraft run() {
    for (int trial = 0; trial < kMostTrials; ++trial) {
      const std::string toml = text();
      const Wrong wrong = wrong_lines(toml);
      const bool last = trial + 2 >= kMostTrials;
      if (wrong.lines.empty() || (!wrong.errors && (last || !can_replace(wrong.lines))))
        return {toml, static_cast<int>(cards_.size()), not_understood_};
      if (last || !replace(wrong.lines)) all_text();
    }
    all_text();
    return {text(), 1, not_understood_};
  }

 private:
  std::string text() const { return layout_draft::toml_text(cards_, facts(), layout_name_, deck_name_); }

  layout_draft::Facts facts() const {
    layout_draft::Facts facts = scan_.facts;
    if (all_text_) facts.separator.clear();
    return facts;
  }

  // Lines with mistakes, else with warnings, when the deck is read under this layout; 0 stands for one without
  // a line.
  struct Wrong {
    std::set<int> lines;
    bool errors = false;
  };

  Wrong wrong_lines(const std::string& toml) const {
    Wrong wrong;
    try {
      ReadOptions options;
      options.shown = 100000;
      const Layout layout = load_checked_layout(toml, layout_name_);
      const Deck deck = read_deck_text(deck_, deck_name_, layout, options);
      if (deck.diagnostics.warnings() > 0) take_lines(deck.diagnostics, Severity::warning, wrong.lines);
    } catch (const InputError& error) {
      wrong.errors = true;
      take_lines(error.diagnostics(), Severity::error, wrong.lines);
      if (wrong.lines.empty()) wrong.lines.insert(0);
    }
    return wrong;
  }

  static void take_lines(const Diagnostics& diagnostics, Severity severity, std::set<int>& lines) {
    for (const Diagnostic& one : diagnostics.list())
      if (one.severity == severity) lines.insert(one.where.line);
  }

  bool replaceable(const CardDraft& card, const std::set<int>& wrong) const {
    const auto at = wrong.lower_bound(card.first_line);
    if (at == wrong.end() || *at > card.last_line || card.first_line == 0) return false;
    if (card.format == "(A)" && card.inner.empty() && card.headings == 0) return false;
    return scan_.facts.separator.empty() || card.inner.empty();
  }

  bool can_replace(const std::set<int>& wrong) const {
    return std::any_of(cards_.begin(), cards_.end(), [&](const CardDraft& c) { return replaceable(c, wrong); });
  }

  // The cards that hold these lines are read as text.  False if none was left to be.
  bool replace(const std::set<int>& wrong) {
    bool replaced = false;
    int before = 0;
    for (CardDraft& card : cards_) {
      if (replaceable(card, wrong)) {
        to_text(card, before + 1);
        replaced = true;
      }
      before = card.last_line;
    }
    return replaced;
  }

  // `from`: the line behind the card before.  A list-directed READ passes over blank lines there, a FORMAT not.
  void to_text(CardDraft& card, int from) {
    const int records = records_between(scan_, card.first_line, card.last_line);
    not_understood_ += records;
    CardDraft text = layout_draft::text_card(card.name, static_cast<std::size_t>(records));
    if (!card.label.empty()) {
      text.label = card.label;
      text.repeat = "\"named\"";
    }
    if (card.label.empty()) text.headings = records_between(scan_, from, card.first_line - 1);
    text.first_line = card.first_line;
    text.last_line = card.last_line;
    text.reasons.push_back("read as text: columns that suit every one of these lines were not found");
    card = std::move(text);
  }

  void all_text() {
    all_text_ = true;
    const int records = records_between(scan_, 1, static_cast<int>(scan_.lines.size()));
    CardDraft card = layout_draft::text_card("text", static_cast<std::size_t>(records));
    card.first_line = 1;
    card.last_line = static_cast<int>(scan_.lines.size());
    card.reasons.push_back("no order was found in these lines: read as text");
    not_understood_ = records;
    cards_ = {std::move(card)};
  }

  const layout_draft::Scan& scan_;
  std::string deck_, deck_name_, layout_name_;
  std::vector<CardDraft> cards_;
  int not_understood_ = 0;
  bool all_text_ = false;
};

}  // namespace

LayoutDraft draft_layout(std::string deck, const std::string& deck_name, const std::string& layout_name) {
  check_is_text(deck, deck_name);
  if (deck.compare(0, 3, "\xef\xbb\xbf") == 0) deck.erase(0, 3);
  const SourceText source(deck, deck_name);
  layout_draft::Scan scan = layout_draft::scan(source);
  return Trial(scan, std::move(deck), deck_name, layout_name).run();
}

}  // namespace sage
