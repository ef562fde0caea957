// Closed forms: the hyperbola at constant sigma_n, tau = w/(1/k_si + w R_f/tau_f); Coulomb slip.
#include "materials/clough_duncan.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr std::array<Control, 2> kShearAtConstantNormal{Control::strain, Control::stress};
constexpr std::array<Control, 2> kStrain{Control::strain, Control::strain};

// c phi sigma_t R_f k_j n k_nc k_nt k_sf rule floor unloading
std::vector<double> joint(double R_f, double rule) {
  return {2.0, 30.0, 0.0, R_f, 5000.0, 0.9, 1e9, 1e9, 0.0, rule, 1e-6, 0.0};
}
const double kTauF = 2.0 + 50.0 * std::tan(30.0 * kRadiansPerDegree);
const double kInitial = 5000.0 * 0.036111 * std::pow(50.0 / 14.696, 0.9);
double hyperbola(double w, double R_f) {
  return w / (1.0 / kInitial + w * R_f / kTauF);
}

double sheared(const std::vector<double>& values, double w, int steps) {
  const auto law = test::interface(22, values);
  PointDriver<2> point(*law, {0.0, -50.0});
  for (int i = 0; i < steps; ++i) point.advance(kShearAtConstantNormal, {w / steps, -50.0});
  return point.sigma()[0];
}

// Chapter, Table 7.2 (R_f = 0): linear with k_j gamma_w (sigma_n/p_a)^n.
TEST(CloughDuncan, LinearForZeroFailureRatio) {
  EXPECT_NEAR(sheared(joint(0.0, 0), 0.01, 1), kInitial * 0.01, 1e-11);
  EXPECT_NEAR(sheared(joint(0.0, 0), -0.01, 3), -kInitial * 0.01, 1e-11);
}

// A stiffness number below 1 is one like any other.
TEST(CloughDuncan, SmallStiffnessNumber) {
  std::vector<double> soft = joint(0.0, 0);
  soft[4] = 0.5;
  EXPECT_NEAR(sheared(soft, 0.01, 1), kInitial * 1e-4 * 0.01, 1e-14);
}

// The exact rule follows the hyperbola with any number of steps; 1e-11: rounding.
TEST(CloughDuncan, ExactRuleIsTheHyperbola) {
  for (const int steps : {1, 7}) EXPECT_NEAR(sheared(joint(0.8, 2), 0.04, steps), hyperbola(0.04, 0.8), 1e-10);
}

// Error of the tangent rule is O(dw), of the midpoint rule O(dw^2): halving the step divides it by 2 and 4.
TEST(CloughDuncan, OrderOfTheRules) {
  const double exact = hyperbola(0.04, 0.8);
  const auto ratio = [&](double rule) {
    return (sheared(joint(0.8, rule), 0.04, 64) - exact) / (sheared(joint(0.8, rule), 0.04, 128) - exact);
  };
  EXPECT_NEAR(ratio(0), 2.0, 0.1);
  EXPECT_NEAR(ratio(1), 4.0, 0.1);
  EXPECT_GT(sheared(joint(0.8, 0), 0.04, 64), exact);  // a tangent at the start overshoots
}

// The tangent rule takes k_s from the committed stress: a first increment that also loads the joint from
// nothing sees only the floor, the second one sees the 50 of the first.
TEST(CloughDuncan, TangentRuleUsesTheCommittedState) {
  const auto law = test::interface(22, joint(0.0, 0));
  PointDriver<2> point(*law);
  point.advance(kShearAtConstantNormal, {0.01, -50.0});
  const double at_floor = 5000.0 * 0.036111 * std::pow(1e-6, 0.9) * 0.01;
  EXPECT_NEAR(point.sigma()[0], at_floor, 1e-12 * at_floor);
  point.advance(kShearAtConstantNormal, {0.01, -50.0});
  EXPECT_NEAR(point.sigma()[0], at_floor + kInitial * 0.01, 1e-10);
}

