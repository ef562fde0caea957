#include "sage/guess/coverage.hpp"

#include <algorithm>
#include <ostream>

#include "sage/deck/layout_names.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr std::size_t kMostColumns = 1000;  // of a line that are looked at
constexpr std::size_t kShownLines = 10;     // under no card

class CoverageFinder {
 public:
  CoverageFinder(const Layout& layout, const Deck& deck) : layout_(layout), deck_(deck) {
    lines_ = deck.source.line_count();
    taken_.assign(static_cast<std::size_t>(lines_) + 1, false);
    headings_.assign(layout.cards.size(), 0);
    shows_.assign(layout.cards.size(), 0);
    find_headings(layout.entries);
    for (const CardRule& card : layout.cards) {
      coverage_.cards.emplace_back();
      coverage_.cards.back().fields.resize(card.spec.fields.size());
    }
  }

  Coverage find() {
    for (std::size_t i = 0; i < deck_.cards.size(); ++i) add_card(deck_.cards[i]);
    for (const Card& card : deck_.cards) take_headings(card);
    count_lines();
    return std::move(coverage_);
  }

 private:
  void find_headings(const std::vector<LayoutEntry>& entries) {
    for (const LayoutEntry& entry : entries) {
      const LayoutEntry* first = &entry;
      int headings = entry.headings;
      while (first->card < 0) {
        first = &first->entries.front();
        headings += first->headings;
      }
      auto& most = headings_[static_cast<std::size_t>(first->card)];
      most = std::max(most, headings);
      if (entry.card < 0) find_headings(entry.entries);
    }
  }

  bool is_comment(int line) const {
    const std::string_view text = deck_.line_text(line);
    return layout_.records.comment != '\0' && !text.empty() && text[0] == layout_.records.comment;
  }

  void add_card(const Card& card) {
    const CardSpec& spec = deck_.specs[static_cast<std::size_t>(card.spec)];
    if (spec.made) return;
    CardCoverage& kind = coverage_.cards[static_cast<std::size_t>(card.spec)];
    ++kind.cards;
    const std::vector<FieldValue> values = deck_.values(card);
    int last = card.line;
    for (std::size_t i = 0; i < values.size(); ++i) {
      last = std::max(last, values[i].line);
      add_value(values[i], card.line, kind.fields[std::min(i, kind.fields.size() - 1)]);
    }
    if (kind.first_line == 0) kind.first_line = card.line;
    kind.last_line = std::max(kind.last_line, last);
    for (int line = card.line; line <= last && line <= lines_; ++line)
      if (!is_comment(line)) add_line(line, values, kind, spec.format.empty());
  }

  static void add_value(const FieldValue& value, int card_line, FieldCoverage& field) {
    if (!value.blank) ++field.filled;
    if (value.first_column == 0 || value.line != card_line) return;
    if (field.first_column == 0) field.first_column = value.first_column;
    field.first_column = std::min<int>(field.first_column, value.first_column);
    field.last_column = std::max<int>(field.last_column, value.last_column);
  }

  // Characters of a line that none of the card's values holds.
  void add_line(int line, const std::vector<FieldValue>& values, CardCoverage& kind, bool listed) {
    const bool again = taken_[static_cast<std::size_t>(line)];  // items of a list-directed READ share lines
    taken_[static_cast<std::size_t>(line)] = true;
    if (!again) ++kind.lines;
    const std::string_view text = deck_.line_text(line).substr(0, kMostColumns);
    std::size_t unread = 0;
    if (!listed) unread = mark_unread(line, text, values, kind);
    if (unread > 0) ++kind.unread_lines;
    const std::size_t shows = unread * kMostColumns + text.size();
    std::size_t& most = shows_[static_cast<std::size_t>(&kind - coverage_.cards.data())];
    if (kind.sample > 0 && shows <= most) return;
    most = shows;
    kind.sample = line;
  }

