#include "sage/record/number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace sage {
namespace {

std::string scientific(double value, int width, int digits) {
  std::string text;
  append_scientific(text, value, width, digits);
  return text;
}

std::string plain(double value, int digits) {
  std::string text;
  append_plain(text, value, digits);
  return text;
}

TEST(Scientific, FillsItsColumn) {
  EXPECT_EQ(scientific(12.345, 12, 5), "  1.2345E+01");
  EXPECT_EQ(scientific(-0.00012345, 12, 5), " -1.2345E-04");
  EXPECT_EQ(scientific(9.99996, 12, 5), "  1.0000E+01");
  EXPECT_EQ(scientific(0.0, 12, 5), "  0.0000E+00");
  EXPECT_EQ(scientific(-0.0, 12, 5), "  0.0000E+00");
  EXPECT_EQ(scientific(1.5e-120, 12, 5), " 1.5000E-120");
}

// Also where a column has no room for the widest number, and where the library's formatter writes it.
TEST(Scientific, SeveralAreWrittenAsOneAfterTheOther) {
  const double values[] = {12.345, -1.5e-120, 0.0, -0.0, -1e-300, std::numeric_limits<double>::infinity(),
                           9.99996};
  for (const int width : {3, 11, 12, 60}) {
    std::string one_by_one, together;
    for (const double value : values) append_scientific(one_by_one, value, width, 5);
    append_scientific(together, values, width, 5);
    EXPECT_EQ(together, one_by_one);
  }
}

TEST(Scientific, IsWhatPrintfWrites) {
  // 20000 numbers over 40 decades; %E rounds correctly, so every difference is ours.
  double value = 1.2345678901234e-20;
  for (int i = 0; i < 20000; ++i) {
    value *= 1.0046;
    char expected[64];
    std::snprintf(expected, sizeof expected, "%14.6E", -value);
    ASSERT_EQ(scientific(-value, 14, 7), expected);
  }
}

TEST(Scientific, PassesOnWhatIsNoNumber) {
  EXPECT_EQ(scientific(std::numeric_limits<double>::quiet_NaN(), 6, 5), "   NAN");
  EXPECT_EQ(scientific(std::numeric_limits<double>::infinity(), 6, 5), "   INF");
  EXPECT_EQ(scientific(1e300, 12, 5), " 1.0000E+300");
  EXPECT_EQ(scientific(1e-300, 12, 5), " 1.0000E-300");
}

TEST(Plain, DropsTrailingZeros) {
  EXPECT_EQ(plain(0.0, 10), "0");
  EXPECT_EQ(plain(-0.0, 10), "0");
  EXPECT_EQ(plain(0.25, 10), "0.25");
  EXPECT_EQ(plain(-120.0, 10), "-120");
  EXPECT_EQ(plain(0.1 + 0.2, 10), "0.3");
  EXPECT_EQ(plain(1.0 / 3.0, 10), "0.3333333333");
  EXPECT_EQ(plain(1234567890.0, 10), "1234567890");
  EXPECT_EQ(plain(12345678901.0, 10), "1.23456789e+10");
  EXPECT_EQ(plain(0.0001, 10), "0.0001");
  EXPECT_EQ(plain(0.00001, 10), "1e-05");
  EXPECT_EQ(plain(-1.5e-7, 10), "-1.5e-07");
}

TEST(Plain, ReadsBackToItsDigits) {
  double value = 3.3e-15;
  for (int i = 0; i < 5000; ++i) {
    value *= -1.0139;
    ASSERT_NEAR(std::stod(plain(value, 10)) / value, 1.0, 5.1e-10);  // half a unit of the tenth digit
  }
}

TEST(Integer, FillsItsColumn) {
  std::string text;
  append_integer(text, -42, 6);
  append_integer(text, 7, 0);
  append_integer(text, 0, 2);
  append_integer(text, 100, 4);
  append_integer(text, std::numeric_limits<long>::min(), 0);
  EXPECT_EQ(text, "   -427 0 100" + std::to_string(std::numeric_limits<long>::min()));
}

}  // namespace
}  // namespace sage
