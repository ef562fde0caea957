// One field at a time; expected values are what Fortran 2018 13.7 says, beyond the golden table.
#include "sage/deck/field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sage {
namespace {

double real(std::string_view text, int decimals = 0, int scale = 0, BlankMode blanks = BlankMode::null) {
  const FieldResult result = read_real_field(text, {decimals, scale, blanks});
  EXPECT_EQ(result.fault, FieldFault::none) << text;
  return result.value;
}

TEST(RealField, ReadsWhatOldProgramsWrote) {
  EXPECT_EQ(real("   1.5D-3"), 1.5e-3);
  EXPECT_EQ(real(" 1.5-3   "), 1.5e-3);
  EXPECT_EQ(real("   .5E+02"), 50.0);
  EXPECT_EQ(real("   -12.  "), -12.0);
  EXPECT_EQ(real("1 2 3.4  "), 123.4);
}

TEST(RealField, ImpliedDecimalsAreThoseOfTheFormat) {
  EXPECT_EQ(real("     12345", 3), 12.345);
  EXPECT_EQ(real("   12345.0", 3), 12345.0);
  EXPECT_EQ(real("        10", 5), 1e-4);  // the classic mistake
  EXPECT_EQ(read_real_field("        10", {5, 0, BlankMode::null}).hints & hint_implied_point,
            hint_implied_point);
}

TEST(RealField, IsCorrectlyRounded) {
  // Half an ulp above 1: ties to even, and the next digit decides.
  EXPECT_EQ(real("1.00000000000000011102230246251565404"), 1.0);
  EXPECT_EQ(real("1.00000000000000011102230246251565405"), 1.0 + std::numeric_limits<double>::epsilon());
  // Scaling a parsed integer by 10^-23 afterwards would miss by one bit.
  EXPECT_EQ(real("9007199254740993", 23), 9007199254740993e-23);
}

TEST(RealField, OverflowAndUnderflow) {
  const FieldResult large = read_real_field("1E400", {});
  EXPECT_TRUE(std::isinf(large.value));
  EXPECT_TRUE(large.hints & hint_overflow);
  EXPECT_EQ(real("1.7976931348623157E308"), std::numeric_limits<double>::max());
  EXPECT_EQ(real("1E-400"), 0.0);
  EXPECT_EQ(real("4.9406564584124654E-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(read_real_field("1E99999", {}).fault, FieldFault::exponent_range);
}

TEST(RealField, SaysWhereItWentWrong) {
  const FieldResult second = read_real_field("  1.2.3", {});
  EXPECT_EQ(second.fault, FieldFault::second_point);
  EXPECT_EQ(second.at, 5);
  EXPECT_EQ(read_real_field(" 1O.5", {}).at, 2);
  EXPECT_EQ(read_real_field("1.5E", {}).fault, FieldFault::no_exponent);
  EXPECT_TRUE(read_real_field("  NaN", {}).hints & hint_not_finite);
  EXPECT_TRUE(read_real_field(" 1 2.5", {}).hints & hint_inner_blank);
  EXPECT_FALSE(read_real_field(" 12.5 ", {}).hints & hint_inner_blank);
}

TEST(RealField, ZeroModeTurnsBlanksIntoZeros) {
  EXPECT_EQ(real("15  ", 0, 0, BlankMode::zero), 1500.0);
  EXPECT_EQ(real("  15", 0, 0, BlankMode::zero), 15.0);
  EXPECT_EQ(real("15  ", 1, 0, BlankMode::zero), 150.0);
}

TEST(RealField, VeryLongFieldsAreReadInFull) {
  const std::string digits(5000, '1');
  EXPECT_EQ(real("0." + digits), 1.0 / 9.0);
}

TEST(IntegerField, RangeIs32Bits) {
  EXPECT_EQ(read_integer_field("2147483647", BlankMode::null).value, 2147483647.0);
  EXPECT_EQ(read_integer_field("-2147483648", BlankMode::null).value, -2147483648.0);
  EXPECT_EQ(read_integer_field("2147483648", BlankMode::null).fault, FieldFault::integer_range);
  EXPECT_EQ(read_integer_field("99999999999999999999", BlankMode::null).fault, FieldFault::integer_range);
}

TEST(IntegerField, SignsAndBlanks) {
  EXPECT_EQ(read_integer_field(" - 5", BlankMode::null).value, -5.0);
  EXPECT_EQ(read_integer_field("   -", BlankMode::null).fault, FieldFault::lone_sign);
  EXPECT_EQ(read_integer_field("1 2 ", BlankMode::zero).value, 1020.0);
  EXPECT_TRUE(read_integer_field("     ", BlankMode::null).blank);
  EXPECT_EQ(read_integer_field("  1.0", BlankMode::null).at, 3);
}

TEST(LogicalField, TakesTheFirstLetter) {
  EXPECT_EQ(read_logical_field(" .TRUE.").value, 1.0);
  EXPECT_EQ(read_logical_field("  f").value, 0.0);
  EXPECT_EQ(read_logical_field("  1").fault, FieldFault::bad_character);
}

TEST(FreeNumber, HasNoBlanksAndNoImpliedPoint) {
  EXPECT_EQ(read_free_number("12", false).value, 12.0);
  EXPECT_EQ(read_free_number("1.5d2", false).value, 150.0);
  EXPECT_EQ(read_free_number("1.0", true).fault, FieldFault::bad_character);
  EXPECT_EQ(read_free_number("abc", false).fault, FieldFault::bad_character);
  EXPECT_EQ(read_free_number(".", false).fault, FieldFault::bad_character);
}

}  // namespace
}  // namespace sage
