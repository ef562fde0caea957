// Expected values: closed forms of triaxial compression.  With the axial plastic strain lambda (compression +) the two
// lateral ones are -M lambda/2, so kappa = 2/sqrt 3 (1 + M/2) lambda, and strain = q/E + lambda.
#include "materials/mohr_coulomb_softening.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr double kE = 2e4, kNu = 0.3, kCell = 100.0;

double slope(double degrees) {
  const double s = std::sin(degrees * kRadiansPerDegree);
  return (1 + s) / (1 - s);
}
double strength(double c, double phi) {
  return kCell * (slope(phi) - 1) + 2 * c * std::sqrt(slope(phi));
}
double kappa_of_axial(double psi) {
  return 2 / std::sqrt(3.0) * (1 + slope(psi) / 2);
}

// c falls straight from 20 to 5, phi and psi stay: q and kappa are straight in the strain, with any step.
TEST(MohrCoulombSoftening, StraightCohesionGivesAStraightDescent) {
  const double phi = 30, psi = 10, end = 0.03;
  const auto law = test::solid(8, {kE, kNu, 20, phi, psi, end, 5, phi, psi});
  const double q0 = strength(20, phi), fall = (strength(5, phi) - q0) / end, strain = 0.025;
  const double kappa = (strain - q0 / kE) / (fall / kE + 1 / kappa_of_axial(psi));
  ASSERT_LT(kappa, end);
  for (const int steps : {1, 7, 50}) {
    const auto path = triaxial_test(*law, kCell, strain, steps);
    EXPECT_NEAR(path.back().deviator, q0 + fall * kappa, 1e-9 * q0) << steps;
  }
  // Beyond the end the residual strength stays.
  EXPECT_NEAR(triaxial_test(*law, kCell, 0.2, 10).back().deviator, strength(5, phi), 1e-9 * q0);
}

// Friction hardens to a peak and softens to a residual; psi = 0, so that kappa = sqrt 3 lambda.
TEST(MohrCoulombSoftening, FrictionHardensAndSoftens) {
  const auto law = test::solid(8, {kE, kNu, 0, 20, 0, 0.02, 0, 38, 0, 0.08, 0, 30, 0});
  PointDriver<4> point(*law, {-kCell, -kCell, -kCell, 0});
  double peak = 0.0;
  for (int i = 1; i <= 100; ++i) {
    point.advance({Control::stress, Control::strain, Control::stress, Control::strain},
                  {-kCell, -0.001, -kCell, 0});
    const double q = point.sigma()[0] - point.sigma()[1], kappa = point.history()[0];
    if (kappa == 0.0) continue;
    const double phi = kappa < 0.02 ? 20 + 18 * kappa / 0.02 : 38 - 8 * std::min((kappa - 0.02) / 0.06, 1.0);
    EXPECT_NEAR(q, strength(0, phi), 1e-9 * q) << i;
    EXPECT_NEAR(0.001 * i, q / kE + kappa / kappa_of_axial(0), 1e-12) << i;
    peak = std::max(peak, q);
  }
  EXPECT_NEAR(peak, strength(0, 38), 0.01 * peak);
  EXPECT_NEAR(point.sigma()[0] - point.sigma()[1], strength(0, 30), 1e-9 * peak);
}

// shape 1: c = c_2 + (c_1 - c_2) exp(-(kappa - strain_1)/(strain_2 - strain_1)).
TEST(MohrCoulombSoftening, ExponentialShape) {
  const auto law = test::solid(8, {kE, kNu, 20, 30, 0, 0.01, 20, 30, 0, 0.03, 4, 30, 0, 1});
  PointDriver<4> point(*law, {-kCell, -kCell, -kCell, 0});
  for (int i = 1; i <= 20; ++i) {
    point.advance({Control::stress, Control::strain, Control::stress, Control::strain},
                  {-kCell, -0.003, -kCell, 0});
    const double q = point.sigma()[0] - point.sigma()[1], kappa = point.history()[0];
    if (kappa == 0.0) continue;
    const double c = kappa < 0.01 ? 20 : 4 + 16 * std::exp(-(kappa - 0.01) / 0.02);
    EXPECT_NEAR(q, strength(c, 30), 1e-9 * q) << i;
    EXPECT_NEAR(0.003 * i, q / kE + kappa / kappa_of_axial(0), 1e-12) << i;
  }
}

// Without change it is Mohr-Coulomb (4), at every random increment: rounding of two ways to one answer.
TEST(MohrCoulombSoftening, WithoutChangeItIsMohrCoulomb) {
  const auto law = test::solid(8, {kE, kNu, 10, 30, 10, 0.01, 10, 30, 10});
  const auto plain = test::solid(4, {kE, kNu, 10, 30, 10});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector4 deps{uniform(random), uniform(random), uniform(random), uniform(random)};
    const auto a = test::update<4>(*law, {-60, -60, -60, 0}, deps, {0.0, 0.0});
    const auto b = test::update<4>(*plain, {-60, -60, -60, 0}, deps, {0.0, 0.0});
    EXPECT_LE((a.sigma - b.sigma).norm(), 1e-12 * b.sigma.norm());
    EXPECT_LE((a.D - b.D).norm(), 1e-10 * kE);
    EXPECT_NEAR(a.h[0], b.h[0], 1e-14);
    EXPECT_NEAR(a.h[1], b.h[1], 1e-14);
  }
}