// Midpoint rule from nothing: k_s at sigma_n = 25.
TEST(CloughDuncan, MidpointRuleSeesHalfTheNormalStress) {
  const auto law = test::interface(22, joint(0.0, 1));
  PointDriver<2> point(*law);
  point.advance(kShearAtConstantNormal, {0.01, -50.0});
  EXPECT_NEAR(point.sigma()[0], 5000.0 * 0.036111 * std::pow(25.0 / 14.696, 0.9) * 0.01, 1e-10);
}

TEST(CloughDuncan, SlipsAtTheStrength) {
  for (const double rule : {0.0, 1.0, 2.0}) {
    EXPECT_NEAR(sheared(joint(0.0, rule), 1.0, 5), kTauF, 1e-12 * kTauF);
    EXPECT_NEAR(sheared(joint(0.8, rule), -1.0, 5), -kTauF, 1e-12 * kTauF);
  }
}

// Shear column: the elastic part alone comes back.  Linear, slip at w_y = tau_f/k, then back by tau_f/k:
// tau = 0.
TEST(CloughDuncan, SlipIsPermanent) {
  const auto law = test::interface(22, joint(0.0, 0));
  PointDriver<2> point(*law, {0.0, -50.0});
  const double w_y = kTauF / kInitial;
  point.advance(kShearAtConstantNormal, {3.0 * w_y, -50.0});
  EXPECT_EQ(point.status(), PointStatus::slipping);
  EXPECT_NEAR(point.history()[4], 2.0 * w_y, 1e-12);
  EXPECT_NEAR(point.stress_level(), 1.0, 1e-12);
  point.advance(kShearAtConstantNormal, {-w_y, -50.0});
  EXPECT_NEAR(point.sigma()[0], 0.0, 1e-11 * kTauF);
  EXPECT_EQ(point.status(), PointStatus::elastic);
}

// Slip with k_sf: tau = tau_f + k_sf (w - w_y), in one step or in many.
TEST(CloughDuncan, StiffnessAfterSlip) {
  std::vector<double> values = joint(0.0, 0);
  values[8] = 20.0;
  const double w_y = kTauF / kInitial;
  for (const int steps : {1, 10}) EXPECT_NEAR(sheared(values, 1.0, steps), kTauF + 20.0 * (1.0 - w_y), 1e-10);
}

// While slipping: d tau/d w_n = -k_n tan phi sign(tau) (tension positive), d tau/d w_s = 0.
TEST(CloughDuncan, SlipTangentIsUnsymmetric) {
  const auto law = test::interface(22, joint(0.0, 0));
  const Vector2 start{kTauF, -50.0};
  const auto a = test::update<2>(*law, start, {0.1, 0.0}, test::initial_history<2>(*law, start));
  EXPECT_EQ(a.status, PointStatus::slipping);
  EXPECT_NEAR(a.D(0, 1), -1e9 * std::tan(30.0 * kRadiansPerDegree), 1e-3);
  EXPECT_EQ(a.D(0, 0), 0.0);
  EXPECT_EQ(a.D(1, 0), 0.0);
  const auto b = test::update<2>(*law, -start.cwiseProduct(Vector2(1.0, -1.0)), {-0.1, 0.0},
                                 test::initial_history<2>(*law, start));
  EXPECT_NEAR(b.D(0, 1), +1e9 * std::tan(30.0 * kRadiansPerDegree), 1e-3);
}

