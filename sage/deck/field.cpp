#include "sage/deck/field.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr int largest_free_exponent = 99999;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::size_t skip_blanks(std::string_view text, std::size_t i) {
  while (i < text.size() && text[i] == ' ') ++i;
  return i;
}

FieldResult fail(FieldResult result, FieldFault fault, std::size_t at) {
  result.fault = fault;
  result.at = static_cast<std::uint16_t>(at);
  result.value = 0.0;
  return result;
}

// Digits of a number as they will be parsed: short fields stay on the stack.
class DigitBuffer {
 public:
  void push(char c) {
    if (size_ < small_.size()) {
      small_[size_++] = c;
      return;
    }
    if (large_.empty()) large_.assign(small_.begin(), small_.end());
    large_.push_back(c);
    ++size_;
  }
  std::string_view view() const {
    return large_.empty() ? std::string_view(small_.data(), size_) : std::string_view(large_);
  }

 private:
  std::array<char, 64> small_;
  std::string large_;
  std::size_t size_ = 0;
};

// Power of ten of the first digit that isn't zero; false if the mantissa is zero.
bool leading_power(std::string_view mantissa, int& power) {
  const std::size_t point = mantissa.find('.');
  const std::size_t whole = point == std::string_view::npos ? mantissa.size() : point;
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  power = first < whole ? static_cast<int>(whole - first) - 1 : -static_cast<int>(first - whole);
  return true;
}

// NaN, NaN(...), Inf or Infinity after the sign, as gfortran accepts them.
bool read_not_finite(std::string_view text, double& value) {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  std::string word;
  for (char c : text) word.push_back(lower(c));
  if (word == "inf" || word == "infinity") {
    value = std::numeric_limits<double>::infinity();
    return true;
  }
  const bool nan = word == "nan" || (word.size() > 4 && word.compare(0, 4, "nan(") == 0 && word.back() == ')');
  if (nan) value = std::numeric_limits<double>::quiet_NaN();
  return nan;
}

// Exponent of a real field: blanks, sign, digits.  Sets the fault if it isn't one.
int read_exponent(std::string_view text, std::size_t i, NumberForm form, FieldResult& result) {
  i = skip_blanks(text, i);
  const bool negative = i < text.size() && text[i] == '-';
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  if (i == text.size()) {
    result = fail(result, FieldFault::no_exponent, text.size() - 1);
    return 0;
  }
  int exponent = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ' && form.blanks == BlankMode::null) continue;
    if (!is_digit(c) && c != ' ') {
      result = fail(result, FieldFault::bad_character, i);
      return 0;
    }
    exponent = 10 * exponent + (c == ' ' ? 0 : c - '0');
    if (form.free) exponent = std::min(exponent, largest_free_exponent);
    if (exponent > 999999) {
      result = fail(result, FieldFault::exponent_range, i);
      return 0;
    }
  }
  return negative ? -exponent : exponent;
}

// Correctly rounded value of the digits times 10^exponent; infinity where no double is large enough.
double decimal_value(DigitBuffer& digits, int exponent) {
  const std::size_t mantissa_size = digits.view().size();
  if (exponent != 0) {
    std::array<char, 16> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), exponent).ptr;
    digits.push('e');
    for (const char* c = text.data(); c != end; ++c) digits.push(*c);
  }
  const std::string_view all = digits.view();
  double value = 0.0;
  const auto outcome = std::from_chars(all.data(), all.data() + all.size(), value);
  if (outcome.ec != std::errc::result_out_of_range) return value;
  int power = 0;
  const bool large = leading_power(all.substr(0, mantissa_size), power) && power + exponent > 0;
  return large ? std::numeric_limits<double>::infinity() : 0.0;
}

struct Mantissa {
  DigitBuffer digits;  // with its point, and with zeros where the mode makes blanks zeros
  bool point = false;
  bool ended_by_exponent = false;
};