// Even tension makes no plastic shear: the apex c cot(phi) stays where it was.
TEST(MohrCoulombSoftening, EvenTensionDoesNotSoften) {
  const auto a = test::update<4>(*test::solid(8, {kE, kNu, 10, 30, 0, 0.01, 0, 30, 0}), {-5, -5, -5, 0},
                                 {0.1, 0.1, 0.1, 0.0}, {0.0, 0.0});
  EXPECT_NEAR(a.sigma[0], 10 / std::tan(30 * kRadiansPerDegree), 1e-9);
  EXPECT_NEAR(a.h[0], 0.0, 1e-14);
  EXPECT_EQ(a.status, PointStatus::apex);
}

// An element of twice the band's size needs half the strain: it is the law with half of strain_1, with the same strain
// reported.  The tangent is that law's, too.
TEST(MohrCoulombSoftening, StrainGoesWithTheSizeOfTheElement) {
  const double end = 0.03, width = 0.2;
  const std::vector<double> rest{-1, -1, -1, -1, 0, -1};
  const auto law_of = [&](double strain, std::vector<double> more) {
    std::vector<double> values{kE, kNu, 20, 30, 10, strain, 5, 25, 5};
    values.insert(values.end(), rest.begin(), rest.end());
    values.insert(values.end(), more.begin(), more.end());
    return test::solid(8, values);
  };
  const auto band = law_of(end, {width});
  EXPECT_EQ(band->caution(), "");
  ASSERT_EQ(band->traits().history.size(), 3u);
  EXPECT_TRUE(band->traits().wants_context);
  for (const double ratio : {0.5, 1.0, 2.0}) {
    const auto plain = law_of(end / ratio, {});
    PointContext context;
    context.size = ratio * width;
    Vector4 sigma_a{-100, -100, -100, 0}, sigma_b = sigma_a;
    std::vector<double> a(3, 0.0), b(2, 0.0);
    for (int i = 0; i < 8; ++i) {
      const Vector4 deps{0.002, -0.003, 0.0, 0.001};
      std::vector<double> a1(3), b1(2);
      PointOut<4> of_band, of_plain;
      of_band.h1 = a1;
      of_plain.h1 = b1;
      ASSERT_EQ(band->update({sigma_a, Vector4::Zero(), deps, a, &context}, of_band), Outcome::ok);
      ASSERT_EQ(plain->update({sigma_b, Vector4::Zero(), deps, b, nullptr}, of_plain), Outcome::ok);
      EXPECT_LE((of_band.sigma - of_plain.sigma).norm(), 1e-9 * of_plain.sigma.norm()) << ratio << ' ' << i;
      EXPECT_LE((of_band.D - of_plain.D).norm(), 1e-7 * kE) << ratio << ' ' << i;
      EXPECT_NEAR(a1[0], b1[0], 1e-12);
      // Beyond strain_1 nothing falls.
      EXPECT_NEAR(a1[2], ratio * std::min(b1[0], end / ratio) + std::max(b1[0] - end / ratio, 0.0), 1e-12);
      EXPECT_NEAR(band->stress_level(of_band.sigma, a1), plain->stress_level(of_plain.sigma, b1), 1e-9);
      sigma_a = of_band.sigma;
      sigma_b = of_plain.sigma;
      a = a1;
      b = b1;
    }
    EXPECT_GT(b[0], 0.01);
  }
}

TEST(MohrCoulombSoftening, SaysThatResultsDependOnTheMesh) {
  EXPECT_NE(test::solid(8, {kE, kNu, 10, 30, 0, 0.01, 5, 30, 0})->caution().find("depend on the mesh"),
            std::string::npos);
  EXPECT_EQ(test::solid(8, {kE, kNu, 10, 30, 10, 0.01, 10, 35, 0})->caution(), "");
}

TEST(MohrCoulombSoftening, RefusesWhatCantBeMeant) {
  const auto refused = [](std::vector<double> values) { EXPECT_THROW(test::solid(8, values), ParameterError); };
  refused({kE, kNu, 10, 30, 31, 0.01, 5, 30, 0});                    // psi > phi
  refused({kE, kNu, 10, 30, 0, 0.01, 5, 20, 25});                    // likewise at strain_1
  refused({kE, kNu, 10, 30, 0, 0.0, 5, 30, 0});                      // strain_1 = 0
  refused({kE, kNu, 10, 30, 0, 0.01, 5, 30, 0, 0.005, 1, 30, 0});    // strain_2 below it
  refused({kE, kNu, 10, 30, 0, 0.01, 5, 30, 0, -1, 1});              // a value without its strain
  refused({kE, kNu, 10, 30, 0, 0.01, 5, 30, 0, 0.02, 1, 30, 0, 2});  // shape
}

// A history that a deck states has to bear the initial stress.
TEST(MohrCoulombSoftening, AcceptsAHistoryThatBearsTheStress) {
  const auto law = test::solid(8, {kE, kNu, 20, 30, 0, 0.01, 0, 30, 0});
  const Vector4 sigma{-100, -320, -100, 0};
  EXPECT_TRUE(law->accepts_history(sigma, std::vector<double>{0.0, 0.0}));
  EXPECT_FALSE(law->accepts_history(sigma, std::vector<double>{0.01, 0.0}));
  EXPECT_FALSE(law->accepts_history(sigma, std::vector<double>{-0.01, 0.0}));
}

}  // namespace
}  // namespace sage
