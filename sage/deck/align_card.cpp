// Values that stand beside their columns, moved into them where there is one way alone: `sagefe align`.
#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/seams.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr int kFarthestWord = 4;  // columns: fields of integers are five wide

// A field of a card's first line.
struct Slot {
  std::size_t value = 0;           // index into the card's values
  std::size_t first = 0, end = 0;  // columns, 0-based, end exclusive
  const FieldSpec* spec = nullptr;
  const FieldRule* rule = nullptr;
  bool is_number() const { return spec->kind != FieldKind::text; }
  // A blank there is an error or is noted.
  bool wanted() const { return spec->required || spec->blank_note == BlankNote::always; }
};

struct Word {
  std::string_view text;
  std::size_t first = 0, end = 0;
  FieldResult number;
};

std::vector<Word> words_of(std::string_view text) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    const std::size_t end = std::min(text.find(' ', i), text.size());
    words.push_back({text.substr(i, end - i), i, end, read_free_number(text.substr(i, end - i), false)});
    i = end;
  }
  return words;
}

bool reads_as_number(const Word& word) {
  return word.number.fault == FieldFault::none && !(word.number.hints & hint_not_finite);
}

bool is_integer(const Word& word) {
  const std::size_t sign = word.text.front() == '-' || word.text.front() == '+' ? 1 : 0;
  return word.text.size() > sign &&
         std::all_of(word.text.begin() + static_cast<std::ptrdiff_t>(sign), word.text.end(), is_digit);
}

bool fits(const Word& word, const Slot& slot) {
  if (!reads_as_number(word) || word.text.size() > slot.end - slot.first) return false;
  if (slot.spec->kind == FieldKind::integer && !is_integer(word)) return false;
  const FieldRule& rule = *slot.rule;
  const bool listed =
      rule.allowed.empty() || std::ranges::find(rule.allowed, word.number.value) != rule.allowed.end();
  return !rule.map.empty() || (listed && word.number.value >= rule.least && word.number.value <= rule.most);
}

// No farther than a slip; what ends where a field ends stays there.
bool is_near(const Word& word, const Slot& slot, std::span<const Slot> slots) {
  const auto at_end = std::ranges::find(slots, word.end, &Slot::end);
  if (at_end != slots.end() && at_end->is_number() && word.first >= at_end->first)
    return at_end->end == slot.end;
  if (word.first >= slot.first && word.end <= slot.end) return true;
  const auto distance = static_cast<long>(word.end) - static_cast<long>(slot.end);
  return std::abs(distance) <= kFarthestWord;
}

// Counts the ways to put words into slots in their order, and keeps the first.
struct Placing {
  std::span<const Word> words;
  std::span<const Slot> slots;
  bool near = false;     // words may move no farther than a slip
  bool by_kind = false;  // integers go into fields of integers alone
  int ways = 0;
  std::vector<std::size_t> chosen = {}, first = {};  // slot of each word

  void search(std::size_t word, std::size_t slot) {
    if (ways > 1) return;
    if (word == words.size()) {
      for (std::size_t s = slot; s < slots.size(); ++s)
        if (slots[s].wanted()) return;
      if (ways++ == 0) first = chosen;
      return;
    }
    for (std::size_t s = slot; s + (words.size() - word) <= slots.size(); ++s) {
      if (fits(words[word], slots[s]) && (!near || is_near(words[word], slots[s], slots)) &&
          (!by_kind || slots[s].spec->kind == FieldKind::integer || !is_integer(words[word]))) {
        chosen.push_back(s);
        search(word + 1, s + 1);
        chosen.pop_back();
      }
      if (slots[s].wanted()) return;  // it would stay blank
    }
  }
};

// The only way, by the strictest rule that has any; what moves farther than a slip does so in a free form alone.
Placing way_of(const std::vector<Word>& words, const std::vector<Slot>& slots, bool free_form) {
  Placing placing{words, slots, false, false};
  for (const bool near : {true, false}) {
    if (!near && !free_form) break;
    for (const bool by_kind : {true, false}) {
      placing = Placing{words, slots, near, by_kind};
      placing.search(0, 0);
      if (placing.ways > 0) return placing;
    }
  }
  return placing;
}

std::string columns_text(std::size_t first, std::size_t end) {
  return first + 1 == end ? "column " + std::to_string(end)
                          : "columns " + std::to_string(first + 1) + "-" + std::to_string(end);
}

// Tabs as the blanks that a terminal shows.
std::string without_tabs(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c == '\t')
      text.append(8 - text.size() % 8, ' ');
    else
      text += c;
  }
  return text;
}

// Separated by single blanks or tabs, as in a free format.
bool is_free_form(std::string_view line, const std::vector<Word>& words) {
  if (line.find('\t') != std::string_view::npos) return true;
  for (std::size_t w = 1; w < words.size(); ++w)
    if (words[w].first - words[w - 1].end > 1) return false;
  return words.size() > 1;
}

// Numeric fields of the line up to its first text, and that text; nothing where a text comes first.
struct Slots {
  std::vector<Slot> numbers;
  std::optional<Slot> text;
};

