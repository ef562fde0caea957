#include "sage/layout_draft/scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "sage/deck/field.hpp"
#include "sage/deck/text.hpp"

namespace sage::layout_draft {

namespace {

constexpr std::size_t kMostNames = 300;  // of cards
constexpr std::size_t kSequenceStart = 72, kSequenceEnd = 80;

std::string percent(std::size_t part, std::size_t whole) {
  return std::to_string(whole == 0 ? 0 : 100 * part / whole) + " %";
}

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

// ---- Numbers and words

std::size_t digits_from(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - at;
}

// Characters of the number that begins `text`; 0 = none does.
std::size_t number_length(std::string_view text, bool& integer) {
  std::size_t at = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  std::size_t digits = digits_from(text, at);
  at += digits;
  integer = true;
  if (at < text.size() && text[at] == '.') {
    const std::size_t decimals = digits_from(text, at + 1);
    at += 1 + decimals;
    digits += decimals;
    integer = false;
  }
  if (digits == 0) return 0;
  if (at < text.size() && std::string_view("eEdD").find(text[at]) != std::string_view::npos) {
    std::size_t exponent = at + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (const std::size_t n = digits_from(text, exponent); n > 0) {
      at = exponent + n;
      integer = false;
    }
  }
  return at;
}

Token token_of(std::string_view record, std::size_t first, std::size_t length, Kind kind) {
  Token token{static_cast<int>(first) + 1, static_cast<int>(first + length), kind, false, 0.0};
  if (kind != Kind::text) token.value = read_free_number(record.substr(first, length), false).value;
  return token;
}

// A piece without blanks: a number, numbers that touch ("12.5-3.0"), a number whose field a text follows at
// once ("1clay"), or a word.
void take_piece(std::string_view record, std::size_t first, std::size_t end, std::vector<Token>& tokens) {
  const std::size_t before = tokens.size();
  const bool marked = first == 0 && end >= 2 && end % 5 == 0 && is_letter(record[0]) &&
                      digits_from(record, 1) == end - 1;  // "L1471": A1,I4
  if (marked) tokens.push_back(token_of(record, 0, 1, Kind::text));
  for (std::size_t at = first + (marked ? 1 : 0); at < end;) {
    bool integer = false;
    const std::size_t length = number_length(record.substr(at, end - at), integer);
    const std::size_t stop = at + length;
    const bool ends = stop == end, packed = stop < end && (record[stop] == '-' || record[stop] == '+');
    const bool text_follows =
        stop < end && is_letter(record[stop]) && stop % 5 == 0 && before > 0 && is_number(tokens[before - 1]);
    if (length == 0 || !(ends || packed || text_follows)) {
      tokens.resize(before);
      tokens.push_back(token_of(record, first, end - first, Kind::text));
      return;
    }
    tokens.push_back(token_of(record, at, length, integer ? Kind::integer : Kind::real));
    if (text_follows) {
      tokens.push_back(token_of(record, stop, end - stop, Kind::text));
      return;
    }
    at = stop;
  }
}

// Words with one blank between them are one text.
void join_words(std::vector<Token>& tokens) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token token = tokens[i];
    Token* last = kept > 0 ? &tokens[kept - 1] : nullptr;
    if (last && last->kind == Kind::text && token.kind == Kind::text && !last->quoted && !token.quoted &&
        token.first - last->last <= 2)
      last->last = token.last;
    else
      tokens[kept++] = token;
  }
  tokens.resize(kept);
}

std::vector<Token> tokens_of(std::string_view record) {
  std::vector<Token> tokens;
  const auto parts = [](char c) { return c == ' ' || c == '\t' || c == ',' || c == '\x1a'; };
  for (std::size_t at = 0; at < record.size();) {
    if (parts(record[at])) {
      ++at;
      continue;
    }
    if (const char mark = record[at]; mark == '\'' || mark == '"') {
      const std::size_t close = record.find(mark, at + 1);
      if (close != std::string_view::npos) {
        tokens.push_back(token_of(record, at, close + 1 - at, Kind::text));
        tokens.back().quoted = true;
        at = close + 1;
        continue;
      }
    }
    std::size_t end = at;
    while (end < record.size() && !parts(record[end])) ++end;
    take_piece(record, at, end, tokens);
    at = end;
  }
  join_words(tokens);
  return tokens;
}

