// Where strength ends: the apex, tension limits, no strength at all, parameters that contradict one another,
// and increments that no law can follow.  Expected values: the laws' equations at those places.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "materials/drucker_prager.hpp"
#include "materials/hyperbolic.hpp"
#include "materials/stress_measures.hpp"
#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
const double kCot30 = std::sqrt(3.0);

double level(int code, const std::vector<double>& values, const Vector4& sigma) {
  const auto law = test::solid(code, values);
  return law->stress_level(sigma, test::initial_history<4>(*law, Vector4::Zero()));
}

// Index of the parameter that is refused, and the message.
std::pair<int, std::string> refusal(int code, const std::vector<double>& values) {
  try {
    test::make_law(code, values, test::kpa_units());
  } catch (const ParameterError& error) {
    return {error.parameter(), error.what()};
  }
  return {-99, "accepted"};
}
void expect_refusal(int code, const std::vector<double>& values, int parameter, const std::string& part) {
  const auto [index, message] = refusal(code, values);
  EXPECT_EQ(index, parameter) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(Parameters, ThatContradictOneAnotherAreRefused) {
  const double none = -1.0;
  expect_refusal(3, {1, 0.3, 0, 30, 5, 1, 0, none, 1}, 8, "only for flow without volume change");
  expect_refusal(3, {1, 0.3, 0, 30, 0, 1, 1, 5, 1}, 8, "without a tension limit");
  expect_refusal(3, {1, 0.3, 0, 30, 5, 1, 0, none, 0, 1}, 9, "only for flow without volume change");
  expect_refusal(4, {1, 0.3, 0, 30, 31}, 4, "must not exceed the friction angle");
  expect_refusal(7, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33, 0, 34}, 9, "must not exceed the friction angle");
}

// phi = 50 + 2 x 20 degrees at the floor of p_a / 100; and 38 - 3 x 12 = 2 degrees at 1000 p_a, where sigma_3
// sin phi falls as sigma_3 grows.  Half of that loss is possible.
TEST(Parameters, AFrictionAngleMustStayOneAtEveryStress) {
  expect_refusal(6, {400, 0.5, 0.8, 600, 250, 0.3, 0, 50, 20}, 8, "below 89.5 degrees at the stress floor");
  expect_refusal(6, {400, 0.5, 0.8, 600, 250, 0.3, 0, 38, 12}, 8, "a strength that grows with sigma_3");
  EXPECT_EQ(refusal(6, {400, 0.5, 0.8, 600, 250, 0.3, 0, 38, 6}).second, "accepted");
}

TEST(Parameters, BothEndsOfARangeAreKept) {
  expect_refusal(6, {400, 0.5, -0.1, 600, 250, 0.3, 5, 33}, 2, "must lie between 0 and 1");
  expect_refusal(6, {400, 0.5, 1.1, 600, 250, 0.3, 5, 33}, 2, "must lie between 0 and 1");
  expect_refusal(3, {1, 0.3, 0, -1}, 3, "at least 0 and below 90 degrees");
}

TEST(Cautions, NameMaterialsWithoutShearStrength) {
  EXPECT_NE(test::solid(4, {1e4, 0.3, 0, 0})->caution().find("no shear strength"), std::string::npos);
  EXPECT_EQ(test::solid(4, {1e4, 0.3, 0.1, 0})->caution(), "");
  EXPECT_EQ(test::solid(4, {1e4, 0.3, 0, 1})->caution(), "");
  EXPECT_NE(test::interface(21, {0.0, 1e6})->caution().find("no shear resistance"), std::string::npos);
  EXPECT_EQ(test::interface(21, {1.0, 1e6})->caution(), "");
}

// No cohesion: the tip is at zero stress.  1 there, infinite beyond it and beside it.
TEST(StressLevel, OfDruckerPragerAtItsTip) {
  const std::vector<double> sand{1e4, 0.3, 0.0, 30.0, 0.0};
  EXPECT_EQ(level(3, sand, Vector4::Zero()), 1.0);
  EXPECT_EQ(level(3, sand, unit_tensor()), kInfinite);
  EXPECT_EQ(level(3, sand, {1.0, -1.0, 0.0, 0.0}), kInfinite);
  // Where the mean stress stays elastic, tension in all directions is no failure; shear on top of it is.
  const std::vector<double> free{1e4, 0.3, 0.0, 30.0, 0.0, 1.0, 1.0, -1.0, 1.0};
  EXPECT_EQ(level(3, free, unit_tensor()), 1.0);
  EXPECT_EQ(level(3, free, {1.0, 1.0, 1.0, 0.5}), kInfinite);
}

// c = 10, phi = 30: the tip is at c cot phi.
TEST(StressLevel, OfMohrCoulombAtItsTip) {
  const std::vector<double> soil{1e4, 0.3, 10.0, 30.0, 0.0};
  const double tip = 10.0 * kCot30;
  EXPECT_EQ(level(4, soil, tip * unit_tensor()), 1.0);
  EXPECT_EQ(level(4, soil, (tip + 1.0) * unit_tensor()), kInfinite);
  EXPECT_EQ(level(4, soil, {tip + 1.0, tip - 1.0, tip, 0.0}), kInfinite);
  EXPECT_EQ(level(4, soil, Vector4::Zero()), 0.0);
}

