// Cards that stand a few columns beside their place: recognised before their fields are taken for mistakes.
#include <algorithm>
#include <cstdlib>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr int kFarthest = 4;           // columns: fields of integers are five wide
constexpr std::size_t kLongest = 480;  // longer lines are no cards

std::size_t words_in(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) count += text[i] != ' ' && (i == 0 || text[i - 1] == ' ');
  return count;
}

bool is_number(std::string_view text) {
  const FieldResult number = read_free_number(text, false);
  return !text.empty() && number.fault == FieldFault::none && !(number.hints & hint_not_finite);
}

// A number alone in a text that is no name, and the number before it is blank.
bool holds_the_number_before(const CardSpec& spec, const std::vector<FieldValue>& values, int line) {
  for (std::size_t i = 1; i < std::min(values.size(), spec.fields.size()); ++i) {
    const FieldValue &text = values[i], &before = values[i - 1];
    if (text.kind != FieldKind::text || is_free_text(spec.fields[i]) || text.line != line) continue;
    if (before.kind == FieldKind::text || !before.blank || before.line != line) continue;
    if (is_number(trimmed(text.text))) return true;
  }
  return false;
}

// end: the last column of the field.
bool is_right_justified(const FieldValue& value, std::size_t end) {
  return value.blank || value.kind == FieldKind::text ||
         (value.text.back() != ' ' && value.last_column == stored_column(end));
}

// The line with what begins at `word` moved by so many columns; empty where there is no place for that.
std::string moved(std::string_view line, std::size_t word, int columns, bool whole) {
  std::string text(line);
  if (columns > 0) return text.insert(word, static_cast<std::size_t>(columns), ' ');
  const auto left = static_cast<std::size_t>(-columns), kept = whole ? std::size_t{0} : std::size_t{1};
  if (word < left + kept) return {};
  for (std::size_t i = word - left - kept; i < word; ++i)
    if (text[i] != ' ') return {};
  return text.erase(word - left, left);
}

}  // namespace

bool DeckReader::is_doubtful_line(const CardRule& rule, int line) const {
  for (const FieldFlaw& flaw : flaws_)
    if (fields_[flaw.value].line == line && (flaw.fault != FieldFault::none || (flaw.hints & hint_inner_blank)))
      return true;
  const std::size_t count = std::min(fields_.size(), rule.rules.size());
  for (std::size_t i = 0; i < count; ++i)
    if (fields_[i].blank && rule.spec.fields[i].required && fields_[i].line == line) return true;
  return holds_the_number_before(rule.spec, fields_, line);
}

// Every number ends in the last column of its field, nothing is missing, cut or left over.
bool DeckReader::reads_in_columns(const CardRule& rule, int line, std::string_view text) const {
  if (rule.list_directed || rule.is_item || rule.spec.made) return false;
  RecordSource records = records_;
  records.replace(line, text);
  records.rewind_to(line);
  FormattedRead read(records, rule.format);
  if (read.begin() != ReadEnd::complete) return false;
  const std::string_view record = records.record();
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  std::size_t words = 0;
  for (std::size_t i = 0; i < rule.rules.size() && rule.rules[i].count.empty(); ++i) {
    const FieldSpec& spec = rule.spec.fields[i];
    if (spec.computed) {
      values.emplace_back();
      continue;
    }
    if (read.read(spec.kind, values, flaws) != ReadEnd::complete || records.line() != line) return false;
    const FieldValue& value = values.back();
    const std::size_t end = static_cast<std::size_t>(records.skipped()) + read.last_field_end();
    if ((value.blank && spec.required) || !is_right_justified(value, end)) return false;
    const FieldRule& allowed = rule.rules[i];
    if (!value.blank && allowed.map.empty() && value.kind != FieldKind::text) {
      const auto& numbers = allowed.allowed;
      const bool listed = numbers.empty() || std::ranges::find(numbers, value.number) != numbers.end();
      if (!listed || value.number < allowed.least || value.number > allowed.most) return false;
    }
    if (!allowed.must_equal.empty() && lower_case(trimmed(value.text)) != lower_case(allowed.must_equal))
      return false;
    words += words_in(value.text);
  }
  if (!flaws.empty() || holds_the_number_before(rule.spec, values, line)) return false;
  const std::size_t end = std::min(read.last_field_end(), record.size());
  return all_blank(record.substr(end)) && words == words_in(record);
}

// In its columns as a card that may come before or behind: then a count is wrong.
bool DeckReader::reads_as_neighbour(const CardRule& rule, int line) const {
  const auto own = static_cast<int>(&rule - layout_.cards.data());
  const int last = std::min(static_cast<int>(layout_.cards.size()) - 1, own + 3);
  for (int other = std::max(0, std::min(own - 1, previous_rule_ < 0 ? own : previous_rule_)); other <= last;
       ++other) {
    const CardRule& neighbour = rule_of(other);
    const bool listed = !neighbour.rules.empty() && !neighbour.rules.back().count.empty();
    if (other != own && !listed && neighbour.spec.fields.size() >= 3 &&
        reads_in_columns(neighbour, line, source_.line(line)))
      return true;
  }
  return false;
}

std::optional<DeckReader::MovedCard> DeckReader::moved_back(const CardRule& rule, int line) const {
  const std::string_view text = source_.line(line);
  const auto first_column = static_cast<std::size_t>(records_.skipped());
  if (text.size() > kLongest) return std::nullopt;
  for (std::size_t word = first_column; word < text.size(); ++word) {
    const bool begins = text[word] != ' ' && (word == first_column || text[word - 1] == ' ');
    if (!begins) continue;
    const bool whole = all_blank(text.substr(first_column, word - first_column));
    for (int distance = 1; distance <= kFarthest; ++distance)
      for (const int columns : {-distance, distance}) {
        std::string other = moved(text, word, columns, whole);
        if (!other.empty() && reads_in_columns(rule, line, other))
          return MovedCard{std::move(other), word, -columns, whole};
      }
  }
  return std::nullopt;
}

// Reports the slip, and the card is read as if it stood in its columns.
bool DeckReader::take_moved(const CardRule& rule, int line) {
  if (records_.replaced_line() == line || reads_as_neighbour(rule, line)) return false;
  std::optional<MovedCard> found = moved_back(rule, line);
  if (!found) return false;
  const std::string_view text = source_.line(line);
  const std::size_t end = text.find_last_not_of(' ') + 1;
  const int distance = std::abs(found->columns);
  const std::string columns = std::to_string(distance) + (distance == 1 ? " column" : " columns");
  const bool right = found->columns > 0;
  const std::string_view word = text.substr(found->word, text.find(' ', found->word) - found->word);
  log_.add(Severity::error, "S128",
           {deck_.file, line, static_cast<int>(found->word) + 1, static_cast<int>(end)},
           "the " + card_text(rule.spec.label) + " is shifted " + columns + " to the " +
               (right ? "right" : "left") + (found->whole ? "" : " from " + quoted(word) + " on"),
           "move it " + columns + " to the " + (right ? "left" : "right") +
               "; it was read as if it stood in its columns");
  records_.replace(line, texts_->emplace_back(std::move(found->line)));
  records_.rewind_to(line);
  fields_.clear();
  flaws_.clear();
  return true;
}

}  // namespace sage
