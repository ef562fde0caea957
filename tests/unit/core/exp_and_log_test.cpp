#include "sage/math/exp_and_log.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace sage {
namespace {

// Beside the C library, whose functions are right to the last digit or two.
TEST(ExpAndLog, AreThoseOfTheLibraryToRounding) {
  constexpr double kDigits = 4.0 * std::numeric_limits<double>::epsilon();
  for (double size = 1e-300; size < 1.0; size *= 1.07)
    for (const double x : {size, -size}) {
      EXPECT_NEAR(exp_less_1(x), std::expm1(x), kDigits * std::abs(std::expm1(x))) << x;
      EXPECT_NEAR(log_1_plus(x), std::log1p(x), kDigits * std::abs(std::log1p(x))) << x;
    }
  EXPECT_EQ(exp_less_1(0.0), 0.0);
  EXPECT_EQ(log_1_plus(0.0), 0.0);
  EXPECT_EQ(exp_less_1(3.0), std::expm1(3.0));
  EXPECT_EQ(log_1_plus(3.0), std::log1p(3.0));
  EXPECT_TRUE(std::isnan(log_1_plus(-2.0)));
  EXPECT_TRUE(std::isnan(exp_less_1(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace sage