// slip_tangent is seen by D alone, and only where the joint slips: the stress is Coulomb's to the bit.
TEST(CloughDuncan, SlipTangentIsNotInTheStress) {
  std::vector<double> values = joint(0.0, 0);
  const auto plain = test::interface(22, values);
  values.push_back(1e-3);
  const auto held = test::interface(22, values);
  const Vector2 start{kTauF, -50.0};
  const std::vector<double> history = test::initial_history<2>(*held, start);
  const auto a = test::update<2>(*plain, start, {0.1, 0.0}, history);
  const auto b = test::update<2>(*held, start, {0.1, 0.0}, history);
  EXPECT_EQ(b.sigma, a.sigma);
  EXPECT_EQ(b.h, a.h);
  EXPECT_NEAR(b.D(0, 0), 1e-3 * kInitial, 1e-12 * kInitial);
  EXPECT_EQ(b.D(0, 1), a.D(0, 1));
  EXPECT_EQ(test::update<2>(*held, start, {-0.001, 0.0}, history).D,
            test::update<2>(*plain, start, {-0.001, 0.0}, history).D);
  // Open: a trace in D, nothing in the stress.
  const auto open = test::update<2>(*held, start, {0.0, 0.1}, history);
  EXPECT_TRUE(open.sigma.isZero(0.0));
  EXPECT_EQ(open.h, test::update<2>(*plain, start, {0.0, 0.1}, history).h);
  EXPECT_GT(open.D(0, 0), 0.0);
  EXPECT_NEAR(open.D(1, 1), 1e-11 * 1e9, 1e-13 * 1e9) << "k_nc is 1e9";
}

// Unload and reload with k_si, then on along the same hyperbola.
TEST(CloughDuncan, UnloadsLinearlyAndRemembers) {
  const auto law = test::interface(22, joint(0.8, 2));
  PointDriver<2> point(*law, {0.0, -50.0});
  point.advance(kShearAtConstantNormal, {0.03, -50.0});
  const double top = hyperbola(0.03, 0.8);
  point.advance(kShearAtConstantNormal, {-0.01, -50.0});
  EXPECT_NEAR(point.sigma()[0], top - 0.01 * kInitial, 1e-10);
  EXPECT_EQ(point.status(), PointStatus::unloading);
  point.advance(kShearAtConstantNormal, {0.01 + 0.01, -50.0});  // across the memory in one step
  EXPECT_NEAR(point.sigma()[0], hyperbola(0.04, 0.8), 1e-10);
  EXPECT_EQ(point.status(), PointStatus::elastic);
}

// Without memory the hyperbola takes over as soon as |tau| grows.
TEST(CloughDuncan, UnloadingWithoutMemory) {
  std::vector<double> values = joint(0.8, 2);
  values[11] = 1.0;
  const auto law = test::interface(22, values);
  PointDriver<2> point(*law, {0.0, -50.0});
  point.advance(kShearAtConstantNormal, {0.03, -50.0});
  point.advance(kShearAtConstantNormal, {-0.01, -50.0});
  point.advance(kShearAtConstantNormal, {0.01, -50.0});
  EXPECT_LT(point.sigma()[0], hyperbola(0.03, 0.8) - 1.0);
}

// Opens at sigma_n = 0, closes when the gap is used up; only sliding within the reach of adhesion, c/k_nc = 0.002,
// counts: 22 of 40 parts of 0.02 here.
TEST(CloughDuncan, OpensAndCloses) {
  std::vector<double> values = joint(0.0, 1);
  values[6] = values[7] = 1000.0;
  values[4] = 100.0;
  values[5] = 0.0;
  const auto law = test::interface(22, values);
  PointDriver<2> point(*law, {1.0, -10.0});
  point.advance(kStrain, {0.0, 0.03});
  EXPECT_EQ(point.status(), PointStatus::open);
  EXPECT_EQ(point.sigma().norm(), 0.0);
  EXPECT_NEAR(point.history()[0], 0.02, 1e-15);
  point.advance(kStrain, {0.02, -0.04});
  EXPECT_NEAR(point.sigma()[1], -20.0, 1e-12);
  EXPECT_NEAR(point.sigma()[0], 100.0 * 0.036111 * 0.011, 1e-12);
}

