// The driver itself, with laws made for the test: linear elasticity written down here, and a law that refuses.
#include "sage/core/point_driver.hpp"

#include <gtest/gtest.h>

#include "sage/messages/error.hpp"

namespace sage {
namespace {

constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress, Control::strain};

// K = 2000, G = 1200 (E = 3000, nu = .25); refuses increments above `largest`.
class Elastic final : public SolidLaw {
 public:
  explicit Elastic(double largest) : largest_(largest) {}
  bool initialise(const Vector4& sigma, std::span<double>) const override { return sigma[0] <= 0.0; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    out.D << 3600, 1200, 1200, 0, 1200, 3600, 1200, 0, 1200, 1200, 3600, 0, 0, 0, 0, 1200;
    out.sigma = in.sigma0 + out.D * in.deps;
    out.status = PointStatus::elastic;
    return in.deps.cwiseAbs().maxCoeff() > largest_ ? Outcome::cut_step : Outcome::ok;
  }

 private:
  double largest_;
};

TEST(PointDriver, MixesStressAndStrain) {
  const Elastic law(1e9);
  PointDriver<4> point(law, {-50, -50, -50, 0});
  point.advance(kTriaxial, {-50, -0.01, -50, 0.02});
  EXPECT_NEAR(point.sigma()[1], -80.0, 1e-11);
  EXPECT_NEAR(point.sigma()[3], 24.0, 1e-11);
  EXPECT_NEAR(point.eps()[0], 0.0025, 1e-14);
  EXPECT_EQ(point.iterations(), 2);  // one to see the residual, one after the exact correction
}

TEST(PointDriver, HalvesWhatTheLawRefuses) {
  const Elastic law(0.003);
  PointDriver<4> point(law, {-50, -50, -50, 0});
  point.advance(kTriaxial, {-50, -0.01, -50, 0});
  EXPECT_EQ(point.steps(), 4);
  EXPECT_NEAR(point.sigma()[1], -80.0, 1e-11);
}

TEST(PointDriver, StressTargetsAreReachedLinearly) {
  const Elastic law(0.003);
  constexpr std::array<Control, 4> kStress{Control::stress, Control::stress, Control::stress, Control::stress};
  PointDriver<4> point(law);
  point.advance(kStress, {0, -30, 0, 12});
  EXPECT_NEAR(point.eps()[1], -0.01, 1e-14);
  EXPECT_NEAR(point.eps()[3], 0.01, 1e-14);
}

// Lateral springs k on an elastic point: s_x = -k e_x, so e_x = -nu e_y/(1 + k (1 + nu)(1 - 2 nu)/E).
// In one step, and where the law refuses and the step is divided.
TEST(PointDriver, SpringsPushBack) {
  const double E = 3000, nu = 0.25, k = 500, e_y = -0.01;
  const double e_x = -nu * e_y / (1 + k * (1 + nu) * (1 - 2 * nu) / E);
  for (const double largest : {1e9, 0.003}) {
    const Elastic law(largest);
    PointDriver<4> point(law, {-50, -50, -50, 0});
    point.advance(kTriaxial, {-50, e_y, -50, 0}, 1.0, {k, 0, k, 0});
    EXPECT_NEAR(point.eps()[0], e_x, 1e-14);
    EXPECT_NEAR(point.sigma()[0], -50 - k * e_x, 1e-11);
  }
}

TEST(PointDriver, SaysWhenItCannot) {
  const Elastic law(1e-9);
  PointDriver<4> point(law, {-50, -50, -50, 0});
  EXPECT_THROW(point.advance(kTriaxial, {-50, -0.01, -50, 0}), AnalysisError);
  EXPECT_EQ(point.eps().norm(), 0.0);
  EXPECT_THROW((PointDriver<4>(law, {50, 0, 0, 0})), AnalysisError);
}

TEST(TriaxialTest, CompressionPositive) {
  const Elastic law(1e9);
  const auto path = triaxial_test(law, 50.0, 0.02, 4);
  ASSERT_EQ(path.size(), 5u);
  EXPECT_EQ(path[0].deviator, 0.0);
  EXPECT_NEAR(path[2].axial_strain, 0.01, 1e-15);
  EXPECT_NEAR(path[4].deviator, 60.0, 1e-10);
  EXPECT_NEAR(path[4].volume_strain, 0.02 * 0.5, 1e-13);
}

}  // namespace
}  // namespace sage
