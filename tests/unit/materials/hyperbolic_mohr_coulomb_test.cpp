// The hyperbola up to its strength, and not a bit more: q_f = 257.62971 for c = 5, phi = 33, sigma_3 = 100.
#include "materials/hyperbolic_mohr_coulomb.hpp"

#include <gtest/gtest.h>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

const std::vector<double> kSoil = {400, 0.5, 0.8, 600, 250, 0.3, 5, 33};

TEST(HyperbolicMohrCoulomb, HyperbolaBelowFailure) {
  const double q = triaxial_test(*test::solid(7, kSoil), 100.0, 0.02, 2000).back().deviator;
  EXPECT_NEAR(q, 230.042010, 1e-6 * q);
}

// The hyperbola reaches q_f at 3.199246 %; from there q = q_f, where Duncan-Chang alone overshoots.
TEST(HyperbolicMohrCoulomb, NoOvershoot) {
  for (const int steps : {10, 100, 1000}) {
    const auto path = triaxial_test(*test::solid(7, kSoil), 100.0, 0.06, steps);
    EXPECT_NEAR(path.back().deviator, 257.62971, 257.0 * 1e-7);
    EXPECT_EQ(path.back().status, PointStatus::yielded);
    for (const TriaxialPoint& p : path) EXPECT_LE(p.deviator, 257.62971 * (1 + 1e-7));
  }
  EXPECT_GT(triaxial_test(*test::solid(6, kSoil), 100.0, 0.06, 100).back().deviator, 260.0);
}

// 1 increment against 100 on straight strain paths that reach failure: the law finds its own substeps.  1e-3: a
// few times their error next to the surface.  (A triaxial test is another matter: its strain path is curved,
// see below.)
TEST(HyperbolicMohrCoulomb, IncrementSizeDoesNotMatter) {
  const auto law = test::solid(7, kSoil);
  const Vector4 start{-100, -100, -100, 0};
  for (const Vector4& deps : {Vector4(0.012, -0.02, 0.009, 0.01), Vector4(0.006, -0.01, 0.005, 0.0),
                              Vector4(0.004, -0.006, 0.003, 0.02)}) {
    const auto one = test::update<4>(*law, start, deps, test::initial_history<4>(*law, start));
    test::Answer<4> many = test::update<4>(*law, start, Vector4::Zero(), test::initial_history<4>(*law, start));
    for (int i = 0; i < 100; ++i) many = test::update<4>(*law, many.sigma, deps / 100, many.h);
    EXPECT_EQ(one.outcome, Outcome::ok);
    EXPECT_GT(law->stress_level(many.sigma, many.h), 0.99);
    EXPECT_LT((one.sigma - many.sigma).norm(), 1e-3 * many.sigma.norm());
  }
}

// A triaxial test in 10 increments against 100: deviator to 0.2 % before failure and to rounding after it;
// volume 1 %.
TEST(HyperbolicMohrCoulomb, FewIncrementsOfATriaxialTest) {
  const auto law = test::solid(7, kSoil);
  for (const double strain : {0.01, 0.02, 0.03, 0.04, 0.06}) {
    const auto few = triaxial_test(*law, 100.0, strain, 10).back(),
               many = triaxial_test(*law, 100.0, strain, 100).back();
    EXPECT_NEAR(few.deviator, many.deviator, 2e-3 * many.deviator) << strain;
    EXPECT_NEAR(few.volume_strain, many.volume_strain, 1e-2 * many.volume_strain) << strain;
  }
}

// One step or a hundred: 1 % of the deviator, whatever the strain; a step too long for its bend is divided.
TEST(HyperbolicMohrCoulomb, OneStepOrAHundred) {
  for (const int code : {6, 7})
    for (const double strain : {0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.1}) {
      const auto law = test::solid(code, kSoil);
      const double many = triaxial_test(*law, 100.0, strain, 100).back().deviator;
      for (const int few : {1, 2, 5})
        EXPECT_NEAR(triaxial_test(*law, 100.0, strain, few).back().deviator, many, 0.01 * many) << strain;
    }
}

// psi = 0: no volume change at failure.  psi = 10: d eps_v/d eps_1 = 1 - K_psi.
TEST(HyperbolicMohrCoulomb, VolumeChangeAtFailure) {
  const auto rate = [](double psi) {
    std::vector<double> values = kSoil;
    values.insert(values.end(), {0.0, psi});
    const auto path = triaxial_test(*test::solid(7, values), 100.0, 0.08, 80);
    return (path[80].volume_strain - path[60].volume_strain) / 0.02;
  };
  const double s = std::sin(10 * kRadiansPerDegree);
  EXPECT_NEAR(rate(0.0), 0.0, 1e-9);
  EXPECT_NEAR(rate(10.0), 1.0 - (1 + s) / (1 - s), 1e-9);
}