// Unloaded to nothing without adhesion: a gap that 1e-5 of the largest shear stress would close is none; memory
// stays and the tangent is that of contact.  A larger one opens; adhesion fades over c/k_nc.
TEST(CloughDuncan, RoundingDoesNotOpen) {
  const auto unloaded = [](double cohesion, double gap) {
    std::vector<double> values = joint(0.8, 2);
    values[0] = cohesion;
    const auto law = test::interface(22, values);
    const auto loaded = test::update<2>(*law, {0.0, -50.0}, {0.02, 0.0}, std::vector<double>(5, 0.0));
    EXPECT_GT(loaded.sigma[0], 8.0);
    return std::pair{loaded.sigma[0], test::update<2>(*law, loaded.sigma, {0.0, 50.0 / 1e9 + gap}, loaded.h)};
  };
  const auto [tau, rounding] = unloaded(0.0, 1e-15);
  EXPECT_NE(rounding.status, PointStatus::open);
  EXPECT_EQ(rounding.sigma.norm(), 0.0);
  EXPECT_EQ(rounding.D(1, 1), 1e9);
  EXPECT_EQ(rounding.h[2], tau);             // memory
  EXPECT_NEAR(rounding.h[0], 1e-15, 1e-22);  // the gap is kept, so that many small ones add up
  const auto opened = unloaded(0.0, 2e-5 * tau / 1e9).second;
  EXPECT_EQ(opened.status, PointStatus::open);
  EXPECT_EQ(opened.h[2], 0.0);
  const auto adheres = unloaded(2.0, 1e-9).second;
  EXPECT_EQ(adheres.status, PointStatus::slipping);
  EXPECT_NEAR(adheres.sigma[0], 1.0, 1e-6);  // c - k_nc 1e-9
  EXPECT_EQ(adheres.sigma[1], 0.0);
  EXPECT_EQ(unloaded(2.0, 2.1e-9).second.status, PointStatus::open);

  // Gap by gap, each too small alone.
  std::vector<double> values = joint(0.8, 2);
  values[0] = 0.0;
  const auto law = test::interface(22, values);
  test::Answer<2> step = rounding;
  for (int i = 0; i < 3; ++i) step = test::update<2>(*law, step.sigma, {0.0, 0.4e-5 * tau / 1e9}, step.h);
  EXPECT_EQ(step.status, PointStatus::open);
}

// With adhesion and hardening the shear stress has no jump on the way from contact to open and back.
TEST(CloughDuncan, OpensAndClosesWithoutAJump) {
  std::vector<double> values = joint(0.0, 2);
  values[6] = values[7] = 1e6;
  values[8] = 20.0;
  const auto law = test::interface(22, values);
  const double step = 1e-7, reach = 3.0 / 1e6;  // c and the hardening below, 2 + 1
  for (const bool closes : {false, true}) {
    const Vector2 start = closes ? Vector2(0.0, 0.0) : Vector2(6.0, -8.0);
    const std::vector<double> h{closes ? 2e-5 : 0.0, 1.0, closes ? 0.0 : 6.0, closes ? 0.0 : 1.0, 0.0};
    const auto stress = [&](double w) {
      return test::update<2>(*law, start, {0.05, closes ? w - 3e-5 : w}, h).sigma;
    };
    for (double w = step; w < 3e-5; w += step)
      EXPECT_LT((stress(w) - stress(w - step)).norm(), 3.0 * 1e6 * step) << closes << " " << w;
    EXPECT_GT(stress(closes ? 1.1e-5 : 8e-6 + 0.5 * reach)[0], 0.0) << closes;  // across a gap
  }
}

// Never loaded: a gap that 1e-8 p_a would close is none where p_a is known (n > 0).
TEST(CloughDuncan, RoundingDoesNotOpenAnUnstressedJoint) {
  std::vector<double> values = joint(0.8, 2);
  values[0] = 0.0;
  const auto status = [&](double stress) {
    const auto law = test::interface(22, values);
    return test::update<2>(*law, {0.0, 0.0}, {0.0, stress / 1e9}, std::vector<double>(5, 0.0)).status;
  };
  EXPECT_NE(status(0.9e-8 * 14.696), PointStatus::open);
  EXPECT_EQ(status(1.1e-8 * 14.696), PointStatus::open);
  values[5] = 0.0;
  EXPECT_EQ(status(0.9e-8 * 14.696), PointStatus::open);
}

