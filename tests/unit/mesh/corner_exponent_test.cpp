// Exponents at corners of one material against Williams (1952), values that are known, and roots by bisection.
#include "sage/mesh/corner_exponent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sage::mesh {
namespace {

double exponent(Side a, Side b, double degrees, double nu = 0.3) {
  const double found = corner_exponent(a, b, degrees * std::numbers::pi / 180.0, nu);
  EXPECT_EQ(found, corner_exponent(b, a, degrees * std::numbers::pi / 180.0, nu)) << "sides change places";
  return found;
}

// Where f changes its sign between two places.
template <class Function>
double root(const Function& f, double low, double high) {
  EXPECT_LT(f(low) * f(high), 0.0);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) <= 0.0 ? high : low) = middle;
  }
  return low;
}

TEST(CornerExponent, KnownValues) {
  EXPECT_NEAR(exponent(Side::free, Side::free, 360.0), 0.5, 1e-9) << "crack";
  EXPECT_NEAR(exponent(Side::free, Side::free, 270.0), 0.5444837, 1e-7) << "L-shape";
  EXPECT_NEAR(exponent(Side::across, Side::free, 135.0), 0.5444837, 1e-7) << "half of it";
  EXPECT_NEAR(exponent(Side::across, Side::free, 180.0), 0.5, 1e-9) << "smooth punch";
  EXPECT_NEAR(exponent(Side::held, Side::free, 180.0), 0.5, 1e-9) << "rough punch: 1/2 + i log(kappa) / 2 pi";
  EXPECT_NEAR(exponent(Side::held, Side::free, 90.0, 0.25), 0.745, 5e-4) << "pinned specimen";
  EXPECT_NEAR(exponent(Side::held, Side::free, 90.0, 0.495), 0.597, 5e-4);
  EXPECT_NEAR(exponent(Side::across, Side::across, 270.0), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(exponent(Side::across, Side::along, 180.0), 0.5, 1e-12);
}

// Bounded stresses whose slopes are not: roots of the real equations.
TEST(CornerExponent, AboveOne) {
  const double pi = std::numbers::pi;
  for (const double degrees : {35.0, 47.0}) {
    const double a = degrees * pi / 180.0, nu = 0.33;
    const auto held_free = [&](double l) {
      return std::pow(std::sin(l * a), 2) -
             (4 * (1 - nu) * (1 - nu) - std::pow(l * std::sin(a), 2)) / (3 - 4 * nu);
    };
    EXPECT_NEAR(exponent(Side::held, Side::free, degrees, nu), root(held_free, 0.5, 1.9), 1e-9) << degrees;
  }
  const double blunt = 150.0 * pi / 180.0;
  EXPECT_NEAR(exponent(Side::free, Side::free, 150.0),
              root([&](double l) { return std::sin(l * blunt) + l * std::sin(blunt); }, 1.2, 1.7), 1e-9);
  EXPECT_NEAR(exponent(Side::held, Side::held, 90.0),
              root([&](double l) { return 1.8 * std::sin(l * pi / 2) - l; }, 1.0, 1.9), 1e-9);
}

TEST(CornerExponent, SmoothCorners) {
  for (const Side side : {Side::free, Side::held, Side::across, Side::along}) {
    EXPECT_EQ(exponent(side, side, 180.0), kSmoothExponent);
    if (side == Side::held) continue;
    EXPECT_EQ(exponent(side, side, 90.0), kSmoothExponent);
    EXPECT_EQ(exponent(side, Side::across, 90.0), kSmoothExponent);
  }
  EXPECT_EQ(exponent(Side::held, Side::across, 90.0), kSmoothExponent);
  EXPECT_EQ(exponent(Side::held, Side::free, 20.0), kSmoothExponent);
  EXPECT_EQ(exponent(Side::free, Side::free, 120.0), kSmoothExponent) << "2.09 + .60 i";
  EXPECT_LT(exponent(Side::free, Side::free, 135.0), kSmoothExponent) << "1.89 + .36 i";
}

}  // namespace
}  // namespace sage::mesh
