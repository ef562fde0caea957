// Moduli against the formulas worked out by hand, and against differences of their own values.
#include "materials/hyperbolic.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

HyperbolicParameters soil() {
  HyperbolicParameters p{};
  p.K = 400;
  p.n = 0.5;
  p.R_f = 0.8;
  p.K_ur = 600;
  p.volume = VolumeRule::bulk_1980;
  p.K_b = 250;
  p.m = 0.3;
  p.G = 0.4;
  p.F = 0.1;
  p.d = 3.0;
  p.c = 5.0;
  p.phi0 = 33 * kRadiansPerDegree;
  p.dphi = 0.0;
  p.p_a = 101.325;
  p.nu_max = 0.49;
  p.floor = 0.01;
  return p;
}
double young(const HyperbolicModuli& m) {
  return 9 * m.K.v * m.G.v / (3 * m.K.v + m.G.v);
}
double poisson(const HyperbolicModuli& m) {
  return (3 * m.K.v - 2 * m.G.v) / (6 * m.K.v + 2 * m.G.v);
}

// K = 400, n = .5, sigma_3 = 100: E_i = 40264.128, (sigma_1 - sigma_3)_f = 257.62971.
TEST(Hyperbolic, InitialModulusAndStrength) {
  EXPECT_NEAR(young(hyperbolic_moduli(soil(), 100, 100, 0)), 40264.128, 5e-4);
  EXPECT_NEAR(deviator_strength(soil(), HyperbolicReal(100.0)).v, 257.62971, 5e-6);
}

TEST(Hyperbolic, TangentModulusAndBulkModulus) {
  const HyperbolicModuli m = hyperbolic_moduli(soil(), 200, 100, 0);
  const double y = 1 - 0.8 * 100 / 257.62971;
  EXPECT_NEAR(young(m), 40264.128 * y * y, 1e-3);
  EXPECT_NEAR(m.K.v, 250 * 101.325 * std::pow(100 / 101.325, 0.3), 1e-8);
}

// phi = phi0 - dphi log10(sigma_3/p_a): one decade above p_a takes dphi off.
TEST(Hyperbolic, FrictionFallsWithStress) {
  HyperbolicParameters p = soil();
  p.dphi = 6 * kRadiansPerDegree;
  EXPECT_NEAR(friction_angle(p, HyperbolicReal(1013.25)).v / kRadiansPerDegree, 27.0, 1e-12);
  EXPECT_NEAR(friction_angle(p, HyperbolicReal(10.1325)).v / kRadiansPerDegree, 39.0, 1e-12);
  EXPECT_NEAR(friction_angle(p, HyperbolicReal(-5.0)).v / kRadiansPerDegree, 45.0, 1e-12);  // floor .01
}

// Bounds 0 <= nu <= nu_max: B between E/3 and E/(3(1-2 nu_max)) = 16.67 E.
TEST(Hyperbolic, BulkModulusIsBounded) {
  HyperbolicParameters p = soil();
  p.K_b = 1.0;
  EXPECT_NEAR(poisson(hyperbolic_moduli(p, 150, 100, 0)), 0.0, 1e-12);
  p.K_b = 1e6;
  EXPECT_NEAR(poisson(hyperbolic_moduli(p, 150, 100, 0)), 0.49, 1e-12);
}

// nu_t = (G - F log10(sigma_3/p_a))/(1-A)^2, A = d q/(E_i (1 - R_f SL)).
TEST(Hyperbolic, Poisson1970) {
  HyperbolicParameters p = soil();
  p.volume = VolumeRule::poisson_1970;
  p.G = 0.3;
  const double A = 3.0 * 100 / (40264.128 * (1 - 0.8 * 100 / 257.62971));
  const double nu = (0.3 - 0.1 * std::log10(100 / 101.325)) / ((1 - A) * (1 - A));
  EXPECT_NEAR(poisson(hyperbolic_moduli(p, 200, 100, 0)), nu, 1e-9);
  p.d = 1000;  // A > 1
  EXPECT_NEAR(poisson(hyperbolic_moduli(p, 200, 100, 0)), 0.49, 1e-12);
}

// Unloading (Duncan et al. 1984): E_ur below 3/4 of the critical level, E_t at it, half way between at 7/8.
TEST(Hyperbolic, UnloadingBlend) {
  const HyperbolicParameters p = soil();
  const double memory = stress_state(p, 300, 100).v;  // SL = 200/257.63 at the same sigma_3
  const double E_ur = 600 * 101.325 * std::sqrt(100 / 101.325);
  const auto E_t = [](double q) {
    const double y = 1 - 0.8 * q / 257.62971;
    return 40264.128 * y * y;
  };
  EXPECT_NEAR(young(hyperbolic_moduli(p, 300, 100, memory)), E_t(200), 1e-3);
  EXPECT_NEAR(young(hyperbolic_moduli(p, 275, 100, memory)), 0.5 * (E_t(175) + E_ur), 1e-3);
  EXPECT_NEAR(young(hyperbolic_moduli(p, 249, 100, memory)), E_ur, 1e-8);
  EXPECT_FALSE(hyperbolic_moduli(p, 300, 100, memory).unloading);
  EXPECT_TRUE(hyperbolic_moduli(p, 299, 100, memory).unloading);
}