  std::size_t mark_unread(int line, std::string_view text, const std::vector<FieldValue>& values,
                          CardCoverage& kind) {
    read_.assign(text.size() + 1, false);
    for (const FieldValue& value : values)
      if (value.line == line && value.first_column > 0)
        for (std::size_t c = value.first_column; c <= value.last_column && c <= text.size(); ++c)
          read_[c] = true;
    const auto first = static_cast<std::size_t>(layout_.records.skip_columns);
    std::size_t unread = 0;
    for (std::size_t c = first + 1; c <= text.size(); ++c) {
      const int column = static_cast<int>(c);
      const bool sequence = column >= layout_.first_sequence_column && column <= layout_.last_sequence_column;
      if (read_[c] || sequence || text[c - 1] == ' ' || text[c - 1] == '\t') continue;
      if (kind.unread.size() <= c) kind.unread.resize(c + 1, 0);
      ++kind.unread[c];
      ++unread;
    }
    return unread;
  }

  // Lines above the first card of a run that the layout passes over.
  void take_headings(const Card& card) {
    int left = headings_[static_cast<std::size_t>(card.spec)];
    for (int line = card.line - 1; left > 0 && line > 0 && !taken_[static_cast<std::size_t>(line)]; --line) {
      if (is_comment(line)) continue;
      taken_[static_cast<std::size_t>(line)] = true;
      ++coverage_.headings;
      --left;
    }
  }

  void count_lines() {
    for (const CardCoverage& card : coverage_.cards) coverage_.card_lines += card.lines;
    for (int line = 1; line <= lines_; ++line) {
      if (taken_[static_cast<std::size_t>(line)]) continue;
      if (is_comment(line))
        ++coverage_.comments;
      else if (all_blank(deck_.line_text(line)))
        ++coverage_.blanks;
      else
        coverage_.no_card.push_back(line);
    }
  }

  const Layout& layout_;
  const Deck& deck_;
  Coverage coverage_;
  int lines_ = 0;
  std::vector<bool> taken_;
  std::vector<bool> read_;
  std::vector<int> headings_;       // of each card
  std::vector<std::size_t> shows_;  // what the sample of each card shows: unread characters first, then length
};

// ---- The report

std::string number_before(int line) {
  std::string text = line > 0 ? std::to_string(line) : "";
  if (text.size() < 5) text.insert(0, 5 - text.size(), ' ');
  return text + " | ";
}

std::string ruler(std::size_t columns) {
  std::string text;
  for (std::size_t c = 1; c <= std::max<std::size_t>(columns, 20); ++c)
    text += c % 10 == 0 ? static_cast<char>('0' + c / 10 % 10) : c % 5 == 0 ? '+' : '.';
  return text;
}

