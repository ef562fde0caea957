#include "sage/record/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

// digits[0] . digits[1] digits[2] ... x 10^exponent, the digits as one number.
struct Decimal {
  std::uint64_t number = 0;
  int exponent = 0;
};

constexpr int kBesidesDigits = 7;                       // sign, point, E, its sign and three digits
constexpr int kFastDigits = 15;                         // more don't survive the scaling by a power of ten
constexpr double kSmallest = 1e-280, kLargest = 1e280;  // beyond them the library's formatter is used

const std::array<double, 309>& powers_of_ten() {
  static const std::array<double, 309> table = [] {
    std::array<double, 309> t{};
    for (std::size_t k = 0; k < t.size(); ++k) t[k] = std::pow(10.0, static_cast<double>(k));
    return t;
  }();
  return table;
}

// value x 10^power, which is 1 or more, to the nearest integer; one rounding before.
inline std::uint64_t scaled(double value, int power) {
  const auto& ten = powers_of_ten();
  const double half = 0.5 + (power >= 0 ? value * ten[power] : value / ten[-power]);
  return static_cast<std::uint64_t>(half);
}

// value in (kSmallest, kLargest).
inline Decimal decimal_of(double value, int digits) {
  // value in [2^binary, 2^(binary + 1)): the first guess is right or one too small.
  const std::int64_t binary = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
  constexpr std::int64_t kLog2 = 1292913986;  // log10(2) 2^32
  Decimal decimal;
  decimal.exponent = static_cast<int>((binary * kLog2) >> 32);
  decimal.number = scaled(value, digits - 1 - decimal.exponent);
  if (decimal.number >= static_cast<std::uint64_t>(powers_of_ten()[digits]))
    decimal.number = scaled(value, digits - 1 - ++decimal.exponent);
  return decimal;
}

// "00", "01" ... "99".
constexpr std::array<char, 200> kPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t k = 0; k < 100; ++k) {
    pairs[2 * k] = static_cast<char>('0' + k / 10);
    pairs[2 * k + 1] = static_cast<char>('0' + k % 10);
  }
  return pairs;
}();

// Writes the last `count` digits of `number` before `end`; returns what is left of it.
template <class Unsigned>
inline Unsigned put_digits(char* end, Unsigned number, int count) {
  for (; count >= 2; count -= 2) {
    end -= 2;
    std::memcpy(end, &kPairs[2 * (number % 100)], 2);
    number /= 100;
  }
  if (count > 0) {
    *--end = static_cast<char>('0' + number % 10);
    number /= 10;
  }
  return number;
}

// In 32 bits where they do: a division there costs a third.
inline std::uint64_t put_digits_before(char* end, std::uint64_t number, int count) {
  if (number <= std::numeric_limits<std::uint32_t>::max())
    return put_digits(end, static_cast<std::uint32_t>(number), count);
  return put_digits(end, number, count);
}

int exponent_digits(int exponent) {
  return std::abs(exponent) >= 100 ? 3 : 2;
}

// "+07" before `end`.
inline void put_exponent_before(char* end, int exponent) {
  const int size = exponent_digits(exponent);
  if (size == 2) {
    std::memcpy(end - 2, &kPairs[2 * static_cast<std::size_t>(std::abs(exponent))], 2);
    end[-3] = exponent < 0 ? '-' : '+';
    return;
  }
  put_digits(end, static_cast<std::uint32_t>(std::abs(exponent)), size);
  end[-size - 1] = exponent < 0 ? '-' : '+';
}

char* put_exponent(char* at, int exponent) {
  at += 1 + exponent_digits(exponent);
  put_exponent_before(at, exponent);
  return at;
}

// A number that is written from its last character on, with blanks before it.
struct FromTheRight {
  static constexpr int kRoom = 48;  // more than any number takes
  char text[kRoom];

  FromTheRight() { std::memset(text, ' ', kRoom); }
  char* end() { return text + kRoom; }
  // Its last `count` characters, justified to the right in `width`.
  void append_to(std::string& all, int count, int width) {
    if (width > kRoom) all.append(static_cast<std::size_t>(width - kRoom), ' ');
    const int size = std::max(count, std::min(width, kRoom));
    all.append(end() - size, static_cast<std::size_t>(size));
  }
};

