// Expected values: the criterion itself, sigma_1 = sigma_3 + sigma_ci (m sigma_3/sigma_ci + s)^a in compression
// positive stresses; Mohr-Coulomb where a = 1; the projection property of associated flow.
#include "materials/hoek_brown.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr double kE = 2e6, kNu = 0.25, kIntact = 4e4, kM = 5.0, kS = 0.05;

double strength(double sigma3, double m = kM, double s = kS, double a = 0.5) {
  return kIntact * std::pow(m * sigma3 / kIntact + s, a);
}

// With any step, at the strength of the rock mass without pressure too.
TEST(HoekBrown, TriaxialCompression) {
  for (const double a : {0.5, 0.55, 0.65, 1.0})
    for (const double cell : {0.0, 500.0, 5000.0})
      for (const int steps : {1, 20}) {
        const auto path = triaxial_test(*test::solid(9, {kE, kNu, kIntact, kM, kS, a}), cell, 0.1, steps);
        const double q = strength(cell, kM, kS, a);
        EXPECT_NEAR(path.back().deviator, q, 1e-9 * q) << a << " " << cell;
        EXPECT_EQ(path.back().status, PointStatus::yielded);
        // flow = 0: all of the volume strain is elastic.
        EXPECT_NEAR(path.back().volume_strain, q * (1 - 2 * kNu) / kE, 1e-10);
      }
}

// a = .5: (p - sigma_3)^2 = sigma_ci (m sigma_3 + s sigma_ci) for the axial stress sigma_3 below the cell pressure p.
TEST(HoekBrown, TriaxialExtension) {
  const double p = 20000, half = p + 0.5 * kM * kIntact;
  const double axial = half - std::sqrt(half * half - p * p + kS * kIntact * kIntact);
  const auto path = triaxial_test(*test::solid(9, {kE, kNu, kIntact, kM, kS}), p, -0.1, 20);
  EXPECT_NEAR(path.back().deviator, axial - p, 1e-9 * p);
}

// The middle stress doesn't count: plane strain has the strength of triaxial compression.
TEST(HoekBrown, PlaneStrain) {
  const auto law = test::solid(9, {kE, kNu, kIntact, kM, kS});
  PointDriver<4> point(*law, {-500, -500, -500, 0});
  for (int i = 0; i < 20; ++i)
    point.advance({Control::stress, Control::strain, Control::strain, Control::strain}, {-500, -0.005, 0, 0});
  EXPECT_NEAR(point.sigma()[0] - point.sigma()[1], strength(500), 1e-9 * strength(500));
}

// d eps_v/d eps_1 = 1 - M, M - 1 = flow a m (m sigma_3/sigma_ci + s)^(a - 1).
TEST(HoekBrown, Dilation) {
  for (const double flow : {0.3, 1.0}) {
    const auto path = triaxial_test(*test::solid(9, {kE, kNu, kIntact, kM, kS, 0.5, flow}), 500, 0.2, 40);
    const double rate =
        (path[40].volume_strain - path[30].volume_strain) / (path[40].axial_strain - path[30].axial_strain);
    EXPECT_NEAR(rate, -flow * 0.5 * kM / std::sqrt(kM * 500 / kIntact + kS), 1e-8) << flow;
  }
}

// Even tension s sigma_ci/m; with a cut-off that.
TEST(HoekBrown, TipAndCutOff) {
  const Vector4 apart{0.1, 0.1, 0.1, 0.0};
  const auto tip = test::update<4>(*test::solid(9, {kE, kNu, kIntact, kM, kS}), {-5, -5, -5, 0}, apart, {0, 0});
  EXPECT_NEAR((tip.sigma - 400 * Vector4(1, 1, 1, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(tip.status, PointStatus::apex);
  EXPECT_GT(tip.D(0, 0), 0.0);
  const auto cut =
      test::update<4>(*test::solid(9, {kE, kNu, kIntact, kM, kS, 0.5, 0, 100}), {-5, -5, -5, 0}, apart, {0, 0});
  EXPECT_NEAR((cut.sigma - 100 * Vector4(1, 1, 1, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(cut.status, PointStatus::cut_off);
}

// a = 1 is Mohr-Coulomb with N = 1 + m and unconfined strength s sigma_ci, found by the other law's own way.
TEST(HoekBrown, AStraightCriterionIsMohrCoulomb) {
  const double m = 2.0, s = 0.01, N = 1 + m, sine = (N - 1) / (N + 1), flow = 0.4, M = 1 + flow * m;
  const auto rock = test::solid(9, {kE, kNu, kIntact, m, s, 1.0, flow});
  const auto soil =
      test::solid(4, {kE, kNu, kIntact * s / (2 * std::sqrt(N)), std::asin(sine) / kRadiansPerDegree,
                      std::asin((M - 1) / (M + 1)) / kRadiansPerDegree});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector4 deps{uniform(random), uniform(random), uniform(random), uniform(random)};
    const auto a = test::update<4>(*rock, {-60, -60, -60, 0}, deps, {0.0, 0.0});
    const auto b = test::update<4>(*soil, {-60, -60, -60, 0}, deps, {0.0, 0.0});
    EXPECT_LE((a.sigma - b.sigma).norm(), 1e-10 * (b.sigma.norm() + kIntact * s)) << trial;
    EXPECT_LE((a.D - b.D).norm(), 1e-6 * kE) << trial;
  }
}

// Associated flow: the answer is the nearest stress in the energy norm, so no admissible stress lies beyond it:
// (trial - sigma) : C : (other - sigma) <= 0.
TEST(HoekBrown, AssociatedFlowProjects) {
  const auto law = test::solid(9, {kE, kNu, kIntact, kM, kS, 0.5, 1.0});
  const Matrix4 D = elastic_matrix(moduli_from_young(kE, kNu)), C = D.inverse();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto some = [&](double size) {
    return Vector4(size * Vector4(uniform(random), uniform(random), uniform(random), uniform(random)));
  };
  const double h[2] = {0.0, 0.0};
  for (int trial = 0; trial < 300; ++trial) {
    const Vector4 deps = some(0.02), start{-60, -60, -60, 0}, to = start + D * deps;
    const auto a = test::update<4>(*law, start, deps, {0.0, 0.0});
    EXPECT_LE(law->stress_level(a.sigma, a.h), 1.0 + 1e-8);
    const double energy = (to - a.sigma).dot(C * (to - a.sigma));
    for (int other = 0; other < 200; ++other) {
      const Vector4 stress = a.sigma + some(kIntact * std::pow(10.0, -(other % 4)));
      if (law->stress_level(stress, h) > 1.0) continue;
      const double size = std::sqrt((stress - a.sigma).dot(C * (stress - a.sigma)) * energy);
      EXPECT_LE((to - a.sigma).dot(C * (stress - a.sigma)), 1e-6 * size) << trial;
    }
  }
}

TEST(HoekBrown, RefusesWhatCantBeMeant) {
  const auto refused = [](std::vector<double> values) { EXPECT_THROW(test::solid(9, values), ParameterError); };
  refused({kE, kNu, 0, kM, kS});
  refused({kE, kNu, kIntact, 0, kS});
  refused({kE, kNu, kIntact, kM, 1.1});
  refused({kE, kNu, kIntact, kM, kS, 0.4});
  refused({kE, kNu, kIntact, kM, kS, 0.5, 1.5});
  refused({kE, kNu, kIntact, kM, kS, 0.5, 0, -2});
}

}  // namespace
}  // namespace sage
