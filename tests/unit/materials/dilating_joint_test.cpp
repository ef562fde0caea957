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

// Apart by g the strength is c - k_n g, with or without dilation: tau = that, k_s w = tau + k_s lambda, and the gap is
// what lambda tan(psi) leaves of the opening.
TEST(DilatingJoint, CohesionFadesOverAGap) {
  const Vector2 start{4.0, -10.0};
  const double slide = 1e-3;
  for (const double psi : {0.0, 10.0}) {
    const auto law = test::interface(23, {kS, kN, kC, 30, psi}, test::kpa_units());
    const double slope = std::tan(psi * kRadiansPerDegree);
    const double w = psi == 0.0 ? 1.2e-5 : 2.07e-4;  // opening: the gap is below c/k_n = 5e-6
    const double slip = (start[0] + kS * slide + start[1] + kN * w - kC) / (kS + kN * slope);
    const double gap = w + start[1] / kN - slope * slip;
    ASSERT_TRUE(gap > 0.0 && gap < kC / kN) << psi << " " << gap;
    const auto a = test::update<2>(*law, start, {slide, w}, {0.0, 0.0, 0.0});
    EXPECT_NEAR(a.sigma[0], kC - kN * gap, 1e-9);
    EXPECT_EQ(a.sigma[1], 0.0);
    EXPECT_EQ(a.status, PointStatus::slipping);
    EXPECT_NEAR(a.h[0], gap, 1e-15);
    EXPECT_NEAR(a.h[1], slip, 1e-12);
    EXPECT_NEAR(law->stress_level(a.sigma, a.h), 1.0, 1e-9);
    EXPECT_TRUE(law->accepts_history(a.sigma, a.h));
    EXPECT_FALSE(law->accepts_history({1.01 * a.sigma[0], 0.0}, a.h));
    const auto same = test::update<2>(*law, a.sigma, Vector2::Zero(), a.h);
    EXPECT_EQ(same.sigma, a.sigma);
    EXPECT_EQ(same.h, a.h);
  }
}

// No jump on the way from contact to open and back: the stress moves by no more than k_n of the step.
TEST(DilatingJoint, OpensAndClosesWithoutAJump) {
  const auto law = joint();
  const double step = 1e-7;
  for (const bool closes : {false, true}) {
    const Vector2 start = closes ? Vector2(0.0, 0.0) : Vector2(9.0, -8.0);
    const std::vector<double> h{closes ? 2e-5 : 0.0, 0.0, 0.0};
    Vector2 last = test::update<2>(*law, start, {8e-4, closes ? -3e-5 : 0.0}, h).sigma;
    for (double w = step; w < 3e-5; w += step) {
      const Vector2 sigma = test::update<2>(*law, start, {8e-4, closes ? w - 3e-5 : w}, h).sigma;
      EXPECT_LT((sigma - last).norm(), 3.0 * kN * step) << closes << " " << w;
      last = sigma;
    }
  }
}

// It opens without stress, remembers the gap, and slides only once cohesion reaches over it again, from c/k_n = 5e-6 on:
// five eighths of the closing increment.
TEST(DilatingJoint, OpensAndCloses) {
  const auto law = joint();
  const auto open = test::update<2>(*law, {0.0, -10.0}, {0.0, 3e-5}, {0.0, 0.0, 0.0});
  EXPECT_EQ(open.status, PointStatus::open);
  EXPECT_EQ(open.sigma.norm(), 0.0);
  EXPECT_NEAR(open.h[0], 2e-5, 1e-18);
  const auto closed = test::update<2>(*law, open.sigma, {4e-4, -4e-5}, open.h);
  EXPECT_NEAR(closed.sigma[1], -20.0, 1e-10);
  EXPECT_NEAR(closed.sigma[0], kS * 2.5e-4, 1e-12);
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