bool in_range(double size) {
  return size > kSmallest && size < kLargest;
}

// Writes it before `end`; returns the number of its characters, at most `digits` + kBesidesDigits.
int put_scientific_before(char* end, double value, int digits) {
  const double size = std::abs(value);
  if (size != 0.0 && !in_range(size)) {
    char buffer[FromTheRight::kRoom];
    const auto count = fmt::format_to(buffer, "{:.{}E}", value, digits - 1) - buffer;
    std::memcpy(end - count, buffer, static_cast<std::size_t>(count));
    return static_cast<int>(count);
  }
  const Decimal decimal = size != 0.0 ? decimal_of(size, digits) : Decimal{};
  put_exponent_before(end, decimal.exponent);
  char* at = end - 2 - exponent_digits(decimal.exponent);
  *at = 'E';
  const auto first = static_cast<char>('0' + put_digits_before(at, decimal.number, digits - 1));
  at -= digits;
  *at = '.';
  *--at = first;
  if (value < 0.0) *--at = '-';
  return static_cast<int>(end - at);
}

// ddd.ddd for exponents near zero, d.ddde-07 beyond; trailing zeros of the digits dropped.
char* put_plain(char* at, const Decimal& decimal, int digits) {
  char digit[20];
  put_digits_before(digit + digits, decimal.number, digits);
  int last = digits;
  while (last > 1 && digit[last - 1] == '0') --last;
  const int exponent = decimal.exponent;
  if (exponent < -4 || exponent >= digits) {
    *at++ = digit[0];
    if (last > 1) *at++ = '.';
    for (int i = 1; i < last; ++i) *at++ = digit[i];
    *at++ = 'e';
    return put_exponent(at, exponent);
  }
  if (exponent < 0) {
    *at++ = '0';
    *at++ = '.';
    for (int i = -1; i > exponent; --i) *at++ = '0';
    for (int i = 0; i < last; ++i) *at++ = digit[i];
    return at;
  }
  for (int i = 0; i <= exponent; ++i) *at++ = i < last ? digit[i] : '0';
  if (last > exponent + 1) *at++ = '.';
  for (int i = exponent + 1; i < last; ++i) *at++ = digit[i];
  return at;
}

}  // namespace

void append_scientific(std::string& text, double value, int width, int digits) {
  FromTheRight room;
  const int count = put_scientific_before(room.end(), value, digits);
  room.append_to(text, count, width);
}

void append_scientific(std::string& text, std::span<const double> values, int width, int digits) {
  if (width < digits + kBesidesDigits) {  // some may be wider
    for (const double value : values) append_scientific(text, value, width, digits);
    return;
  }
  text.append(values.size() * static_cast<std::size_t>(width), ' ');
  char* end = text.data() + text.size();
  for (std::size_t k = values.size(); k-- > 0; end -= width) put_scientific_before(end, values[k], digits);
}

void append_plain(std::string& text, double value, int digits) {
  if (value == 0.0) {
    text += '0';
    return;
  }
  const double size = std::abs(value);
  if (!in_range(size) || digits > kFastDigits) {
    fmt::format_to(std::back_inserter(text), "{:.{}g}", value, digits);
    return;
  }
  char buffer[48];
  char* at = buffer;
  if (value < 0.0) *at++ = '-';
  text.append(buffer, put_plain(at, decimal_of(size, digits), digits));
}

void append_result_cell(std::string& text, double value, int digits) {
  if (!std::isfinite(value))
    throw AnalysisError(
        "S507", fmt::format("a result is {}, no finite number: the model's numbers are too large or too "
                            "small to compute with",
                            std::isnan(value) ? "undefined" : "infinite"));
  text += ',';
  append_plain(text, value, digits);
}

void append_optional_cell(std::string& text, double value, int digits) {
  text += ',';
  if (std::isfinite(value)) append_plain(text, value, digits);
}

void append_integer(std::string& text, long value, int width) {
  FromTheRight room;
  char* at = room.end();
  std::uint64_t left =
      value < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  for (; left >= 10; at -= 2) left = put_digits_before(at, left, 2);
  if (left > 0 || at == room.end()) *--at = static_cast<char>('0' + left);
  if (value < 0) *--at = '-';
  room.append_to(text, static_cast<int>(room.end() - at), width);
}

}  // namespace sage
