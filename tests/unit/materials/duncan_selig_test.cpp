// Closed form of isotropic compression: sigma_m = B_i eps_v/(1 - eps_v/eps_u), Selig (1988).  p_a = 101.325.
#include "materials/duncan_selig.hpp"

#include <gtest/gtest.h>

#include "materials/hyperbolic.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

// E/3 <= B <= 17 E on the way, so that nothing but (D3) rules the volume.
const std::vector<double> kSoil = {30, 0.5, 0.8, 45, 20, 0.1, 5, 33};

double volume_strain(double p) {
  const double B_i = 20 * 101.325;
  return p / (B_i + p / 0.1);
}

double compressed(const std::vector<double>& values, double from, double to, int steps) {
  const auto law = test::solid(10, values);
  const Vector4 start{-from, -from, -from, 0};
  const double strain = (volume_strain(to) - volume_strain(from)) / 3 / steps;
  test::Answer<4> at = test::update<4>(*law, start, Vector4::Zero(), test::initial_history<4>(*law, start));
  for (int i = 0; i < steps; ++i) at = test::update<4>(*law, at.sigma, {-strain, -strain, -strain, 0}, at.h);
  EXPECT_NEAR(at.sigma[0], at.sigma[2], 1e-9 * to);
  return -(at.sigma[0] + at.sigma[1] + at.sigma[2]) / 3;
}

// Fourfold pressure.  1e-6: what is left of second order after 1000 steps; one step: the law's own substeps, whose
// Euler half errs by 1e-3 each, and Heun by far less: 5e-4 in all.
TEST(DuncanSelig, IsotropicCompressionIsSeligsHyperbola) {
  EXPECT_NEAR(compressed(kSoil, 100, 400, 1000), 400.0, 1e-6 * 400);
  EXPECT_NEAR(compressed(kSoil, 100, 400, 1), 400.0, 5e-4 * 400);
}

// At the mean stress B_i p_a eps_u the bulk modulus has grown four times.
TEST(DuncanSelig, BulkModulusGrowsWithTheMeanStress) {
  HyperbolicParameters p{};
  p.K = 30, p.n = 0.5, p.R_f = 0.8, p.K_ur = 45, p.volume = VolumeRule::bulk_selig, p.B_i = 20, p.eps_u = 0.1;
  p.c = 5, p.phi0 = 33 * kRadiansPerDegree, p.p_a = 100, p.nu_max = 0.49, p.floor = 0.01;
  const double mean = 20 * 100 * 0.1;
  EXPECT_NEAR(hyperbolic_moduli(p, 150, 150, 0, mean).K.v, 4 * 2000.0, 1e-9);
  EXPECT_NEAR(hyperbolic_moduli(p, 150, 150, 0, 0).K.v, 2000.0, 1e-9);
  EXPECT_NEAR(hyperbolic_moduli(p, 150, 150, 0, -50).K.v, 2000.0, 1e-9) << "tension stiffens nothing";
}

// Central differences of 1e-4 of the mean stress: 1e-6 of the derivative is left.  And where the bounds hold,
// the mean stress has no say.
TEST(DuncanSelig, DerivativeByTheMeanStress) {
  HyperbolicParameters p{};
  p.K = 30, p.n = 0.5, p.R_f = 0.8, p.K_ur = 45, p.volume = VolumeRule::bulk_selig, p.B_i = 20, p.eps_u = 0.1;
  p.c = 5, p.phi0 = 33 * kRadiansPerDegree, p.p_a = 100, p.nu_max = 0.49, p.floor = 0.01;
  const auto at = [&](double mean) { return hyperbolic_moduli(p, 150, 100, 0, mean); };
  const double h = 0.01;
  EXPECT_NEAR(at(110).dK_mean, (at(110 + h).K.v - at(110 - h).K.v) / (2 * h), 1e-6 * at(110).dK_mean);
  EXPECT_NEAR(at(110).dG_mean, (at(110 + h).G.v - at(110 - h).G.v) / (2 * h), 1e-6);
  EXPECT_GT(at(110).dK_mean, 10.0);
  EXPECT_EQ(at(1e6).dK_mean, 0.0);
}

TEST(DuncanSelig, BadParametersAreNamed) {
  const auto refused = [](std::size_t place, double value) {
    std::vector<double> values = kSoil;
    values[place] = value;
    try {
      test::solid(10, values);
    } catch (const ParameterError& error) {
      return error.parameter();
    }
    return -2;
  };
  EXPECT_EQ(refused(4, 0.0), 4);
  EXPECT_EQ(refused(4, -20.0), 4);
  EXPECT_EQ(refused(5, 0.0), 5);
  EXPECT_EQ(refused(2, 1.5), 2);
}

}  // namespace
}  // namespace sage
