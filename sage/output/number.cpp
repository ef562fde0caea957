#include "sage/output/number.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace sage {

namespace {

// digits[0] . digits[1] digits[2] ... x 10^exponent
struct Decimal {
  char digits[20];
  int exponent = 0;
};

constexpr double kSmallest = 1e-280, kLargest = 1e280;  // beyond them the library's formatter is used

const std::array<double, 309>& powers_of_ten() {
  static const std::array<double, 309> table = [] {
    std::array<double, 309> t{};
    for (std::size_t k = 0; k < t.size(); ++k) t[k] = std::pow(10.0, static_cast<double>(k));
    return t;
  }();
  return table;
}

// value x 10^power; one rounding.
double scaled(double value, int power) {
  const auto& ten = powers_of_ten();
  return power >= 0 ? value * ten[static_cast<std::size_t>(power)]
                    : value / ten[static_cast<std::size_t>(-power)];
}

// value in (kSmallest, kLargest).
Decimal decimal_of(double value, int digits) {
  int binary = 0;
  std::frexp(value, &binary);  // value in [2^(binary-1), 2^binary): the first guess is right or one too small
  int exponent = static_cast<int>(std::floor((binary - 1) * 0.30102999566398120));
  const double limit = powers_of_ten()[static_cast<std::size_t>(digits)];
  double whole = std::floor(scaled(value, digits - 1 - exponent) + 0.5);
  if (whole >= limit) whole = std::floor(scaled(value, digits - 1 - ++exponent) + 0.5);
  auto number = static_cast<std::uint64_t>(whole);
  Decimal decimal;
  decimal.exponent = exponent;
  for (int i = digits - 1; i >= 0; --i) {
    decimal.digits[i] = static_cast<char>('0' + number % 10);
    number /= 10;
  }
  return decimal;
}

// Characters of one number, with blanks before them to justify it: one append is cheaper than two.
struct Buffer {
  static constexpr int kBlanks = 24;
  char room[kBlanks + 48];
  Buffer() { std::memset(room, ' ', kBlanks); }
  char* begin() { return room + kBlanks; }
  void append_right(std::string& text, const char* end, int width) {
    const int missing = std::max(0, width - static_cast<int>(end - begin()));
    const int blanks = std::min(missing, kBlanks);
    if (missing > blanks) text.append(static_cast<std::size_t>(missing - blanks), ' ');
    text.append(begin() - blanks, static_cast<std::size_t>(end - begin() + blanks));
  }
};

char* put_exponent(char* at, int exponent) {
  *at++ = exponent < 0 ? '-' : '+';
  const int size = std::abs(exponent);
  if (size >= 100) *at++ = static_cast<char>('0' + size / 100);
  *at++ = static_cast<char>('0' + size / 10 % 10);
  *at++ = static_cast<char>('0' + size % 10);
  return at;
}

bool in_range(double size) {
  return size > kSmallest && size < kLargest;
}

// ddd.ddd for exponents near zero, d.ddde-07 beyond; trailing zeros of the digits dropped.
char* put_plain(char* at, const Decimal& decimal, int digits) {
  int last = digits;
  while (last > 1 && decimal.digits[last - 1] == '0') --last;
  const int exponent = decimal.exponent;
  if (exponent < -4 || exponent >= digits) {
    *at++ = decimal.digits[0];
    if (last > 1) *at++ = '.';
    for (int i = 1; i < last; ++i) *at++ = decimal.digits[i];
    *at++ = 'e';
    return put_exponent(at, exponent);
  }
  if (exponent < 0) {
    *at++ = '0';
    *at++ = '.';
    for (int i = -1; i > exponent; --i) *at++ = '0';
    for (int i = 0; i < last; ++i) *at++ = decimal.digits[i];
    return at;
  }
  for (int i = 0; i <= exponent; ++i) *at++ = i < last ? decimal.digits[i] : '0';
  if (last > exponent + 1) *at++ = '.';
  for (int i = exponent + 1; i < last; ++i) *at++ = decimal.digits[i];
  return at;
}

}  // namespace

void append_scientific(std::string& text, double value, int width, int digits) {
  const double size = std::abs(value);
  Buffer buffer;
  char* at = buffer.begin();
  if (value == 0.0) value = 0.0;  // no minus sign
  if (!in_range(size))
    return buffer.append_right(text, fmt::format_to(at, "{:.{}E}", value, digits - 1), width);
  const Decimal decimal = decimal_of(size, digits);
  if (value < 0.0) *at++ = '-';
  *at++ = decimal.digits[0];
  *at++ = '.';
  std::memcpy(at, decimal.digits + 1, static_cast<std::size_t>(digits - 1));
  at += digits - 1;
  *at++ = 'E';
  buffer.append_right(text, put_exponent(at, decimal.exponent), width);
}

void append_plain(std::string& text, double value, int digits) {
  if (value == 0.0) {
    text += '0';
    return;
  }
  const double size = std::abs(value);
  if (!in_range(size)) {
    fmt::format_to(std::back_inserter(text), "{:.{}g}", value, digits);
    return;
  }
  char buffer[48];
  char* at = buffer;
  if (value < 0.0) *at++ = '-';
  text.append(buffer, put_plain(at, decimal_of(size, digits), digits));
}

void append_integer(std::string& text, long value, int width) {
  Buffer buffer;
  buffer.append_right(text, fmt::format_to(buffer.begin(), FMT_COMPILE("{}"), value), width);
}

}  // namespace sage