// Such a gap was contact: all sliding of the increment that closes it counts, with the tangent of contact, and
// not the share after closing, the ratio of two roundings.
TEST(CloughDuncan, RoundingWasContact) {
  std::vector<double> values = joint(0.0, 2);
  values[0] = 0.0;
  const auto law = test::interface(22, values);
  for (const double gap : {0.0, 1e-17}) {
    const std::vector<double> h{gap, 0.0, 0.0, 0.0, 0.0};
    const auto pressed = test::update<2>(*law, {0.0, 0.0}, {1e-4, -1.01e-17}, h);
    const auto contact = test::update<2>(*law, {0.0, 0.0}, {1e-4, -1.01e-17}, std::vector<double>(5, 0.0));
    EXPECT_NEAR(pressed.sigma[0], contact.sigma[0], 1e-7) << gap;
    EXPECT_LE((pressed.D - contact.D).norm(), 1e-6 * contact.D.norm()) << gap;
  }
}

// Rule 0 takes one stiffness for an increment: 1e-9 below the memory it is that of the hyperbola, as on it.
TEST(CloughDuncan, TangentRuleOnTheMemory) {
  const auto law = test::interface(22, joint(0.8, 0));
  const auto next = [&](double below) {
    const double memory = 10.0;
    return test::update<2>(*law, {memory * (1.0 - below), -50.0}, {1e-3, 0.0}, {0.0, 0.0, memory, 0.0, 0.0});
  };
  const double y = 1.0 - 0.8 * 10.0 / kTauF;
  EXPECT_NEAR(next(0.0).sigma[0], 10.0 + kInitial * y * y * 1e-3, 1e-9);
  EXPECT_NEAR(next(1e-9).sigma[0], next(0.0).sigma[0], 2e-8);
  EXPECT_NEAR(next(1e-5).sigma[0], 10.0 + kInitial * 1e-3, 2e-4);
}

// Tensile strength and stiffness are separate: k_nt up to sigma_t, then open for good.
TEST(CloughDuncan, TensileStrengthIsLostOnce) {
  std::vector<double> values = joint(0.0, 0);
  values[2] = 5.0;
  values[6] = 1000.0;
  values[7] = 500.0;
  const auto law = test::interface(22, values);
  PointDriver<2> point(*law);
  point.advance(kStrain, {0.0, 0.008});
  EXPECT_NEAR(point.sigma()[1], 4.0, 1e-12);
  point.advance(kStrain, {0.0, 0.004});
  EXPECT_EQ(point.status(), PointStatus::open);
  point.advance(kStrain, {0.0, -0.008});  // still 0.004 open: no tension any more
  EXPECT_EQ(point.sigma()[1], 0.0);
  point.advance(kStrain, {0.0, -0.014});
  EXPECT_NEAR(point.sigma()[1], -10.0, 1e-12);
}

// Free ends of Table 7.2: no stiffness, no strength, no failure of the check at zero stress.
TEST(CloughDuncan, FreeEnds) {
  const auto law = test::interface(22, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e9, 1e9, 0.0});
  EXPECT_TRUE(law->traits().symmetric);
  PointDriver<2> point(*law);
  point.advance(kStrain, {0.1, -1e-8});
  EXPECT_EQ(point.sigma()[0], 0.0);
  EXPECT_NEAR(point.sigma()[1], -10.0, 1e-12);
  EXPECT_EQ(point.status(), PointStatus::elastic);
}

