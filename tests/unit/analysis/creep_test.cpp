// What the last corrections of a damped step come to.
#include "sage/analysis/creep.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sage {
namespace {

constexpr double kSize = 10.0;

// Two dofs of a solid, then two of a wall.
const std::vector<char> kSolids{1, 1, 0, 0};

TEST(Creep, GroundThatGoesOnMovingFlows) {
  Creep creep(kSolids, kSize);
  Eigen::VectorXd du = Eigen::VectorXd::Zero(4);
  creep.take(du, 1.0);
  double correction = 1e-6;
  int corrections = 0;
  for (; !creep.flows() && corrections < 100; ++corrections) {
    du[0] += correction;
    correction /= 0.7;
    creep.take(du, 1.0);
    EXPECT_FALSE(creep.is_shaken());
  }
  // 1e-6 / .7^n grows to about the size in 40 to 45 corrections: what counts of their sum is 2.7 times the last one.
  EXPECT_GE(corrections, 40);
  EXPECT_LE(corrections, 45);
  EXPECT_FALSE(creep.spares_ground());
}

TEST(Creep, AWallAloneIsNoCollapse) {
  Creep creep(kSolids, kSize);
  Eigen::VectorXd du = Eigen::VectorXd::Zero(4);
  for (int i = 0; i < 50; ++i) {
    du[2] += 1e3;
    creep.take(du, 1.0);
  }
  EXPECT_FALSE(creep.flows());
  EXPECT_TRUE(creep.spares_ground());
}

TEST(Creep, MotionToAndFroIsShaken) {
  for (const int period : {2, 3}) {
    Creep creep(kSolids, kSize);
    Eigen::VectorXd du = Eigen::VectorXd::Zero(4);
    for (int i = 0; i < 60; ++i) {
      du[0] = std::cos(2.0 * 3.14159265358979 * i / period);
      creep.take(du, 1.0 + 0.1 * (i % period));
    }
    EXPECT_TRUE(creep.is_shaken()) << period;
    EXPECT_FALSE(creep.flows()) << period;
  }
}

// Corrections that cancel each other are of use as long as they take the residual down.
TEST(Creep, AFallingResidualIsNoShaking) {
  Creep creep(kSolids, kSize);
  Eigen::VectorXd du = Eigen::VectorXd::Zero(4);
  for (int i = 0; i < 60; ++i) {
    du[0] = std::pow(-0.97, i);
    creep.take(du, std::pow(0.97, i));
  }
  EXPECT_FALSE(creep.is_shaken());
}

}  // namespace
}  // namespace sage