// Digits, blanks and one point, from text[i] to the end or to an exponent, whose place is returned.
std::size_t scan_mantissa(std::string_view text, std::size_t i, BlankMode blanks, Mantissa& mantissa,
                          FieldResult& result) {
  bool digit = false, blank_behind = false;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ') {
      blank_behind = digit || mantissa.point;
      if (blanks == BlankMode::null) continue;
      digit = true;
      mantissa.digits.push('0');
      continue;
    }
    const char letter = lower(c);
    mantissa.ended_by_exponent = c == '+' || c == '-' || letter == 'e' || letter == 'd' || letter == 'q';
    if (letter == 'q') result.hints |= hint_q_exponent;
    if (mantissa.ended_by_exponent) break;
    if (!is_digit(c) && c != '.') result = fail(result, FieldFault::bad_character, i);
    if (c == '.' && mantissa.point) result = fail(result, FieldFault::second_point, i);
    if (result.fault != FieldFault::none) return i;
    if (blank_behind) result.hints |= hint_inner_blank;
    blank_behind = false;
    if (c == '.' && !digit) mantissa.digits.push('0');
    mantissa.digits.push(c);
    (c == '.' ? mantissa.point : digit) = true;
  }
  if (!digit) {
    result.hints |= hint_lone_mark;
    mantissa.digits.push('0');
  }
  if (blank_behind) result.hints |= hint_trailing_blank;
  const bool letter = i < text.size() && text[i] != '+' && text[i] != '-';
  return letter ? i + 1 : i;  // a sign belongs to the exponent
}

}  // namespace

const char* read_plain_integer(const char* at, const char* end, double& value) {
  const bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) ++at;
  const char* const last = end - at > 9 ? at + 9 : end;  // nine digits are within the range
  const char* const first = at;
  std::int32_t number = 0;
  for (; at < last && is_digit(*at); ++at) number = 10 * number + (*at - '0');
  if (at == first || (at < end && *at != ' ')) return nullptr;
  value = negative ? -number : number;
  return at;
}

// Digits and power of ten that are both exact doubles: their quotient is rounded once, and so correctly.
const char* read_plain_real(const char* at, const char* end, int decimals, double& value) {
  constexpr std::int64_t most_digits = std::int64_t{1} << 53;
  static constexpr std::array<double, 19> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
  const bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) ++at;
  const char* const last = end - at > 18 ? at + 18 : end;  // eighteen characters stay below 2^63
  const char* const first = at;
  const char* behind_point = nullptr;
  std::int64_t digits = 0;
  for (; at < last; ++at) {
    if (is_digit(*at)) {
      digits = 10 * digits + (*at - '0');
    } else if (*at == '.' && behind_point == nullptr) {
      behind_point = at + 1;
    } else {
      break;
    }
  }
  const bool none = at == first || (behind_point != nullptr && at - first == 1);
  if (none || digits > most_digits || (at < end && *at != ' ')) return nullptr;
  if (behind_point == nullptr && decimals > 0) return nullptr;
  const std::ptrdiff_t power = behind_point == nullptr ? 0 : at - behind_point;
  const double number = static_cast<double>(digits);
  const double magnitude = power == 0 ? number : number / powers[power];
  value = negative ? -magnitude : magnitude;
  return at;
}

FieldResult read_integer_field(std::string_view text, BlankMode blanks) {
  FieldResult result;
  std::size_t i = skip_blanks(text, 0);
  if (i == text.size()) {
    result.blank = true;
    return result;
  }
  if (read_plain_integer(text.data() + i, text.data() + text.size(), result.value) == text.data() + text.size())
    return result;
  const bool negative = text[i] == '-';
  if (text[i] == '-' || text[i] == '+') {
    if (++i == text.size()) return fail(result, FieldFault::lone_sign, i - 1);
  }
  const std::int64_t limit = negative ? 2147483648LL : 2147483647LL;
  std::int64_t value = 0;
  bool digit_seen = false, blank_after_digit = false;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ' ') {
      blank_after_digit = digit_seen;
      if (blanks == BlankMode::null) continue;
    } else if (!is_digit(c)) {
      return fail(result, FieldFault::bad_character, i);
    } else {
      if (blank_after_digit) result.hints |= hint_inner_blank;
      digit_seen = true;
      blank_after_digit = false;
    }
    value = 10 * value + (c == ' ' ? 0 : c - '0');
    if (value > limit) return fail(result, FieldFault::integer_range, i);
  }
  if (!digit_seen) result.hints |= hint_lone_mark;
  if (blank_after_digit) result.hints |= hint_trailing_blank;
  result.value = static_cast<double>(negative ? -value : value);
  return result;
}