// Numbers, perhaps with a letter before them (A1,I4) or a name behind them; texts before two or more numbers
// that stand apart; or nothing but numbers and texts in quotes.
Sort sort_of(const std::vector<Token>& tokens, bool named) {
  if (tokens.empty()) return Sort::blank;
  const auto numbers = static_cast<std::size_t>(std::count_if(tokens.begin(), tokens.end(), is_number));
  const auto quoted =
      static_cast<std::size_t>(std::count_if(tokens.begin(), tokens.end(), [](auto& t) { return t.quoted; }));
  if (numbers + quoted == tokens.size()) return Sort::numbers;
  const std::size_t wanted = named ? 1 : 2;
  if (numbers < wanted) return Sort::words;
  const std::size_t mark = tokens[0].kind == Kind::text && tokens[0].first == 1 && tokens[0].last <= 2 ? 1 : 0;
  std::size_t leading = 0, trailing = 0;
  while (mark + leading < tokens.size() && is_number(tokens[mark + leading])) ++leading;
  while (trailing < tokens.size() && is_number(tokens[tokens.size() - 1 - trailing])) ++trailing;
  if (leading >= 2) return Sort::numbers;
  const bool texts_then_numbers = leading == 0 && trailing == numbers && trailing >= wanted;
  if (!texts_then_numbers) return Sort::words;
  const std::size_t begin = tokens.size() - trailing;
  return tokens[begin].first - tokens[begin - 1].last > 2 ? Sort::numbers : Sort::words;
}

// The pieces of a word between the ends of columns; none if one is no number.
std::vector<Token> pieces_of(const Line& line, const Token& word, const std::vector<Columns>& fields) {
  std::vector<Token> pieces;
  int first = word.first;
  for (const auto& [begin, end] : fields) {
    const bool last = end >= word.last;
    if (end < first) continue;
    if (begin > word.last) return {};
    const int stop = last ? word.last : end;
    const auto start = static_cast<std::size_t>(first) - 1, length = static_cast<std::size_t>(stop - first + 1);
    bool integer = false;
    if (number_length(line.record.substr(start, length), integer) != length) return {};
    pieces.push_back(token_of(line.record, start, length, integer ? Kind::integer : Kind::real));
    if (last) return pieces;
    first = stop + 1;
  }
  return {};
}

// ---- What holds for the whole deck

