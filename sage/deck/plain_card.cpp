#include "sage/deck/plain_card.hpp"

#include <algorithm>

#include "sage/deck/field.hpp"

namespace sage {

namespace {

bool needs_more(const CardRule& rule) {
  return rule.list_directed || rule.is_item || rule.rules.empty() ||
         std::ranges::any_of(rule.spec.fields, [](const FieldSpec& field) { return field.computed; }) ||
         std::ranges::any_of(rule.rules, [](const FieldRule& field) {
           return !field.map.empty() || field.restricted() || !field.must_equal.empty() || !field.count.empty();
         });
}

bool is_blank(const char* at, const char* end) {
  return std::all_of(at, end, [](char c) { return c == ' '; });
}

// A number behind blanks; `blank` where there is none.  False where it does not read without a remark.
bool read_number(const PlainCard::Field& field, const char* at, const char* end, double& number, bool& blank) {
  const char* const first = at;
  while (at < end && *at == ' ') ++at;
  blank = at == end;
  if (blank) return true;
  if (field.kind == FieldKind::text || field.kind == FieldKind::logical) return false;
  const bool integer = field.kind == FieldKind::integer;
  const char* const behind =
      integer ? read_plain_integer(at, end, number) : read_plain_real(at, end, field.decimals, number);
  if (behind != nullptr && is_blank(behind, end)) return true;
  if (integer) return false;
  const std::string_view text(first, static_cast<std::size_t>(end - first));
  const FieldResult read = read_real_field(text, {field.decimals, 0, BlankMode::null});
  number = read.value;
  return read.fault == FieldFault::none && (read.hints & ~hint_trailing_blank) == 0;
}

// Nothing that the end of a field may have cut, and nothing that may have slipped (seams.hpp): characters stand
// on both sides of the field's beginning only where it is full and the field before ends there.
bool is_well_placed(const PlainCard::Field& field, std::string_view record) {
  const char* const at = record.data() + field.start;
  if (*at == ' ') return true;
  const std::size_t width = field.end - field.start;
  const bool lone = width > 1 && (field.start + 1 == record.size() || at[1] == ' ');
  if (lone) return false;
  if (field.start == 0 || at[-1] == ' ') return true;
  return field.joined && field.end <= record.size() &&
         std::string_view(at, width).find(' ') == std::string_view::npos;
}

}  // namespace

std::optional<PlainCard> plain_card(const CardRule& rule, const RecordRules& records) {
  if (needs_more(rule) || !records.pad || records.blanks != BlankMode::null) return std::nullopt;
  PlainCard card;
  FormatWalker walker(rule.format);
  std::size_t column = 0;
  for (std::size_t i = 0;;) {
    const FormatStep& step = walker.next();
    const bool complete = i == rule.spec.fields.size();
    if (complete && (is_data(step.edit) || step.edit == Edit::stop || step.edit == Edit::end)) return card;
    if (step.edit == Edit::tab_to && step.width > static_cast<int>(column)) {
      column = static_cast<std::size_t>(step.width) - 1;
    } else if (step.edit == Edit::tab_by && step.width > 0) {
      column += static_cast<std::size_t>(step.width);
    } else if (is_data(step.edit) && step.width > 0 && edit_fits(step.edit, rule.spec.fields[i].kind)) {
      const FieldSpec& spec = rule.spec.fields[i++];
      const bool joined = !card.fields.empty() && column == card.end;
      card.end = column + static_cast<std::size_t>(step.width);
      card.fields.push_back({column, card.end, step.decimals, spec.kind, spec.required, joined});
      column = card.end;
    } else {
      return std::nullopt;
    }
  }
}

bool read_plain(const PlainCard& card, std::string_view record, std::vector<double>& numbers) {
  const std::size_t before = numbers.size();
  std::size_t kept = before;
  const char* const data = record.data();
  const auto refused = [&] {
    numbers.resize(before);
    return false;
  };
  for (std::size_t i = 0; i < card.fields.size(); ++i) {
    const PlainCard::Field& field = card.fields[i];
    bool blank = true;
    double number = 0.0;
    if (field.start < record.size()) {
      const std::size_t end = std::min(field.end, record.size());
      if (!is_well_placed(field, record) || !read_number(field, data + field.start, data + end, number, blank))
        return refused();
      const bool followed = i + 1 < card.fields.size() && card.fields[i + 1].joined;
      if (!followed && end < record.size() && data[end] != ' ') return refused();
    }
    if (blank && field.required) return refused();
    numbers.push_back(blank ? Deck::blank_number() : number);
    if (!blank) kept = numbers.size();
  }
  numbers.resize(kept);
  return true;
}

}  // namespace sage