// sigma_n = 0, c = 0: the strength is zero and so is the stress: the joint sticks.
TEST(CloughDuncan, SticksAtZeroStress) {
  const auto law = test::interface(22, {0.0, 28.5, 0.0, 0.5, 5000.0, 0.9, 1e9, 1e9, 0.0});
  const auto a = test::update<2>(*law, Vector2::Zero(), Vector2::Zero(), std::vector<double>(5, 0.0));
  EXPECT_EQ(a.status, PointStatus::elastic);
  EXPECT_TRUE(a.D.allFinite());
  EXPECT_GT(a.D(1, 1), 0.0);
}

TEST(CloughDuncan, InitialStressMustBeAdmissible) {
  const auto law = test::interface(22, joint(0.5, 0));
  std::array<double, 5> h{};
  EXPECT_TRUE(law->initialise({0.99 * kTauF, -50.0}, h));
  EXPECT_DOUBLE_EQ(h[2], 0.99 * kTauF);
  EXPECT_FALSE(law->initialise({1.01 * kTauF, -50.0}, h));
  EXPECT_FALSE(law->initialise({0.0, 0.1}, h));
}

// k_nt = 5e5 from the tension or the compression it starts with; beyond sigma_t it opens and forgets its shear.
TEST(CloughDuncan, TensionUpToItsStrength) {
  const auto law = test::interface(22, {0.0, 30.0, 10.0, 0.0, 5000.0, 0.5, 1e6, 5e5, 0.0});
  const std::vector<double> h{0.0, 0.0, 3.0, 1.0, 0.0};
  EXPECT_NEAR(test::update<2>(*law, {0.0, 2.0}, {0.0, 1e-5}, h).sigma[1], 7.0, 1e-12);
  EXPECT_NEAR(test::update<2>(*law, {0.0, -2.0}, {0.0, 1e-5}, h).sigma[1], 4.0, 1e-12);
  const auto open = test::update<2>(*law, {0.0, 2.0}, {0.0, 1e-4}, h);
  EXPECT_EQ(open.status, PointStatus::open);
  EXPECT_NEAR(open.h[0], 1.04e-4, 1e-16);
  EXPECT_EQ(open.h[1], 1.0);
  EXPECT_EQ(open.h[2], 0.0);
  EXPECT_EQ(open.h[3], 0.0);
}

// k = 5000 x 0.036111, tau_f = 3, k_sf = 50, w = 0.1: beyond the strength k w - 3, of which k_sf/k stays as
// hardening and the rest is slip.
TEST(CloughDuncan, SlipCountsTheDisplacement) {
  const auto law = test::interface(22, {3.0, 0.0, 0.0, 0.0, 5000.0, 0.0, 1e6, 1e6, 50.0});
  const double k = 5000.0 * 0.036111, excess = k * 0.1 - 3.0, hardening = 50.0 / k * excess;
  for (const double side : {1.0, -1.0}) {
    const Vector2 start{0.0, -10.0};
    const auto a = test::update<2>(*law, start, {side * 0.1, 0.0}, test::initial_history<2>(*law, start));
    EXPECT_NEAR(a.sigma[0], side * (3.0 + hardening), 1e-12);
    EXPECT_NEAR(a.h[3], hardening, 1e-12);
    EXPECT_NEAR(a.h[4], (excess - hardening) / k, 1e-15);
  }
}

TEST(CloughDuncan, SymmetricWhereShearNeverMeetsNormal) {
  const auto symmetric = [](double c, double phi, double k_j, double k_sf) {
    return test::interface(22, {c, phi, 0.0, 0.0, k_j, 0.0, 1e6, 1e6, k_sf})->traits().symmetric;
  };
  EXPECT_TRUE(symmetric(3.0, 0.0, 0.0, 0.0));
  EXPECT_TRUE(symmetric(0.0, 0.0, 5000.0, 0.0));
  EXPECT_FALSE(symmetric(3.0, 0.0, 5000.0, 0.0));
  EXPECT_FALSE(symmetric(0.0, 0.0, 5000.0, 5.0));
  EXPECT_FALSE(symmetric(0.0, 30.0, 0.0, 0.0));
}