// Curved envelope: the strength at sigma_3 = 400 is that of phi = 38 - 6 log10(400/p_a).
TEST(HyperbolicMohrCoulomb, CurvedEnvelope) {
  const auto law = test::solid(7, {400, 0.5, 0.8, 600, 250, 0.3, 0, 38, 6});
  const double phi = (38 - 6 * std::log10(400 / 101.325)) * kRadiansPerDegree;
  const double q = 2 * 400 * std::sin(phi) / (1 - std::sin(phi));
  EXPECT_NEAR(triaxial_test(*law, 400.0, 0.2, 40).back().deviator, q, 1e-8 * q);
}

// Unloading from failure leaves the surface, and reloading comes back to the same strength.
TEST(HyperbolicMohrCoulomb, UnloadFromFailure) {
  constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress,
                                             Control::strain};
  const auto law = test::solid(7, kSoil);
  PointDriver<4> point(*law, {-100, -100, -100, 0});
  point.advance(kTriaxial, {-100.0, -0.05, -100.0, 0.0});
  point.advance(kTriaxial, {-100.0, 0.005, -100.0, 0.0});
  EXPECT_EQ(point.status(), PointStatus::unloading);
  EXPECT_LT(point.stress_level(), 0.9);
  point.advance(kTriaxial, {-100.0, -0.02, -100.0, 0.0});
  EXPECT_EQ(point.status(), PointStatus::yielded);
  EXPECT_NEAR(point.sigma()[0] - point.sigma()[1], 257.62971, 257.0 * 1e-7);
}

// Coarse substeps (0.3) reach the envelope along a strongly bent path: where they cross it is found to
// rounding, and so the tangent stays the derivative.  1e-5 of the largest term: the differences.
TEST(HyperbolicMohrCoulomb, CoarseSubstepsFindTheEnvelope) {
  std::vector<double> coarse = kSoil;
  coarse.insert(coarse.end(), {0.0, 0.0, -1.0, 0.49, 0.01, 0.3});
  const auto law = test::solid(7, coarse);
  const Vector4 start{-100, -100, -100, 0};
  const auto h = test::initial_history<4>(*law, start);
  for (double size = 0.01; size < 2.0; size *= 1.1) {
    const Vector4 deps = size * Vector4(0.45, -1.0, 0.45, 0.3);
    const auto a = test::update<4>(*law, start, deps, h);
    const Matrix4 D = test::difference_tangent<4>(*law, start, deps, h, 1e-7 * size);
    EXPECT_EQ(a.outcome, Outcome::ok);
    EXPECT_LE((a.D - D).cwiseAbs().maxCoeff(), 1e-5 * D.cwiseAbs().maxCoeff()) << size;
  }
}

// On the envelope the law flows: G = 0, so that from inside onto it a = 1/4 in (H6), and along it nothing is
// left but the change of K, here none (m = 0).
TEST(HyperbolicMohrCoulomb, PathErrorAtTheEnvelope) {
  const auto law = test::solid(7, {400, 0.5, 0.8, 600, 250, 0.0, 5, 33});
  const double s = std::sin(33 * kRadiansPerDegree), c = std::cos(33 * kRadiansPerDegree);
  const auto failing = [&](double sigma_3) {
    return Vector4(-sigma_3, -sigma_3 - (10 * c + 2 * sigma_3 * s) / (1 - s), -sigma_3, 0.0);
  };
  const auto stated = [&](const Vector4& from, const Vector4& to) {
    const std::vector<double> h{0.0};
    return path_error<4>(*law, {from, Vector4::Zero(), Vector4::Zero(), h}, to, h);
  };
  const Vector4 inside{-200, -200, -200, 0};
  EXPECT_NEAR(stated(inside, failing(200)), 3.0 / 16.0 * (failing(200) - inside).norm() / failing(200).norm(),
              1e-12);
  EXPECT_NEAR(stated(failing(200), failing(300)), 0.0, 1e-12);
}

TEST(HyperbolicMohrCoulomb, InitialStressMustBeAdmissible) {
  const auto law = test::solid(7, kSoil);
  std::array<double, 1> h{};
  EXPECT_TRUE(law->initialise({-100, -357, -150, 0}, h));
  EXPECT_FALSE(law->initialise({-100, -358, -150, 0}, h));
  const double s = std::sin(33 * kRadiansPerDegree),
               q_f = (10 * std::cos(33 * kRadiansPerDegree) + 200 * s) / (1 - s);
  EXPECT_TRUE(law->initialise({-100, -100 - q_f, -150, 0}, h));  // at failure to the last digit
  EXPECT_FALSE(law->traits().symmetric);
}

}  // namespace
}  // namespace sage