Slots slots_of(RecordSource records, const CardRule& rule, int line, std::size_t values_wanted) {
  const std::string full(std::max<std::size_t>(480, records.source().line(line).size()), '0');
  records.replace(line, full);
  records.rewind_to(line);
  FormattedRead read(records, rule.format);
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  Slots slots;
  if (rule.rules.empty() || read.begin() != ReadEnd::complete) return slots;
  for (std::size_t i = 0; i < values_wanted; ++i) {
    const std::size_t field = std::min(i, rule.rules.size() - 1);
    const FieldSpec& spec = rule.spec.fields[field];
    if (spec.computed) {
      values.emplace_back();
      continue;
    }
    if (read.read(spec.kind, values, flaws) != ReadEnd::complete || values.back().line != line) break;
    const FieldValue& value = values.back();
    const Slot slot{i, static_cast<std::size_t>(value.first_column) - 1, value.last_column, &spec,
                    &rule.rules[field]};
    if (!slot.is_number()) {
      slots.text = slot;
      break;
    }
    slots.numbers.push_back(slot);
  }
  return slots;
}

// The line with each word at the end of its slot, and what was moved, in words.
AlignedLine placed(const std::vector<Word>& words, const std::vector<Slot>& slots,
                   const std::vector<std::size_t>& at, std::string_view rest, const std::optional<Slot>& text) {
  AlignedLine aligned;
  for (std::size_t w = 0; w < words.size(); ++w) {
    const Slot& slot = slots[at[w]];
    const std::size_t first = slot.end - words[w].text.size();
    aligned.text.resize(std::max(aligned.text.size(), slot.end), ' ');
    aligned.text.replace(first, words[w].text.size(), words[w].text);
    if (first == words[w].first) continue;
    aligned.moves += (aligned.moves.empty() ? "" : ", ") + quoted(words[w].text) + " from " +
                     columns_text(words[w].first, words[w].end) + " to " + columns_text(first, slot.end) +
                     " (" + slot.spec->name + ")";
  }
  if (!rest.empty() && text) {
    aligned.text.resize(text->first, ' ');
    aligned.text += rest;
  }
  return aligned;
}

}  // namespace

bool DeckReader::is_beside_columns(const CardRule& rule, int line, std::size_t last_field_end) {
  if (rule.list_directed || rule.is_item || rule.spec.made || records_.replaced_line() == line) return false;
  if (is_doubtful_line(rule, line)) return true;
  const SequenceColumns sequence{layout_.first_sequence_column, layout_.last_sequence_column};
  std::vector<Seam> seams = seams_;
  if (const auto slip = find_slip(source_, rule.spec, fields_, seams, sequence); slip && slip->line == line)
    return slip->slip != Slip::cut_text;
  if (records_.line() != line) return false;
  std::string_view record = records_.record();
  if (sequence.first > 0) record = record.substr(0, static_cast<std::size_t>(sequence.first) - 1);
  if (last_field_end >= record.size() || all_blank(record.substr(last_field_end))) return false;
  return std::ranges::all_of(words_of(record.substr(last_field_end)), reads_as_number);
}

// The next reading of the line finds it in its columns.
bool DeckReader::take_aligned(const CardRule& rule, AlignedLine line) {
  line.card = card_text(rule.spec.label);
  records_.replace(line.line, texts_->emplace_back(line.text));
  records_.rewind_to(line.line);
  aligned_->push_back(std::move(line));
  fields_.clear();
  flaws_.clear();
  return true;
}

bool DeckReader::align_line(const CardRule& rule, int line) {
  if (reads_as_neighbour(rule, line)) return false;
  const std::string_view stored = source_.line(line);
  if (std::optional<MovedCard> found = moved_back(rule, line)) {
    const int distance = std::abs(found->columns);
    const std::string from =
        found->whole
            ? ""
            : " from " + quoted(stored.substr(found->word, stored.find(' ', found->word) - found->word)) +
                  " on";
    return take_aligned(rule, {line,
                               std::move(found->line),
                               "moved " + std::to_string(distance) + (distance == 1 ? " column" : " columns") +
                                   " to the " + (found->columns > 0 ? "left" : "right") + from,
                               {}});
  }
  const auto skipped = static_cast<std::size_t>(records_.skipped());
  if (skipped > 0) return false;
  const std::string text = without_tabs(stored);
  const Slots slots = slots_of(records_, rule, line, fields_.size());
  std::vector<Word> words = words_of(text);
  std::string_view rest;
  const auto name = slots.text ? std::ranges::find_if_not(words, reads_as_number) : words.end();
  if (name != words.end()) {
    rest = std::string_view(text).substr(name->first);
    rest = rest.substr(0, rest.find_last_not_of(' ') + 1);
    words.erase(name, words.end());
  }
  if (words.empty() || slots.numbers.empty()) return false;
  const Placing placing = way_of(words, slots.numbers, is_free_form(stored, words));
  AlignedLine aligned;
  if (placing.ways == 1) aligned = placed(words, slots.numbers, placing.first, rest, slots.text);
  aligned.line = line;
  if (placing.ways == 1 && !aligned.moves.empty()) return take_aligned(rule, std::move(aligned));
  aligned_->push_back({line, {}, {}, card_text(rule.spec.label)});
  return false;
}

}  // namespace sage