// k_s,i = k_j gamma_w sigma_n/p_a for n = 1.
TEST(CloughDuncan, ExponentOne) {
  std::vector<double> values = joint(0.0, 0);
  values[5] = 1.0;
  EXPECT_NEAR(sheared(values, 0.01, 1), 5000.0 * 0.036111 * (50.0 / 14.696) * 0.01, 1e-11);
}

// A start in small tension is taken back along k_nt = 5e5: 0.5 - 0.25.
TEST(CloughDuncan, SmallTensionUnloadsWithItsOwnStiffness) {
  const auto law = test::interface(22, {0.0, 30.0, 10.0, 0.0, 5000.0, 0.5, 1e6, 5e5, 0.0});
  const auto a = test::update<2>(*law, {0.0, 0.5}, {0.0, -0.5e-6}, std::vector<double>(5, 0.0));
  EXPECT_NEAR(a.sigma[1], 0.25, 1e-12);
}

// No strength: the hyperbola is out of use, all of w but k_sf w/k_i is slip, whatever the rule.
TEST(CloughDuncan, WithoutStrengthEverythingSlips) {
  const double k_i = 5000.0 * 0.036111;
  for (const double rule : {0.0, 1.0, 2.0}) {
    const auto law = test::interface(22, {0.0, 0.0, 0.0, 0.8, 5000.0, 0.0, 1e6, 1e6, 10.0, rule});
    const auto a = test::update<2>(*law, {0.0, -50.0}, {0.1, 0.0}, std::vector<double>(5, 0.0));
    EXPECT_NEAR(a.sigma[0], 1.0, 1e-12);
    EXPECT_NEAR(a.h[4], 0.1 * (1.0 - 10.0 / k_i), 1e-14);
  }
}

// Without memory, against a stress of the other sign: k_i back to zero, then the hyperbola from there.
TEST(CloughDuncan, ReversalWithoutMemory) {
  std::vector<double> values = joint(0.8, 2);
  values[11] = 1.0;
  const auto law = test::interface(22, values);
  for (const double side : {1.0, -1.0}) {
    const Vector2 start{-side * 10.0, -50.0};
    const auto h = test::initial_history<2>(*law, start);
    const double w_zero = 10.0 / kInitial;
    const auto back = test::update<2>(*law, start, {side * 0.5 * w_zero, 0.0}, h);
    EXPECT_EQ(back.status, PointStatus::unloading);
    EXPECT_NEAR(back.sigma[0], -side * 5.0, 1e-12);
    const auto beyond = test::update<2>(*law, start, {side * (w_zero + 0.01), 0.0}, h);
    EXPECT_EQ(beyond.status, PointStatus::elastic);
    EXPECT_NEAR(beyond.sigma[0], side * hyperbola(0.01, 0.8), 1e-11);
  }
}

// Without shear stiffness a shear stress stays, and nothing is unloaded; falling sigma_n takes what the
// strength can't hold, and then all of the displacement is slip.
TEST(CloughDuncan, ShearStressWithoutShearStiffness) {
  const auto law = test::interface(22, {0.0, 30.0, 0.0, 0.8, 0.0, 0.0, 1e6, 1e6, 0.0});
  const std::vector<double> h{0.0, 0.0, 1.0, 0.0, 0.0};
  const auto kept = test::update<2>(*law, {-1.0, -50.0}, {0.01, 0.0}, h);
  EXPECT_EQ(kept.sigma[0], -1.0);
  EXPECT_EQ(kept.status, PointStatus::elastic);
  const auto fallen = test::update<2>(*law, {1.0, -50.0}, {0.01, 49e-6}, h);
  EXPECT_EQ(fallen.status, PointStatus::slipping);
  EXPECT_NEAR(fallen.sigma[0], std::tan(30.0 * kRadiansPerDegree), 1e-9);
  EXPECT_EQ(fallen.h[4], 0.01);
}