// The cut-off counts where it is nearer than the cone: s1 / T, and for T = 0 whether there is any tension.
TEST(StressLevel, OfMohrCoulombWithACutOff) {
  const std::vector<double> soil{1e4, 0.3, 20.0, 30.0, 0.0, 4.0}, none{1e4, 0.3, 20.0, 30.0, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(level(4, soil, {3.0, 3.0, 3.0, 0.0}), 0.75);
  EXPECT_EQ(level(4, none, Vector4::Zero()), 1.0);
  EXPECT_EQ(level(4, none, {-1.0, -1.0, -1.0, 0.0}), 0.0);
  // (s1 - s3) / (2 c cos phi - (s1 + s3) sin phi)
  EXPECT_NEAR(level(4, none, {-1.0, -11.0, -1.0, 0.0}), 10.0 / (20.0 * kCot30 + 6.0), 1e-12);
}

TEST(StressLevel, OfTheHyperbolicLawAtItsTip) {
  const std::vector<double> soil{400, 0.5, 0.8, 600, 250, 0.3, 10, 30};
  const double tip = 10.0 * kCot30;
  EXPECT_EQ(level(7, soil, tip * unit_tensor()), 1.0);
  EXPECT_EQ(level(7, soil, (tip + 1.0) * unit_tensor()), kInfinite);
  EXPECT_EQ(level(7, soil, {tip + 1.0, tip - 1.0, tip, 0.0}), kInfinite);
  EXPECT_EQ(level(7, soil, {tip, tip - 2.0, tip, 0.0}), level(7, soil, {tip, tip, tip - 2.0, 0.0}));
}

TEST(InitialStress, BeyondATensionLimitIsRefused) {
  std::array<double, 2> h{};
  const auto von_mises = test::solid(3, {3000.0, 0.25, 10.0, 0.0, 0.0, 1.0, 0.0, 2.0});
  EXPECT_TRUE(von_mises->initialise(1.9 * unit_tensor(), h));
  EXPECT_FALSE(von_mises->initialise(2.1 * unit_tensor(), h));
  const auto hyperbolic = test::solid(7, {400, 0.5, 0.7, 600, 250, 0.3, 20, 33, 0, 0, 2});
  EXPECT_TRUE(hyperbolic->initialise(1.9 * unit_tensor(), h));
  EXPECT_FALSE(hyperbolic->initialise(2.1 * unit_tensor(), h));
}

// R_f = 1 at failure: no stiffness is left for the 1970 formula of Poisson's ratio to divide by.
TEST(Hyperbolic, Poisson1970AtFailureIsItsUpperBound) {
  HyperbolicParameters p{};
  p.K = 400;
  p.n = 0.5;
  p.R_f = 1.0;
  p.K_ur = 600;
  p.volume = VolumeRule::poisson_1970;
  p.G = 0.3;
  p.F = 0.1;
  p.d = 3.0;
  p.phi0 = 30.0 * kRadiansPerDegree;
  p.p_a = 101.325;
  p.nu_max = 0.45;
  p.floor = 0.01;
  const HyperbolicModuli m = hyperbolic_moduli(p, 300.0, 100.0, 0.0);  // sigma_1 = K_p sigma_3
  EXPECT_NEAR((3.0 * m.K.v - 2.0 * m.G.v) / (6.0 * m.K.v + 2.0 * m.G.v), 0.45, 1e-12);
}

TEST(HyperbolicLaws, RefuseWhatTheyCanNotFollow) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const Vector4 start{-100, -100, -100, 0};
  for (const int code : {6, 7})
    for (const double bad : {not_a_number, 1e300}) {
      const auto law = test::solid(code, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33});
      const auto a = test::update<4>(*law, start, {0.0, bad, 0.0, 0.0}, test::initial_history<4>(*law, start));
      EXPECT_EQ(a.outcome, Outcome::cut_step) << code << " " << bad;
    }
}

