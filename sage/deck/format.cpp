#include "sage/deck/format.hpp"

#include <limits>

namespace sage {

namespace {

constexpr int max_number = 100000;
constexpr double max_unrolled = 1e6;  // steps of one pass: keeps a silly FORMAT from running for ever

// Steps of one pass over [begin, end) with groups unrolled; a "*" group counts once.
double unrolled_steps(const std::vector<FormatStep>& steps, int begin, int end) {
  double total = 0.0;
  for (int i = begin; i < end; ++i) {
    const FormatStep& step = steps[i];
    ++total;
    if (step.edit != Edit::group_begin) continue;
    const bool unlimited = step.repeat == std::numeric_limits<int>::max();
    total += (unlimited ? 1.0 : step.repeat) * (1.0 + unrolled_steps(steps, i + 1, step.partner));
    i = step.partner;
  }
  return total;
}

// Recursive descent over the FORMAT text with its blanks taken out.
class FormatParser {
 public:
  explicit FormatParser(std::string_view text) : original_(text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] != ' ') {
        const char c = text[i];
        text_.push_back(c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c);
        columns_.push_back(static_cast<int>(i) + 1);
      }
  }

  Format parse() {
    format_.text = std::string(original_);
    if (peek() != '(') fail("a FORMAT starts with \"(\"");
    ++at_;
    group(1);
    if (at_ != text_.size()) fail("characters after the closing parenthesis");
    format_.steps.push_back({Edit::end, 1, 0, 0, 0});
    if (unrolled_steps(format_.steps, 0, static_cast<int>(format_.steps.size())) > max_unrolled)
      fail("repeat counts of the groups are too large");
    for (std::size_t i = static_cast<std::size_t>(format_.revert_to); i < format_.steps.size(); ++i)
      if (is_data(format_.steps[i].edit)) format_.reversion_has_data = true;
    return std::move(format_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    const int last = static_cast<int>(original_.size());
    throw FormatError(at_ < columns_.size() ? columns_[at_] : last, message);
  }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool is_number() const { return peek() >= '0' && peek() <= '9'; }

  int number() {
    int value = 0;
    while (is_number()) {
      value = 10 * value + (text_[at_] - '0');
      if (value > max_number) fail("number too large");
      ++at_;
    }
    return value;
  }
  int needed_number(const char* what) {
    if (!is_number()) fail(std::string("a number is missing: ") + what);
    const int value = number();
    if (value == 0) fail(std::string("zero is not allowed: ") + what);
    return value;
  }

  void add(Edit edit, int repeat = 1, int width = 0, int decimals = 0) {
    if (format_.steps.size() > 5000) fail("FORMAT too long");
    format_.steps.push_back({edit, repeat, width, decimals, 0});
  }

  // Items up to the closing parenthesis; commas between them are optional (a gfortran extension).
  void group(int depth) {
    if (depth > FormatWalker::max_depth) fail("groups are nested too deeply");
    bool comma_allowed = false;
    while (peek() != ')') {
      if (at_ == text_.size()) fail("\")\" is missing");
      if (peek() == ',') {
        if (!comma_allowed) fail("unexpected \",\"");
        comma_allowed = false;
        ++at_;
        continue;
      }
      item(depth);
      comma_allowed = true;
    }
    ++at_;
  }

  void item(int depth) {
    const bool negative = peek() == '-';
    const bool sign = negative || peek() == '+';
    if (sign) ++at_;
    const bool unlimited = !sign && peek() == '*';
    if (unlimited) ++at_;
    const bool counted = is_number();
    int count = counted ? number() : 1;
    if (unlimited) count = std::numeric_limits<int>::max();
    if (peek() == 'P' && counted) return scale_factor(negative ? -count : count);
    if (sign) fail("a sign belongs before kP only");
    if (counted && count == 0) fail("a repeat count of zero");
    if (peek() == '(') return nested(count, depth);
    if (unlimited) fail("\"*\" belongs before a group");
    edit(count, counted);
  }

  void scale_factor(int k) {
    ++at_;
    add(Edit::scale, 1, k);
  }

  void nested(int count, int depth) {
    ++at_;
    const std::size_t begin = format_.steps.size();
    if (depth == 1) format_.revert_to = static_cast<int>(begin);
    add(Edit::group_begin, count);
    group(depth + 1);
    const std::size_t end = format_.steps.size();
    add(Edit::group_end);
    bool data = false;
    for (std::size_t i = begin; i < end; ++i) data = data || is_data(format_.steps[i].edit);
    if (!data && count == std::numeric_limits<int>::max())
      fail("an unlimited group without a field never ends");
    format_.steps[end].partner = static_cast<int>(begin);
    format_.steps[begin].partner = static_cast<int>(end);
  }

  void edit(int count, bool counted) {
    const char c = peek();
    ++at_;
    switch (c) {
      case 'I':
        return integer(count);
      case 'F':
      case 'D':
        return real(count, Decimals::needed, Exponent::none);
      case 'E':
        if (peek() == 'S' || peek() == 'N') ++at_;
        return real(count, Decimals::needed, Exponent::allowed);
      case 'G':
        return real(count, Decimals::optional, Exponent::allowed);
      case 'L':
        return add(Edit::logical, count, needed_number("width of L"));
      case 'A':
        return add(Edit::text, count, is_number() ? needed_number("width of A") : 0);
      case 'X':
        return add(Edit::tab_by, 1, count);
      case '/':
        return add(Edit::next_record, 1, count);
      case ':':
        return add(Edit::stop);
      case 'T':
      case 'B':
        break;
      case 'S':
        if (peek() == 'P' || peek() == 'S') ++at_;
        return;  // signs of output: nothing to do when reading
      default:
        --at_;
        fail(std::string("unexpected \"") + (c ? std::string(1, c) : std::string("end")) + "\"");
    }
    if (counted) fail("a repeat count has no place here");
    c == 'T' ? tab() : blanks();
  }

  void tab() {
    if (peek() == 'L' || peek() == 'R') {
      const bool left = peek() == 'L';
      ++at_;
      const int n = needed_number("columns of TL and TR");
      return add(Edit::tab_by, 1, left ? -n : n);
    }
    add(Edit::tab_to, 1, needed_number("column of T"));
  }

  void blanks() {
    if (peek() != 'N' && peek() != 'Z') fail("unexpected \"B\" (BN and BZ are known)");
    add(peek() == 'N' ? Edit::blanks_null : Edit::blanks_zero);
    ++at_;
  }

  void integer(int count) {
    const int width = needed_number("width of I");
    if (peek() == '.') {
      ++at_;
      if (!is_number()) fail("a number is missing: m of Iw.m");
      number();
    }
    add(Edit::integer, count, width);
  }

  enum class Decimals { needed, optional };
  enum class Exponent { none, allowed };

  void real(int count, Decimals wanted, Exponent exponent) {
    const int width = needed_number("width of a real field");
    int decimals = 0;
    if (peek() == '.') {
      ++at_;
      if (!is_number()) fail("a number is missing: decimals of a real field");
      decimals = number();
    } else if (wanted == Decimals::needed) {
      fail("a real field needs its decimals: F10.0, not F10");
    }
    // Ew.dEe and Gw.dEe: e doesn't matter when reading.  Fw.d and Dw.d have none: an E
    // behind them is the next item.
    if (exponent == Exponent::allowed && peek() == 'E' && peek(1) >= '0' && peek(1) <= '9') {
      ++at_;
      needed_number("exponent digits");
    }
    add(wanted == Decimals::needed ? Edit::real : Edit::general, count, width, decimals);
  }

  std::string_view original_;
  std::string text_;
  std::vector<int> columns_;
  std::size_t at_ = 0;
  Format format_;
};

}  // namespace

Format compile_format(std::string_view text) {
  return FormatParser(text).parse();
}

const FormatStep& FormatWalker::next() {
  if (left_ > 0) {
    --left_;
    return steps_[at_ - 1];
  }
  for (;;) {
    const FormatStep& step = steps_[at_];
    switch (step.edit) {
      case Edit::end:
        return step;
      case Edit::group_begin:
        loops_[depth_++] = {at_, step.repeat - 1};
        ++at_;
        break;
      case Edit::group_end:
        if (loops_[depth_ - 1].left > 0) {
          --loops_[depth_ - 1].left;
          at_ = step.partner + 1;
        } else {
          --depth_;
          ++at_;
        }
        break;
      default:
        ++at_;
        if (is_data(step.edit)) left_ = step.repeat - 1;
        return step;
    }
  }
}

void FormatWalker::revert() {
  at_ = revert_to_;
  left_ = 0;
  depth_ = 0;
}

}  // namespace sage