FieldResult read_real_field(std::string_view text, NumberForm form) {
  FieldResult result;
  std::size_t i = skip_blanks(text, 0);
  if (i == text.size()) {
    result.blank = true;
    return result;
  }
  const char* const end = text.data() + text.size();
  if (form.scale == 0 && read_plain_real(text.data() + i, end, form.decimals, result.value) == end)
    return result;
  const bool negative = text[i] == '-';
  if (text[i] == '-' || text[i] == '+') i = skip_blanks(text, i + 1);
  if (i == text.size()) {  // gfortran: a lone sign is zero
    result.hints |= hint_lone_mark;
    return result;
  }
  if (text.size() - i >= 3 && (lower(text[i]) == 'n' || lower(text[i]) == 'i')) {
    if (!read_not_finite(text.substr(i), result.value)) return fail(result, FieldFault::bad_character, i);
    result.hints |= hint_not_finite;
    if (negative) result.value = -result.value;
    return result;
  }
  Mantissa mantissa;
  i = scan_mantissa(text, i, form.blanks, mantissa, result);
  int exponent = -form.scale;
  if (mantissa.ended_by_exponent && result.fault == FieldFault::none)
    exponent = read_exponent(text, i, form, result);
  if (result.fault != FieldFault::none) return result;
  if (!mantissa.point) {
    exponent -= form.decimals;
    if (form.decimals > 0 && !mantissa.ended_by_exponent) result.hints |= hint_implied_point;
  }
  if (!form.free && (exponent >= 10000 || exponent <= -10000))
    return fail(result, FieldFault::exponent_range, text.size() - 1);
  const double magnitude = decimal_value(mantissa.digits, exponent);
  if (std::isinf(magnitude)) result.hints |= hint_overflow;
  result.value = negative ? -magnitude : magnitude;
  return result;
}

FieldResult read_logical_field(std::string_view text) {
  FieldResult result;
  std::size_t i = skip_blanks(text, 0);
  if (i == text.size()) {
    result.blank = true;
    return result;
  }
  if (text[i] == '.') ++i;
  const char c = i < text.size() ? lower(text[i]) : ' ';
  if (c != 't' && c != 'f') return fail(result, FieldFault::bad_character, i < text.size() ? i : i - 1);
  result.value = c == 't' ? 1.0 : 0.0;
  return result;
}

FieldResult read_free_number(std::string_view text, bool integer) {
  FieldResult result;
  const bool sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  if (integer) {
    result = read_integer_field(text, BlankMode::null);
  } else {
    const bool letter_first = text.size() > (sign ? 1u : 0u) && !is_digit(text[sign]) && text[sign] != '.';
    result = read_real_field(text, {0, 0, BlankMode::null, true});
    if (letter_first && !(result.hints & hint_not_finite)) return fail(result, FieldFault::bad_character, sign);
    if (result.hints & hint_lone_mark) return fail(result, FieldFault::bad_character, 0);
  }
  return result;
}

const char* fault_text(FieldFault fault) {
  switch (fault) {
    case FieldFault::none:
      return "is right";
    case FieldFault::bad_character:
    case FieldFault::second_point:
      return "is not a number";
    case FieldFault::lone_sign:
      return "is a sign without a number";
    case FieldFault::no_exponent:
      return "has an exponent letter without an exponent";
    case FieldFault::exponent_range:
      return "has an exponent out of range";
    case FieldFault::integer_range:
      return "is beyond the range of integers (2147483647)";
    case FieldFault::no_value:
      return "is not a value of the kind wanted here";
  }
  return "is not a number";
}

}  // namespace sage
