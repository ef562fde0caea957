#include "materials/goodman.hpp"

#include <gtest/gtest.h>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr std::array<Control, 2> kStrain{Control::strain, Control::strain};

TEST(Goodman, Equation714) {
  const auto law = test::interface(21, {200.0, 1000.0});
  PointDriver<2> point(*law);
  point.advance(kStrain, {0.02, -0.01});
  EXPECT_DOUBLE_EQ(point.sigma()[0], 4.0);
  EXPECT_DOUBLE_EQ(point.sigma()[1], -10.0);
}

// Closed at -10, opened by 0.03 (gap 0.02), closed by 0.025: 0.005 of contact again, sigma_n = -5.
// Sliding while open leaves no stress; the shear of later contact starts from zero.
TEST(Goodman, OpensAndClosesByTotalDisplacement) {
  const auto law = test::interface(21, {200.0, 1000.0});
  PointDriver<2> point(*law, {1.0, -10.0});
  point.advance(kStrain, {0.0, 0.03});
  EXPECT_EQ(point.status(), PointStatus::open);
  EXPECT_EQ(point.sigma().norm(), 0.0);
  EXPECT_NEAR(point.history()[0], 0.02, 1e-15);
  point.advance(kStrain, {5.0, -0.01});
  EXPECT_EQ(point.status(), PointStatus::open);
  EXPECT_EQ(point.sigma().norm(), 0.0);
  point.advance(kStrain, {0.0, -0.015});
  EXPECT_EQ(point.status(), PointStatus::elastic);
  EXPECT_NEAR(point.sigma()[1], -5.0, 1e-12);
  EXPECT_EQ(point.sigma()[0], 0.0);
}

TEST(Goodman, BondedIsLinear) {
  const auto law = test::interface(21, {200.0, 1000.0, 1.0});
  EXPECT_TRUE(law->traits().linear);
  PointDriver<2> point(*law);
  point.advance(kStrain, {0.0, 0.03});
  EXPECT_DOUBLE_EQ(point.sigma()[1], 30.0);
  EXPECT_FALSE(test::interface(21, {200.0, 1000.0})->traits().linear);
}

TEST(Goodman, RefusesInitialTension) {
  std::array<double, 1> h{};
  EXPECT_FALSE(test::interface(21, {200.0, 1000.0})->initialise({0.0, 1.0}, h));
  EXPECT_TRUE(test::interface(21, {200.0, 1000.0, 1.0})->initialise({0.0, 1.0}, h));
}

}  // namespace
}  // namespace sage