// "----1---------2": a field's number ends where the field ends.
std::string field_ruler(const CardCoverage& card, std::size_t columns) {
  std::string text(columns, ' ');
  for (std::size_t f = 0; f < card.fields.size(); ++f) {
    const FieldCoverage& field = card.fields[f];
    if (field.first_column == 0) continue;
    const auto first = static_cast<std::size_t>(field.first_column) - 1;
    const auto end = std::min(static_cast<std::size_t>(field.last_column), columns);
    for (std::size_t c = first; c < end; ++c) text[c] = '-';
    const std::string number = std::to_string(f + 1);
    for (std::size_t k = 0; k < number.size() && k < end - std::min(first, end); ++k)
      text[end - 1 - k] = number[number.size() - 1 - k];
  }
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string columns_text(int first, int last) {
  if (first == 0) return "on no line";
  return first == last ? "column " + std::to_string(first)
                       : "columns " + std::to_string(first) + "-" + std::to_string(last);
}

// "3, 7-9": columns with unread characters.
std::string unread_columns(const std::vector<std::size_t>& unread) {
  std::string text;
  for (std::size_t c = 1; c < unread.size(); ++c) {
    if (unread[c] == 0) continue;
    std::size_t end = c;
    while (end + 1 < unread.size() && unread[end + 1] > 0) ++end;
    text += (text.empty() ? "" : ", ") + std::to_string(c) + (end > c ? "-" + std::to_string(end) : "");
    c = end;
  }
  return text;
}

const char* use_text(NameUse use) {
  switch (use) {
    case NameUse::program:
      return "used by the program";
    case NameUse::layout:
      return "used by the layout";
    case NameUse::ignored:
      return "ignored: never used";
    case NameUse::nothing:
      break;
  }
  return "used by nothing";
}

void pad(std::string& text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
}

void print_fields(const CardRule& rule, const CardCoverage& card, const std::vector<NameUse>& uses,
                  std::ostream& out) {
  for (std::size_t f = 0; f < card.fields.size(); ++f) {
    const FieldSpec& spec = rule.spec.fields[f];
    const FieldCoverage& field = card.fields[f];
    std::string line = number_before(static_cast<int>(f) + 1).substr(0, 5) + " " + spec.name;
    pad(line, 28);
    if (spec.computed)
      line += "computed";
    else if (rule.list_directed || rule.is_item)
      line += "list-directed";
    else
      line += columns_text(field.first_column, field.last_column);
    pad(line, 46);
    line += spec.computed || field.filled > 0 ? std::to_string(field.filled) + " filled" : "ALWAYS BLANK";
    pad(line, 62);
    out << line << use_text(uses[f]) << '\n';
  }
}

void print_card(const Deck& deck, const CardRule& rule, const CardCoverage& card,
                const std::vector<NameUse>& uses, std::ostream& out) {
  out << '\n' << rule.key;
  if (rule.spec.name != rule.key) out << ", as " << rule.spec.name;
  out << "  " << (rule.spec.format.empty() ? "list-directed" : rule.spec.format) << ": " << card.cards
      << (card.cards == 1 ? " card, " : " cards, ");
  out << (card.first_line == card.last_line
              ? "line " + std::to_string(card.first_line)
              : "lines " + std::to_string(card.first_line) + " to " + std::to_string(card.last_line))
      << '\n';
  const std::string_view sample = deck.line_text(card.sample).substr(0, kMostColumns);
  std::size_t columns = std::max(sample.size(), card.unread.empty() ? 0 : card.unread.size() - 1);
  for (const FieldCoverage& field : card.fields)
    columns = std::min(kMostColumns, std::max(columns, static_cast<std::size_t>(field.last_column)));
  out << number_before(0) << ruler(columns) << '\n' << number_before(card.sample) << sample << '\n';
  if (!rule.list_directed && !rule.is_item) out << number_before(0) << field_ruler(card, columns) << '\n';
  if (card.unread_lines > 0) {
    std::string marks;
    for (std::size_t c = 1; c < card.unread.size(); ++c) marks += card.unread[c] > 0 ? '^' : ' ';
    out << number_before(0) << marks << " UNREAD: columns " << unread_columns(card.unread) << " of "
        << card.unread_lines << (card.unread_lines == 1 ? " line" : " lines") << '\n';
  }
  print_fields(rule, card, uses, out);
}

void print_rest(const Layout& layout, const Deck& deck, const Coverage& coverage, std::ostream& out) {
  std::string absent;
  for (std::size_t i = 0; i < coverage.cards.size(); ++i)
    if (coverage.cards[i].cards == 0 && !layout.cards[i].spec.made)
      absent += (absent.empty() ? "" : ", ") + layout.cards[i].key;
  if (!absent.empty()) out << "\nCards of the layout that the deck doesn't have: " << absent << '\n';
  if (coverage.no_card.empty()) return;
  out << "\nLINES UNDER NO CARD: " << coverage.no_card.size() << '\n';
  for (std::size_t i = 0; i < std::min(coverage.no_card.size(), kShownLines); ++i)
    out << number_before(coverage.no_card[i]) << deck.line_text(coverage.no_card[i]).substr(0, kMostColumns)
        << '\n';
  if (coverage.no_card.size() > kShownLines)
    out << "      and " << coverage.no_card.size() - kShownLines << " more\n";
}

}  // namespace

Coverage find_coverage(const Layout& layout, const Deck& deck) {
  return CoverageFinder(layout, deck).find();
}

void print_coverage(const Layout& layout, const Deck& deck, const Coverage& coverage, std::ostream& out) {
  const std::vector<std::vector<NameUse>> uses = name_uses(layout);
  out << deck.file << ", layout " << layout.name << (layout.draft ? " (a draft)" : "") << ": "
      << deck.source.line_count() << " lines; " << coverage.card_lines << " read by cards, "
      << coverage.headings << " headings, " << coverage.comments << " comments, " << coverage.blanks
      << " blank or end marks, " << coverage.no_card.size() << " under no card\n";
  for (std::size_t i = 0; i < coverage.cards.size(); ++i)
    if (coverage.cards[i].cards > 0) print_card(deck, layout.cards[i], coverage.cards[i], uses[i], out);
  print_rest(layout, deck, coverage, out);
}

}  // namespace sage
