#include "sage/layout_draft/coverage.hpp"

#include <algorithm>
#include <map>
#include <ostream>

#include "sage/deck/layout_names.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr std::size_t kMostColumns = 1000;  // of a line that are looked at
constexpr std::size_t kShownLines = 10;     // under no card
constexpr std::size_t kMostRecords = 12;    // of a card that are told apart: a list may take thousands

class CoverageFinder {
 public:
  CoverageFinder(const Layout& layout, const Deck& deck) : layout_(layout), deck_(deck) {
    lines_ = deck.source.line_count();
    taken_.assign(static_cast<std::size_t>(lines_) + 1, false);
    headings_.assign(layout.cards.size(), 0);
    find_headings(layout.entries);
    for (const CardRule& card : layout.cards) {
      coverage_.cards.emplace_back();
      coverage_.cards.back().filled.resize(card.spec.fields.size(), 0);
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
      auto& most = headings_[first->card];
      most = std::max(most, headings);
      if (entry.card < 0) find_headings(entry.entries);
    }
  }

  bool is_comment(int line) const {
    const std::string_view text = deck_.line_text(line);
    return layout_.records.comment != '\0' && !text.empty() && text[0] == layout_.records.comment;
  }

  void add_card(const Card& card) {
    const CardSpec& spec = deck_.specs[card.spec];
    const auto index = static_cast<std::size_t>(card.spec);
    CardCoverage& kind = coverage_.cards[index];
    ++kind.cards;
    const std::vector<FieldValue> values = deck_.values(card);
    // The last field may be a list.
    const auto field = [&](std::size_t i) { return std::min(i, kind.filled.size() - 1); };
    int last = card.line;
    for (std::size_t i = 0; i < values.size() && !kind.filled.empty(); ++i) {
      if (!values[i].blank) ++kind.filled[field(i)];
      if (!spec.fields[field(i)].computed) last = std::max(last, values[i].line);
    }
    if (kind.first_line == 0) kind.first_line = card.line;
    kind.last_line = std::max(kind.last_line, last);
    if (spec.made) return;
    const bool listed = spec.format.empty();
    std::size_t number = 0;
    for (int line = card.line; line <= last && line <= lines_; ++line) {
      if (is_comment(line)) continue;
      take_line(line, kind);
      const std::size_t record = std::min(number++, kMostRecords - 1);
      if (listed && (kind.cards > 1 || number > kMostRecords)) continue;
      if (kind.records.size() <= record) kind.records.emplace_back();
      add_line(line, values, index, kind.records[record]);
    }
  }

  void take_line(int line, CardCoverage& kind) {
    // Items of a list-directed READ share lines.
    if (!taken_[line]) ++kind.lines;
    taken_[line] = true;
  }