// The exact integration divides by the change of the deviator and by the radius of the cone, and looks for the
// place where the stress meets the cone.  Where there is none it leaves the increment to the radial return,
// which has a closed form: p elastic, the deviator along its trial value at the strength there.
void expect_radial(const Vector4& start, const Vector4& deps, double c) {
  const auto law = test::solid(3, {3000.0, 0.3, c, 30.0, 0.0, 1.0, 1.0, -1.0, 0.0, 1.0});
  const Cone cone = match_cone(ConeMatch::triaxial_compression, 30.0 * kRadiansPerDegree, c);
  const auto a = test::update<4>(*law, start, deps, {0.0, 0.0});
  const Vector4 trial = start + elastic_matrix(moduli_from_young(3000.0, 0.3)) * deps;
  const double p = mean_stress(trial);
  const Vector4 s = std::max(cone.k - 3.0 * cone.alpha * p, 0.0) / sqrt_j2(trial) * deviator(trial);
  EXPECT_EQ(a.status, PointStatus::yielded);
  EXPECT_LT((a.sigma - s - p * unit_tensor()).norm(), 1e-12 * start.norm());
}
TEST(DruckerPrager, ExactIntegrationOfAChangeInVolumeOnly) {
  expect_radial({-100.0, -120.0, -100.0, 30.0}, 0.01 * unit_tensor(), 5.0);
}
TEST(DruckerPrager, ExactIntegrationThatEndsOnTheTip) {  // K = 2500: p = -10 + 10
  expect_radial({-10.0, -10.0, -10.0, 1.0}, {0.004 / 3.0, 0.004 / 3.0, 0.004 / 3.0, 0.01}, 0.0);
}
// Starts at twice the strength (an initial stress outside was reported), and stays outside: moving in, moving
// in while the cone widens faster, and moving past it.
TEST(DruckerPrager, ExactIntegrationFromOutside) {
  const double alpha = match_cone(ConeMatch::triaxial_compression, 30.0 * kRadiansPerDegree, 0.0).alpha;
  const double tau = 300.0 * alpha, G = 3000.0 / 2.6;
  const Vector4 start{-100.0, -100.0, -100.0, 2.0 * tau};
  expect_radial(start, {0.0, 0.0, 0.0, -0.5 * tau / G}, 0.0);
  const double volume = -30.0 / 2500.0;
  expect_radial(start, {volume / 3.0, volume / 3.0, volume / 3.0, -0.1 * tau / G}, 0.0);
  const double side = 3.0 * tau / (2.0 * G);  // deviator 3 tau, at right angles to the start
  expect_radial(start, {side, -side, 0.0, -0.1 * tau / G}, 0.0);
}

// Its step may be symmetric only where the tangent is: phi = 0, radial return.
TEST(DruckerPrager, ExactIntegrationIsNotSymmetric) {
  const auto law = [](double exact) {
    return test::solid(3, {3000.0, 0.3, 10.0, 0.0, 0.0, 1.0, 1.0, -1.0, 0.0, exact});
  };
  EXPECT_TRUE(law(0.0)->traits().symmetric);
  EXPECT_FALSE(law(1.0)->traits().symmetric);
  const Vector4 start{-20.0, -22.0, -20.0, 1.0}, deps{0.01, -0.012, 0.0, 0.03};
  const Matrix4 D = test::update<4>(*law(1.0), start, deps, {0.0, 0.0}).D;
  EXPECT_GT((D - D.transpose()).norm(), 1e-4 * D.norm());
}

// c = 10, phi = 45, limit 10 = c cot phi: the limit is the apex, and nothing of the deviator is left.
TEST(DruckerPrager, TensionLimitAtTheApex) {
  const auto law = test::solid(3, {3000.0, 0.3, 10.0, 45.0, 0.0, 1.0, 0.0, 10.0});
  const auto a = test::update<4>(*law, Vector4::Zero(), {0.1, 0.1, 0.09, 0.001}, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::apex);
  EXPECT_LT((a.sigma - 10.0 * unit_tensor()).norm(), 1e-11);
}

// Strength 5 broken, closed again, pulled a second time by what it held at first: nothing, at once.
TEST(CloughDuncan, AClosedCrackHoldsNoTension) {
  constexpr std::array<Control, 2> kStrain{Control::strain, Control::strain};
  const auto law = test::interface(22, {2.0, 30.0, 5.0, 0.0, 5000.0, 0.9, 1000.0, 500.0, 0.0});
  PointDriver<2> point(*law);
  point.advance(kStrain, {0.0, 0.02});
  point.advance(kStrain, {0.0, -0.03});
  EXPECT_NEAR(point.sigma()[1], -10.0, 1e-12);
  EXPECT_EQ(point.history()[0], 0.0);
  point.advance(kStrain, {0.0, 0.018});  // 0.008 of opening: 4 at first
  EXPECT_EQ(point.status(), PointStatus::open);
  EXPECT_EQ(point.sigma()[1], 0.0);
}

// The tangent rule takes the stiffness of the increment's start: reloading from below the largest stress so far
// it is that of unloading, to the increment's end beyond it.
TEST(CloughDuncan, TangentRuleReloadsStraightBeyondItsMemory) {
  constexpr std::array<Control, 2> kSheared{Control::strain, Control::stress};
  const auto law = test::interface(22, {2.0, 30.0, 0.0, 0.85, 5000.0, 0.9, 1e9, 1e9, 0.0, 0.0});
  const double k = 5000.0 * 0.036111 * std::pow(50.0 / 14.696, 0.9);
  PointDriver<2> point(*law, {0.0, -50.0});
  point.advance(kSheared, {0.01, -50.0});
  const double largest = point.sigma()[0];
  point.advance(kSheared, {-0.005, -50.0});
  const double low = point.sigma()[0];
  EXPECT_NEAR(low, largest - k * 0.005, 1e-10);
  point.advance(kSheared, {0.008, -50.0});
  EXPECT_NEAR(point.sigma()[0], low + k * 0.008, 1e-10);
  EXPECT_GT(point.sigma()[0], largest);
}

}  // namespace
}  // namespace sage