// A memory of rounding size, which isotropic compression leaves, chooses nothing: first loading.  From 4e-4 on
// the blend is a quarter of the memory; below, 1e-4 wide.
TEST(Hyperbolic, RoundingIsNoMemory) {
  const HyperbolicParameters p = soil();
  const double q_f = 257.62971, root = std::pow(100 / 101.325, 0.25), E_i = 40264.128, E_ur = 1.5 * E_i;
  for (const double memory : {1e-17, 1e-15, 1e-12, 9e-12}) {
    EXPECT_NEAR(young(hyperbolic_moduli(p, 100, 100, memory)), E_i, 5e-4) << memory;
    EXPECT_FALSE(hyperbolic_moduli(p, 100, 100, memory).unloading) << memory;
  }
  EXPECT_NEAR(young(hyperbolic_moduli(p, 100, 100, 1e-9)), E_i + 0.99e-5 * (E_ur - E_i), 5e-3);
  EXPECT_NEAR(young(hyperbolic_moduli(p, 100, 100, 0.5e-4 * root)), 0.5 * (E_i + E_ur), 5e-3);
  EXPECT_NEAR(young(hyperbolic_moduli(p, 100 + 7e-4 * q_f, 100, 8e-4 * root)),
              0.5 * (E_i * std::pow(1 - 0.8 * 7e-4, 2) + E_ur), 5e-2);
}

// The moduli do not jump where the memory is left: 4e-7 of 4e4 from one side of the tolerance to the other.
TEST(Hyperbolic, LeavesTheMemoryWithoutAJump) {
  const HyperbolicParameters p = soil();
  const double q_f = 257.62971;
  const double memory = stress_state(p, 200, 100).v;
  const auto below = [&](double level) { return young(hyperbolic_moduli(p, 200 - level * q_f, 100, memory)); };
  EXPECT_NEAR(below(1.1e-11), below(0.9e-11), 1e-6);
  EXPECT_FALSE(hyperbolic_moduli(p, 200 - 0.9e-11 * q_f, 100, memory).unloading);
  EXPECT_TRUE(hyperbolic_moduli(p, 200 - 1.1e-11 * q_f, 100, memory).unloading);
}

// R_f = 1 at failure: (1 - R_f SL)^2 = 0, and E_t = 1e-4 E_i is left.
TEST(Hyperbolic, SomethingIsLeftAtFailure) {
  HyperbolicParameters p = soil();
  p.R_f = 1.0;
  EXPECT_NEAR(young(hyperbolic_moduli(p, 360, 100, 0)), 1e-4 * 40264.128, 1e-7);
}

// SS = SL (sigma_3/p_a)^(1/4), SL at most 1.
TEST(Hyperbolic, StressStateNumber) {
  const double root = std::pow(100 / 101.325, 0.25);
  EXPECT_NEAR(stress_state(soil(), 200, 100).v, 100 / 257.62971 * root, 1e-8);
  EXPECT_NEAR(stress_state(soil(), 700, 100).v, root, 1e-14);
}

// Tension: stiffness falls to 1/1000 over one floor's width, linearly.
TEST(Hyperbolic, Tension) {
  const HyperbolicParameters p = soil();
  const double at_zero = young(hyperbolic_moduli(p, 0, 0, 0));
  EXPECT_NEAR(at_zero, 400 * 101.325 * 0.1, 1e-8);  // sqrt(0.01)
  const double half = -0.5 * p.floor * p.p_a;
  EXPECT_NEAR(young(hyperbolic_moduli(p, half, half, 0)), 0.5 * at_zero, 1e-9);
  EXPECT_NEAR(young(hyperbolic_moduli(p, -10, -10, 0)), 1e-3 * at_zero, 1e-9);
}

// Derivatives with respect to sigma_1, sigma_3 and the memory; step 1e-4 of 100 kPa,
// tolerance 1e-6 of the modulus.
TEST(Hyperbolic, DerivativesMatchDifferences) {
  for (const VolumeRule volume : {VolumeRule::bulk_1980, VolumeRule::poisson_1970}) {
    HyperbolicParameters p = soil();
    p.volume = volume;
    p.G = 0.25;
    p.dphi = 4 * kRadiansPerDegree;
    for (const double memory : {0.0, 0.65}) {
      const double s1 = 230, s3 = 90, step = 1e-3;
      const HyperbolicModuli m = hyperbolic_moduli(p, s1, s3, memory);
      const auto slope = [&](double d1, double d3, double dm, auto part) {
        return (part(hyperbolic_moduli(p, s1 + d1, s3 + d3, memory + dm)) -
                part(hyperbolic_moduli(p, s1 - d1, s3 - d3, memory - dm))) /
               (2 * (d1 + d3 + dm));
      };
      const auto K = [](const HyperbolicModuli& x) { return x.K.v; };
      const auto G = [](const HyperbolicModuli& x) { return x.G.v; };
      EXPECT_NEAR(m.K.d[0], slope(step, 0, 0, K), 1e-6 * m.K.v);
      EXPECT_NEAR(m.K.d[1], slope(0, step, 0, K), 1e-6 * m.K.v);
      EXPECT_NEAR(m.G.d[0], slope(step, 0, 0, G), 1e-6 * m.G.v);
      EXPECT_NEAR(m.G.d[1], slope(0, step, 0, G), 1e-6 * m.G.v);
      if (memory > 0.0) {
        EXPECT_TRUE(m.unloading);
        EXPECT_NEAR(m.G.d[2], slope(0, 0, 1e-6, G), 1e-5 * m.G.v);
        EXPECT_NE(m.G.d[2], 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace sage
