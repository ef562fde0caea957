// Expected values: closed forms of a joint sheared at constant normal stress, stiffness and volume.  Pressures s; slip
// lambda = w - tau/k_s opens it by O = lambda tan psi, up to the slip limit.
#include "materials/dilating_joint.hpp"

#include <gtest/gtest.h>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr double kS = 2e4, kN = 1e6, kC = 5.0, kPressure = 60.0;
const double kPhi = std::tan(30 * kRadiansPerDegree), kPsi = std::tan(10 * kRadiansPerDegree);
constexpr std::array<Control, 2> kSheared{Control::strain, Control::stress};

std::unique_ptr<InterfaceLaw> joint(double limit = -1.0) {
  return test::interface(23, {kS, kN, kC, 30, 10, limit}, test::kpa_units());
}

// With a spring K behind the joint its pressure grows by K k_n/(K + k_n) O; K = 0 is constant normal stress.
TEST(DilatingJoint, ConstantNormalStressAndStiffness) {
  const double limit = 2e-3;
  for (const double K : {0.0, 1e4, 1e6, 1e9}) {
    const double together = K * kN / (K + kN);
    for (const int steps : {1, 40}) {
      const auto law = joint(limit);
      PointDriver<2> point(*law, {0.0, -kPressure});
      const double w = 0.02;
      for (int i = 0; i < steps; ++i) {
        // The spring counts from the start: what it has pushed so far stands in the target.
        const double base = -kPressure - K * point.eps()[1];
        point.advance(kSheared, {w / steps, base}, 1.0, {0.0, K});
      }
      const double opening = kPsi * limit, pressure = kPressure + together * opening;
      EXPECT_NEAR(-point.sigma()[1], pressure, 1e-9 * pressure) << K << " " << steps;
      EXPECT_NEAR(point.sigma()[0], kC + pressure * kPhi, 1e-9 * pressure);
      EXPECT_NEAR(point.eps()[1], opening - (pressure - kPressure) / kN, 1e-12);
      EXPECT_NEAR(point.history()[1], w - point.sigma()[0] / kS, 1e-12);
    }
  }
}

// Before the limit, at constant volume: s = s_0 + k_n tan psi lambda, tau = c + s tan phi, w = tau/k_s + lambda.
TEST(DilatingJoint, ConstantVolume) {
  const double w = 4e-3;
  const double slip = (w - (kC + kPressure * kPhi) / kS) / (1 + kN * kPsi * kPhi / kS);
  for (const int steps : {1, 10}) {
    const auto law = joint();
    PointDriver<2> point(*law, {0.0, -kPressure});
    for (int i = 0; i < steps; ++i) point.advance({Control::strain, Control::strain}, {w / steps, 0.0});
    EXPECT_NEAR(-point.sigma()[1], kPressure + kN * kPsi * slip, 1e-9 * kN * slip) << steps;
    EXPECT_NEAR(point.sigma()[0], kC - point.sigma()[1] * kPhi, 1e-9 * kN * slip);
    EXPECT_NEAR(point.history()[2], kPsi * slip, 1e-14);
  }
}

// Slip backwards dilates as well.
TEST(DilatingJoint, BothDirectionsOpenIt) {
  const auto law = joint();
  PointDriver<2> point(*law, {0.0, -kPressure});
  point.advance(kSheared, {0.01, -kPressure});
  const double forwards = point.eps()[1];
  point.advance(kSheared, {-0.02, -kPressure});
  EXPECT_GT(forwards, 0.0);
  EXPECT_GT(point.eps()[1], 2 * forwards);
  EXPECT_NEAR(point.sigma()[0], -(kC + kPressure * kPhi), 1e-9);
}

// It opens without stress, remembers the gap, and slides only after it has closed: of the closing increment the
// second half.
TEST(DilatingJoint, OpensAndCloses) {
  const auto law = joint();
  const auto open = test::update<2>(*law, {0.0, -10.0}, {0.0, 3e-5}, {0.0, 0.0, 0.0});
  EXPECT_EQ(open.status, PointStatus::open);
  EXPECT_EQ(open.sigma.norm(), 0.0);
  EXPECT_NEAR(open.h[0], 2e-5, 1e-18);
  const auto closed = test::update<2>(*law, open.sigma, {4e-4, -4e-5}, open.h);
  EXPECT_NEAR(closed.sigma[1], -20.0, 1e-10);
  EXPECT_NEAR(closed.sigma[0], kS * 2e-4, 1e-12);
  EXPECT_EQ(closed.h[0], 0.0);
  const auto still = test::update<2>(*law, open.sigma, {1e-3, -1e-5}, open.h);
  EXPECT_EQ(still.status, PointStatus::open);
  EXPECT_NEAR(still.h[0], 1e-5, 1e-18);
}

TEST(DilatingJoint, RefusesWhatCantBeMeant) {
  const auto refused = [](std::vector<double> values) {
    EXPECT_THROW(test::interface(23, values), ParameterError);
  };
  refused({0, kN, kC, 30});
  refused({kS, 0, kC, 30});
  refused({kS, kN, -1, 30});
  refused({kS, kN, kC, 30, 31});
  refused({kS, kN, kC, 30, 10, -2});
  EXPECT_NE(test::interface(23, {kS, kN, 0, 0})->caution(), "");
}

}  // namespace
}  // namespace sage