// The character that begins lines with words in them, and none with numbers alone.
char find_comment(const SourceText& source, std::vector<std::string>& reasons) {
  constexpr std::string_view candidates = "*#!$%;";
  std::array<int, 6> lines{}, doubtful{};
  for (int n = 1; n <= source.line_count(); ++n) {
    const std::string_view line = source.line(n);
    const std::size_t which = line.empty() ? std::string_view::npos : candidates.find(line[0]);
    if (which == std::string_view::npos) continue;
    ++lines[which];
    if (trimmed(line.substr(1)).empty()) ++doubtful[which];
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (lines[i] - doubtful[i] > lines[best] - doubtful[best]) best = i;
  if (lines[best] == 0 || 2 * doubtful[best] >= lines[best] || lines[best] == source.line_count()) return '\0';
  reasons.push_back(std::to_string(lines[best]) + " lines begin with " + candidates[best] +
                    ": taken as comments");
  return candidates[best];
}

// A mark that stands in the same columns of nearly all lines, with a name before it.
void find_separator(const SourceText& source, Facts& facts) {
  for (const std::string_view mark : {"!!", "::", "||", "|", ":"}) {
    std::map<std::size_t, int> places;
    std::set<std::string_view> names;
    int lines = 0;
    for (int n = 1; n <= source.line_count(); ++n) {
      const std::string_view line = source.line(n);
      if (all_blank(line)) continue;
      ++lines;
      const std::size_t at = line.find(mark);
      if (at != std::string_view::npos && at > 0 && at <= 80 && !trimmed(line.substr(0, at)).empty())
        ++places[at];
      if (at != std::string_view::npos && names.size() <= kMostNames) names.insert(trimmed(line.substr(0, at)));
    }
    if (names.size() > kMostNames) continue;
    for (const auto& [at, count] : places)
      if (count >= 3 && 10 * count >= 8 * lines) {
        facts.separator = mark;
        facts.name_columns = static_cast<int>(at);
        facts.reasons.push_back("\"" + std::string(mark) + "\" stands at column " + std::to_string(at + 1) +
                                " of " + std::to_string(count) + " lines of " + std::to_string(lines) +
                                ", with a name before it: the cards bear names");
        return;
      }
  }
}

// The number at the end of columns 73-80; nothing if they hold none.
std::optional<double> sequence_number(std::string_view line) {
  if (line.size() <= kSequenceStart) return std::nullopt;
  const std::string_view text = trimmed(line.substr(kSequenceStart, kSequenceEnd - kSequenceStart));
  std::size_t first = text.size();
  while (first > 0 && is_digit(text[first - 1])) --first;
  if (first == text.size()) return std::nullopt;
  if (!std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(first), is_letter))
    return std::nullopt;
  return read_free_number(text.substr(first), true).value;
}

void find_sequence(const SourceText& source, Facts& facts) {
  std::size_t lines = 0, numbered = 0, ascending = 0;
  double last = -1.0;
  for (int n = 1; n <= source.line_count(); ++n) {
    const std::string_view line = source.line(n);
    if (all_blank(line) || line[0] == facts.comment) continue;
    ++lines;
    const auto number = sequence_number(line);
    if (!number) continue;
    ++numbered;
    if (*number > last) ++ascending;
    last = *number;
  }
  facts.sequence = numbered >= 4 && 10 * numbered >= 9 * lines && 10 * ascending >= 9 * numbered;
  if (facts.sequence)
    facts.reasons.push_back("columns 73-80 hold numbers that ascend on " + percent(ascending, lines) +
                            " of the lines: taken as sequence numbers");
}

// The distance of right edges that comes most often.
int common_width(const std::map<int, int>& widths, int otherwise) {
  int best = otherwise, count = 2;
  for (const auto& [width, n] : widths)
    if (n > count) {
      best = width;
      count = n;
    }
  return best;
}

void find_widths(const std::vector<Line>& lines, Facts& facts) {
  std::map<int, int> integers, reals;
  for (const Line& line : lines)
    for (std::size_t i = 1; line.sort == Sort::numbers && i < line.tokens.size(); ++i) {
      const Token &left = line.tokens[i - 1], &right = line.tokens[i];
      if (left.kind != right.kind || left.kind == Kind::text) continue;
      ++(left.kind == Kind::integer ? integers : reals)[right.last - left.last];
    }
  facts.integer_width = common_width(integers, 5);
  facts.real_width = common_width(reals, 10);
}

bool same_kinds(const Line& a, const Line& b) {
  return a.tokens.size() == b.tokens.size() &&
         std::equal(a.tokens.begin(), a.tokens.end(), b.tokens.begin(),
                    [](const Token& s, const Token& t) { return s.kind == t.kind; });
}

bool same_edges(const Line& a, const Line& b) {
  return std::equal(a.tokens.begin(), a.tokens.end(), b.tokens.begin(), [](const Token& s, const Token& t) {
    return s.kind != Kind::integer || s.last == t.last || s.first == t.first;
  });
}