  // What the card's values read of a line, and the characters that none of them holds.
  void add_line(int line, const std::vector<FieldValue>& values, std::size_t card, RecordCoverage& record) {
    const CardSpec& spec = deck_.specs[card];
    const std::string_view text = deck_.line_text(line).substr(0, kMostColumns);
    read_.assign(text.size() + 1, false);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const FieldValue& value = values[i];
      const std::size_t field = std::min(i, spec.fields.size() - 1);
      if (value.line != line || value.first_column == 0 || spec.fields[field].computed) continue;
      widen(record, field, value);
      for (std::size_t c = value.first_column; c <= value.last_column && c <= text.size(); ++c) read_[c] = true;
    }
    const std::size_t unread = spec.format.empty() ? 0 : mark_unread(text, record);
    if (unread > 0) {
      ++record.unread_lines;
      ++coverage_.cards[card].unread_lines;
    }
    if (record.sample > 0 && unread <= shown_unread_[record.sample] &&
        (unread < shown_unread_[record.sample] || text.size() <= deck_.line_text(record.sample).size()))
      return;
    shown_unread_[line] = unread;
    record.sample = line;
  }

  // Values of a list stand side by side: each has its own columns.
  static void widen(RecordCoverage& record, std::size_t field, const FieldValue& value) {
    auto at = std::find_if(record.fields.begin(), record.fields.end(), [&](const FieldColumns& columns) {
      return columns.field > field || (columns.field == field && columns.last >= value.first_column);
    });
    if (at == record.fields.end() || at->field != field || at->first > value.last_column)
      at = record.fields.insert(at, {field, value.first_column, value.last_column});
    at->first = std::min<int>(at->first, value.first_column);
    at->last = std::max<int>(at->last, value.last_column);
  }

  std::size_t mark_unread(std::string_view text, RecordCoverage& record) const {
    const auto first = static_cast<std::size_t>(layout_.records.skip_columns);
    std::size_t unread = 0;
    for (std::size_t c = first + 1; c <= text.size(); ++c) {
      const int column = static_cast<int>(c);
      const bool sequence = column >= layout_.first_sequence_column && column <= layout_.last_sequence_column;
      if (read_[c] || sequence || text[c - 1] == ' ' || text[c - 1] == '\t') continue;
      if (record.unread.size() <= c) record.unread.resize(c + 1, 0);
      ++record.unread[c];
      ++unread;
    }
    return unread;
  }

  // Lines above the first card of a run that the layout passes over.
  void take_headings(const Card& card) {
    if (deck_.specs[card.spec].made) return;
    int left = headings_[card.spec];
    for (int line = card.line - 1; left > 0 && line > 0 && !taken_[line]; --line) {
      if (is_comment(line)) continue;
      taken_[line] = true;
      ++coverage_.headings;
      --left;
    }
  }

  void count_lines() {
    for (const CardCoverage& card : coverage_.cards) coverage_.card_lines += card.lines;
    for (int line = 1; line <= lines_; ++line) {
      if (taken_[line]) continue;
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
  std::vector<int> headings_;                // of each card
  std::map<int, std::size_t> shown_unread_;  // unread characters of lines that are or were samples
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
std::string field_ruler(const RecordCoverage& record, std::size_t columns) {
  std::string text(columns, ' ');
  for (const FieldColumns& field : record.fields) {
    const auto first = static_cast<std::size_t>(field.first) - 1;
    const auto end = std::min(static_cast<std::size_t>(field.last), columns);
    for (std::size_t c = first; c < end; ++c) text[c] = '-';
    const std::string number = std::to_string(field.field + 1);
    for (std::size_t k = 0; k < number.size() && k < end - std::min(first, end); ++k)
      text[end - 1 - k] = number[number.size() - 1 - k];
  }
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string columns_text(const FieldColumns& field) {
  return field.first == field.last
             ? "column " + std::to_string(field.first)
             : "columns " + std::to_string(field.first) + "-" + std::to_string(field.last);
}

// Where a field stands: its columns, with the record where the card has several; of a list those of its first
// record.
std::string place_text(const CardCoverage& card, std::size_t field) {
  for (std::size_t r = 0; r < card.records.size(); ++r) {
    FieldColumns all{field, 0, 0};
    for (const FieldColumns& columns : card.records[r].fields) {
      if (columns.field != field) continue;
      if (all.first == 0) all.first = columns.first;
      all.last = columns.last;
    }
    if (all.first > 0)
      return (card.records.size() > 1 ? "record " + std::to_string(r + 1) + ", " : "") + columns_text(all);
  }
  return "on no line";
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
  for (std::size_t f = 0; f < card.filled.size(); ++f) {
    const FieldSpec& spec = rule.spec.fields[f];
    std::string line = number_before(static_cast<int>(f) + 1).substr(0, 5) + " " + spec.name;
    pad(line, 28);
    if (spec.computed)
      line += "computed";
    else if (rule.list_directed || rule.is_item)
      line += "list-directed";
    else
      line += place_text(card, f);
    const std::size_t more = card.records.size() > 1 && !rule.list_directed ? 12 : 0;  // "record 1, "
    pad(line, 46 + more);
    line += spec.computed || card.filled[f] > 0 ? std::to_string(card.filled[f]) + " filled" : "ALWAYS BLANK";
    pad(line, 62 + more);
    out << line << use_text(uses[f]) << '\n';
  }
}

// The same fields in the same columns; the last record of a list may have fewer.
bool reads_alike(const RecordCoverage& a, const RecordCoverage& b) {
  return a.unread_lines == 0 && b.unread_lines == 0 && !b.fields.empty() &&
         b.fields.size() <= a.fields.size() &&
         std::equal(b.fields.begin(), b.fields.end(), a.fields.begin(),
                    [](const FieldColumns& s, const FieldColumns& t) {
                      return s.field == t.field && s.first == t.first && s.last <= t.last;
                    });
}

void print_record(const Deck& deck, const RecordCoverage& record, std::ostream& out) {
  const std::string_view sample = deck.line_text(record.sample).substr(0, kMostColumns);
  std::size_t columns = std::max(sample.size(), record.unread.empty() ? 0 : record.unread.size() - 1);
  for (const FieldColumns& field : record.fields)
    columns = std::min(kMostColumns, std::max(columns, static_cast<std::size_t>(field.last)));
  out << number_before(0) << ruler(columns) << '\n' << number_before(record.sample) << sample << '\n';
  if (!record.fields.empty()) out << number_before(0) << field_ruler(record, columns) << '\n';
  if (record.unread_lines == 0) return;
  std::string marks;
  for (std::size_t c = 1; c < record.unread.size(); ++c) marks += record.unread[c] > 0 ? '^' : ' ';
  out << number_before(0) << marks << " UNREAD: columns " << unread_columns(record.unread) << " of "
      << record.unread_lines << (record.unread_lines == 1 ? " line" : " lines") << '\n';
}

// One line under a ruler for every record that reads otherwise than the one before.
void print_records(const Deck& deck, const CardCoverage& card, std::ostream& out) {
  const std::vector<RecordCoverage>& records = card.records;
  for (std::size_t r = 0; r < records.size();) {
    std::size_t end = r + 1;
    while (end < records.size() && reads_alike(records[r], records[end])) ++end;
    if (records.size() > 1) {
      out << "      record" << (end > r + 1 ? "s " : " ") << r + 1;
      if (end > r + 1) out << " to " << end;
      out << (end == kMostRecords ? " and behind\n" : "\n");
    }
    print_record(deck, records[r], out);
    r = end;
  }
}

void print_card(const Deck& deck, const CardRule& rule, const std::string& source, const CardCoverage& card,
                const std::vector<NameUse>& uses, std::ostream& out) {
  out << '\n' << rule.key;
  if (rule.spec.name != rule.key) out << ", as " << rule.spec.name;
  const bool several = card.first_line != card.last_line;
  if (rule.spec.made) {
    out << "  made" << (source.empty() ? "" : " from " + source) << ": " << card.cards
        << (card.cards == 1 ? " card" : " cards");
    if (!source.empty())
      out << ", by " << (several ? "lines " : "line ") << card.first_line
          << (several ? " to " + std::to_string(card.last_line) : "");
    out << '\n';
  } else {
    out << "  " << (rule.spec.format.empty() ? "list-directed" : rule.spec.format) << ": " << card.cards
        << (card.cards == 1 ? " card, " : " cards, ") << (several ? "lines " : "line ") << card.first_line
        << (several ? " to " + std::to_string(card.last_line) : "") << '\n';
    print_records(deck, card, out);
  }
  print_fields(rule, card, uses, out);
}

// Names of the cards that others are made from, by card; empty for all that stand in the deck or alone.
void find_sources(const Layout& layout, const std::vector<LayoutEntry>& entries,
                  std::vector<std::string>& sources) {
  for (const LayoutEntry& entry : entries) {
    if (entry.card >= 0 && entry.made_from >= 0) sources[entry.card] = layout.cards[entry.made_from].key;
    find_sources(layout, entry.entries, sources);
  }
}

void print_rest(const Layout& layout, const Deck& deck, const Coverage& coverage, std::ostream& out) {
  std::string absent, not_made;
  for (std::size_t i = 0; i < coverage.cards.size(); ++i) {
    if (coverage.cards[i].cards > 0) continue;
    std::string& names = layout.cards[i].spec.made ? not_made : absent;
    names += (names.empty() ? "" : ", ") + layout.cards[i].key;
  }
  if (!absent.empty()) out << "\nCards of the layout that the deck doesn't have: " << absent << '\n';
  if (!not_made.empty()) out << "\nCards that the layout makes of none here: " << not_made << '\n';
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
  std::vector<std::string> sources(layout.cards.size());
  find_sources(layout, layout.entries, sources);
  for (std::size_t i = 0; i < coverage.cards.size(); ++i)
    if (coverage.cards[i].cards > 0)
      print_card(deck, layout.cards[i], sources[i], coverage.cards[i], uses[i], out);
  print_rest(layout, deck, coverage, out);
}

}  // namespace sage