// An increment of zero keeps to the loading branch on both sides: D = k_i (1 - R_f tau/tau_f)^2.
TEST(CloughDuncan, TangentOfTheZeroIncrement) {
  const auto law = test::interface(22, joint(0.8, 0));
  const double y = 1.0 - 0.8 * 20.0 / kTauF;
  for (const double side : {1.0, -1.0}) {
    const Vector2 start{side * 20.0, -50.0};
    const auto a = test::update<2>(*law, start, Vector2::Zero(), test::initial_history<2>(*law, start));
    EXPECT_EQ(a.status, PointStatus::elastic);
    EXPECT_NEAR(a.D(0, 0), kInitial * y * y, 1e-10 * kInitial);
  }
}

// Stiffness below 1: beyond the strength 0.3 of k w = 0.5 a fifth (k_sf/k) stays; k_sf
// above k adds nothing to k.
TEST(CloughDuncan, StiffnessAfterSlipOfASoftJoint) {
  const double k_j = 0.5 / 0.036111;
  const auto slip = [&](double k_sf) {
    const auto law = test::interface(22, {0.3, 0.0, 0.0, 0.0, k_j, 0.0, 1e6, 1e6, k_sf});
    return test::update<2>(*law, {0.0, -10.0}, {1.0, 0.0}, std::vector<double>(5, 0.0));
  };
  EXPECT_NEAR(slip(0.1).sigma[0], 0.3 + 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(slip(0.1).h[4], 0.2 * 0.8 / 0.5, 1e-12);
  EXPECT_NEAR(slip(2.0).sigma[0], 0.5, 1e-12);
  EXPECT_NEAR(slip(2.0).h[4], 0.0, 1e-12);
}

// On the strength to the last digit is admissible; the level is tau/tau_f, 0 without stress,
// infinite without strength.
TEST(CloughDuncan, StressLevelAndStrength) {
  const auto law = test::interface(22, {2.0, 0.0, 0.0, 0.5, 5000.0, 0.0, 1e6, 1e6, 0.0});
  std::array<double, 5> h{};
  EXPECT_TRUE(law->initialise({2.0, -50.0}, h));
  EXPECT_EQ(law->stress_level({1.0, -50.0}, std::array<double, 5>{}), 0.5);
  EXPECT_EQ(law->stress_level({-1.0, -50.0}, std::array<double, 5>{0, 0, 0, 2.0, 0}), 0.25);
  const auto none = test::interface(22, {0.0, 0.0, 0.0, 0.5, 5000.0, 0.0, 1e6, 1e6, 0.0});
  EXPECT_EQ(none->stress_level({0.0, -50.0}, std::array<double, 5>{}), 0.0);
  EXPECT_EQ(none->stress_level({0.5, -50.0}, std::array<double, 5>{}), std::numeric_limits<double>::infinity());
}

TEST(CloughDuncan, CautionsAboutMissingShearResistance) {
  const auto caution = [](double c, double phi, double k_j, double k_sf) {
    return test::interface(22, {c, phi, 0.0, 0.0, k_j, 0.0, 1e6, 1e6, k_sf})->caution();
  };
  EXPECT_NE(caution(1.0, 30.0, 0.0, 1.0).find("stiffness number"), std::string::npos);
  EXPECT_NE(caution(0.0, 0.0, 5000.0, 0.0).find("adhesion and friction"), std::string::npos);
  EXPECT_EQ(caution(1.0, 0.0, 5000.0, 0.0), "");
  EXPECT_EQ(caution(0.0, 45.0, 5000.0, 0.0), "");
  EXPECT_EQ(caution(0.0, 0.0, 5000.0, 1.0), "");
  EXPECT_EQ(caution(0.0, 0.0, 1.0 / 0.036111, 1.0), "");
}

}  // namespace
}  // namespace sage