// Do numbers stand in columns?  Right edges of integers at multiples of five, or the same from line to line.
void find_columns(const std::vector<Line>& lines, Facts& facts) {
  std::size_t integers = 0, on_grid = 0, pairs = 0, aligned = 0, number_lines = 0, odd = 0;
  const Line* last = nullptr;
  for (const Line& line : lines) {
    if (line.sort != Sort::numbers) continue;
    ++number_lines;
    if (line.tokens[0].quoted || line.record.find(',') != std::string_view::npos) ++odd;
    for (const Token& token : line.tokens) {
      if (token.kind != Kind::integer || line.tokens.size() < 2) continue;
      ++integers;
      if (token.last % 5 == 0) ++on_grid;
    }
    if (last && line.tokens.size() >= 3 && same_kinds(*last, line)) {
      ++pairs;
      if (same_edges(*last, line)) ++aligned;
    }
    last = &line;
  }
  if (number_lines == 0) return;
  const bool grid = integers > 0 && 10 * on_grid >= 6 * integers;
  const bool columns = pairs >= 5 && 10 * aligned >= 8 * pairs;
  facts.grid = grid;
  if (4 * odd > number_lines) {
    facts.listed = true;
    facts.reasons.push_back("commas or texts in quotes: taken as list-directed");
  } else if (grid || columns) {
    facts.reasons.push_back("integers end at multiples of five columns (" + percent(on_grid, integers) +
                            ") and under each other (" + percent(aligned, pairs) +
                            " of like lines): taken as FORMAT columns");
  } else {
    facts.listed = true;
    facts.reasons.push_back("integers end at multiples of five columns in " + percent(on_grid, integers) +
                            " of their places, under each other in " + percent(aligned, pairs) +
                            " of like lines: taken as list-directed");
  }
}

Line line_of(const SourceText& source, int number, const Facts& facts) {
  Line line;
  line.number = number;
  std::string_view text = source.line(number);
  if (facts.comment != '\0' && !text.empty() && text[0] == facts.comment) {
    line.sort = Sort::comment;
    line.record = text;
    return line;
  }
  if (!facts.separator.empty()) {
    const auto width = static_cast<std::size_t>(facts.name_columns);
    const bool named = text.size() >= width && text.substr(width, facts.separator.size()) == facts.separator;
    line.name = trimmed(named ? text.substr(0, width) : text);
    if (named) text.remove_prefix(width + facts.separator.size());
  }
  if (facts.sequence) text = text.substr(0, kSequenceStart);
  line.record = text;
  line.tokens = tokens_of(text);
  line.sort = sort_of(line.tokens, !facts.separator.empty());
  return line;
}

}  // namespace

void split_packed(Line& line, const std::vector<Columns>& fields) {
  bool split = false;
  std::vector<Token> tokens;
  for (const Token& token : line.tokens) {
    std::vector<Token> pieces;
    if (!token.quoted && token.last - token.first >= 3) pieces = pieces_of(line, token, fields);
    split = split || pieces.size() > 1;
    if (pieces.size() < 2) pieces.assign(1, token);
    tokens.insert(tokens.end(), pieces.begin(), pieces.end());
  }
  if (!split) return;
  line.tokens = std::move(tokens);
  line.sort = sort_of(line.tokens, !line.name.empty());
}

Scan scan(const SourceText& source) {
  Scan result;
  find_separator(source, result.facts);
  if (result.facts.separator.empty()) {
    result.facts.comment = find_comment(source, result.facts.reasons);
    find_sequence(source, result.facts);
  }
  int count = source.line_count();
  while (count > 0 && all_blank(source.line(count))) --count;
  result.lines.reserve(count);
  for (int n = 1; n <= count; ++n) result.lines.push_back(line_of(source, n, result.facts));
  if (result.facts.separator.empty()) find_columns(result.lines, result.facts);
  if (!result.facts.listed) find_widths(result.lines, result.facts);
  return result;
}

}  // namespace sage::layout_draft
