#include "materials/linear_elastic.hpp"

#include <gtest/gtest.h>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

// Chapter 7: sigma_z = sigma_cell + E eps_a, eps_r = -nu eps_a.  1e-12: rounding of a 4x4 solve.
TEST(LinearElastic, TriaxialTestGivesYoungAndPoisson) {
  const auto law = test::solid(1, {3000.0, 0.25});
  const auto path = triaxial_test(*law, 50.0, 0.1, 10);
  EXPECT_NEAR(path.back().deviator, 300.0, 300.0 * 1e-12);
  EXPECT_NEAR(path.back().volume_strain, 0.1 * (1.0 - 0.5), 1e-13);
}

// Shear has its own modulus and doesn't couple: tau = G gamma, G = E/2(1+nu) = 1200.
TEST(LinearElastic, EngineeringShear) {
  const auto law = test::solid(1, {3000.0, 0.25});
  const auto a = test::update<4>(*law, Vector4::Zero(), {0.0, 0.0, 0.0, 0.01}, {});
  EXPECT_NEAR(a.sigma[3], 12.0, 1e-13);
  EXPECT_EQ(a.sigma.head<3>().cwiseAbs().maxCoeff(), 0.0);
}

// Oedometer: E (1-nu)/((1+nu)(1-2nu)), sigma_h = nu/(1-nu) sigma_v.
TEST(LinearElastic, Oedometer) {
  const double E = 3000.0, nu = 0.3;
  const auto law = test::solid(1, {E, nu});
  const auto a = test::update<4>(*law, Vector4::Zero(), {0.0, -0.001, 0.0, 0.0}, {});
  EXPECT_NEAR(a.sigma[1], -0.001 * E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 1e-12);
  EXPECT_NEAR(a.sigma[0], nu / (1 - nu) * a.sigma[1], 1e-12);
}

TEST(LinearElastic, BothParameterSetsAgree) {
  const double E = 3000.0, nu = 0.495, K = E / (3 * (1 - 2 * nu)), G = E / (2 * (1 + nu));
  const auto a = test::update<4>(*test::solid(1, {E, nu}), Vector4::Zero(), {0.1, -0.2, 0.3, 0.4}, {});
  const auto b = test::update<4>(*test::solid(2, {K, G}), Vector4::Zero(), {0.1, -0.2, 0.3, 0.4}, {});
  EXPECT_LT((a.sigma - b.sigma).norm(), 1e-13 * a.sigma.norm());
}

// G from E and B stays finite at nu = 1/2 (B -> infinity): G = E/3.
TEST(LinearElastic, YoungAndBulkNeedNoPoisson) {
  EXPECT_NEAR(moduli_from_young_and_bulk(3000.0, 1e30).G, 1000.0, 1e-9);
  EXPECT_NEAR(moduli_from_young_and_bulk(3000.0, 2000.0).G, 1200.0, 1e-9);  // nu = 0.25
}

}  // namespace
}  // namespace sage
