// List-directed input, as gfortran's runtime does it.
#include <algorithm>

#include "sage/deck/record.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr int largest_repeat = 200000000;  // gfortran's own limit

bool is_space(char c) {
  return c == ' ' || c == '\t';
}
bool is_separator(char c) {
  return is_space(c) || c == ',' || c == ';' || c == '/' || c == '\n';
}

}  // namespace

ReadEnd ListRead::begin() {
  if (!source_.next()) return ReadEnd::end_of_file;
  record_ = source_.record();
  position_ = 0;
  return ReadEnd::complete;
}

// Moves to the next value, over records if need be.  False at the end of the file.
// A comma that opens a record only separates, unless a comma closed the value before.
bool ListRead::skip_to_value() {
  bool crossed = false;
  for (;;) {
    while (position_ < record_.size() && is_space(record_[position_])) ++position_;
    if (position_ < record_.size()) {
      if (!crossed || record_[position_] != ',' || comma_) return true;
      ++position_;
      comma_ = true;  // used up
      while (position_ < record_.size() && is_space(record_[position_])) ++position_;
      if (position_ < record_.size()) return true;
      comma_ = false;
    }
    if (!source_.next()) return false;
    record_ = source_.record();
    position_ = 0;
    crossed = true;
  }
}

// What stands between a value and the next: blanks and at most one comma; a slash ends the READ.
void ListRead::skip_separator() {
  while (is_space(current())) ++position_;
  const char c = current();
  comma_ = c == ',' || c == ';';
  if (comma_) ++position_;
  if (c == '/') slash_ = true;
}

// "3*": sets repeats_.  True if there was one.
bool ListRead::take_repeat_count(FieldResult& result) {
  std::size_t end = position_;
  while (end < record_.size() && is_digit(record_[end])) ++end;
  if (end == position_ || end >= record_.size() || record_[end] != '*') return false;
  const FieldResult count = read_integer_field(record_.substr(position_, end - position_), BlankMode::null);
  position_ = end + 1;
  repeats_ = static_cast<int>(count.value);
  if (repeats_ < 1 || repeats_ > largest_repeat) {
    result.fault = FieldFault::no_value;
    repeats_ = 1;
  }
  return true;
}

// A quoted string; '' inside stands for one quote.  It may go on in the next records.
ReadEnd ListRead::take_quoted(Token& token) {
  const char quote = current();
  const std::size_t first = ++position_;
  std::string* joined = nullptr;
  std::size_t from = first;
  token.quoted = true;
  for (;;) {
    const std::size_t at = record_.find(quote, position_);
    const std::string_view piece = record_.substr(from, at == std::string_view::npos ? at : at - from);
    if (at == std::string_view::npos) {  // goes on
      if (!joined) joined = &texts_.emplace_back();
      joined->append(piece);
      token.text = *joined;
      position_ = record_.size();
      if (!source_.next()) return ReadEnd::complete;  // gfortran takes the end of the file as the closing quote
      record_ = source_.record();
      position_ = from = 0;
      continue;
    }
    const bool doubled = at + 1 < record_.size() && record_[at + 1] == quote;
    position_ = at + (doubled ? 2 : 1);
    if (!doubled && !joined) {
      token.text = piece;
      return ReadEnd::complete;
    }
    if (!joined) joined = &texts_.emplace_back();
    joined->append(piece);
    token.text = *joined;
    if (!doubled) return ReadEnd::complete;
    joined->push_back(quote);
    from = position_;
  }
}

void ListRead::take_word(Token& token) {
  const std::size_t first = position_;
  while (!is_separator(current())) ++position_;
  token.text = record_.substr(first, position_ - first);
}

ReadEnd ListRead::next_token(FieldKind kind, Token& token, FieldResult& result) {
  if (!skip_to_value()) return ReadEnd::end_of_file;
  token.first = position_;
  repeats_ = 1;
  const bool repeated = take_repeat_count(result);
  const char c = current();
  if (is_separator(c)) {
    token.null = true;
    if (c == '/' && !repeated) {
      slash_ = true;
      return ReadEnd::ended_by_slash;
    }
  } else if (kind == FieldKind::text && (c == '\'' || c == '"')) {
    take_quoted(token);
    if (!is_separator(current())) result.fault = FieldFault::no_value;
  } else {
    take_word(token);
  }
  line_of_token_ = source_.line();
  skip_separator();
  return ReadEnd::complete;
}

FieldResult ListRead::convert(const Token& token, FieldKind kind) const {
  FieldResult result;
  switch (kind) {
    case FieldKind::integer:
      result = read_free_number(token.text, true);
      break;
    case FieldKind::real:
      result = read_free_number(token.text, false);
      break;
    case FieldKind::logical:
      result = read_logical_field(token.text);
      break;
    case FieldKind::text:
      result.blank = token.text.find_first_not_of(' ') == std::string_view::npos;
      break;
  }
  return result;
}

ReadEnd ListRead::read(FieldKind kind, std::vector<FieldValue>& values, std::vector<FieldFlaw>& flaws) {
  FieldResult result;
  const bool again = repeats_ > 0;
  if (!again) {
    if (slash_) return ReadEnd::ended_by_slash;
    token_ = Token{};
    if (const ReadEnd end = next_token(kind, token_, result); end != ReadEnd::complete) {
      repeats_ = 0;
      return end;
    }
    token_kind_ = kind;
  }
  --repeats_;
  FieldValue& value = values.emplace_back();
  value.kind = kind;
  value.line = line_of_token_;
  value.text = token_.text;
  const std::size_t offset = static_cast<std::size_t>(source_.skipped()) + token_.first;
  value.first_column = stored_column(offset + 1);
  value.last_column =
      stored_column(offset + std::max<std::size_t>(token_.text.size() + (token_.quoted ? 2 : 0), 1));
  if (token_.null && result.fault == FieldFault::none) return ReadEnd::complete;
  if (result.fault == FieldFault::none) result = convert(token_, kind);
  if (again && kind != token_kind_) result.fault = FieldFault::no_value;  // "2*1" into an integer and a real
  value.number = result.value;
  value.blank = result.blank;
  if (result.fault != FieldFault::none || result.hints != hint_none)
    flaws.push_back({static_cast<int>(values.size()) - 1, result.fault, result.hints, result.at});
  return ReadEnd::complete;
}

}  // namespace sage
