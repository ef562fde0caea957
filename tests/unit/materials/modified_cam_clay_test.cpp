// Expected values: integrals of the law's differential equations by a Runge-Kutta method of order 8 (relative error
// below 1e-9), and closed forms: the critical state of undrained paths, K0 of normal compression, the elastic loop.
#include "materials/modified_cam_clay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

constexpr double kM = 1.2, kLambda = 0.2, kKappa = 0.04, kV = 2.0, kNu = 0.3, kStart = 100.0;
constexpr double kIrreversible = 1.0 - kKappa / kLambda;

std::vector<double> parameters(double ocr, std::vector<double> more = {}) {
  std::vector<double> values{kM, kLambda, kKappa, kV, kNu, ocr, 0.0, 0.0};
  values.insert(values.end(), more.begin(), more.end());
  return values;
}
std::unique_ptr<SolidLaw> clay(double ocr, const std::vector<double>& more = {}) {
  return test::solid(11, parameters(ocr, more));
}

enum class Path { drained, undrained, oedometer, plane_undrained, plane_drained };
const Vector4 kIsotropic(-kStart, -kStart, -kStart, 0.0);

// To an axial strain, compression positive; yy is the axis.
PointDriver<4> driven(const SolidLaw& law, Path path, double strain, int steps) {
  constexpr Control e = Control::strain, s = Control::stress;
  PointDriver<4> point(law, kIsotropic);
  const double d = -strain / steps;
  for (int i = 0; i < steps; ++i) switch (path) {
      case Path::drained:
        point.advance({s, e, s, e}, {-kStart, d, -kStart, 0.0});
        break;
      case Path::undrained:
        point.advance({e, e, e, e}, {-0.5 * d, d, -0.5 * d, 0.0});
        break;
      case Path::oedometer:
        point.advance({e, e, e, e}, {0.0, d, 0.0, 0.0});
        break;
      case Path::plane_undrained:
        point.advance({e, e, e, e}, {-d, d, 0.0, 0.0});
        break;
      case Path::plane_drained:
        point.advance({s, e, e, e}, {-kStart, d, 0.0, 0.0});
        break;
    }
  return point;
}

struct Reference {
  Path path;
  double ocr, strain;
  double axial, middle, least, p_c, volume;  // at the end, compression positive
  std::vector<double> more = {};             // parameters behind p_c
};

const std::vector<Reference>& references() {
  static const std::vector<Reference> all{
      {Path::drained, 1, .05, 181.808491343, 100, 100, 163.787746269, .0442948274},
      {Path::drained, 1, .2, 265.852404834, 100, 100, 278.297972517, .0906835034},
      {Path::drained, 2, .1, 255.730027629, 100, 100, 262.775360931, .0302009351},
      {Path::drained, 8, .1, 422.304297578, 100, 100, 555.201594729, -.0146295012},
      {Path::drained, 8, .4, 306.674241964, 100, 100, 344.523008025, -.0569143522},
      {Path::undrained, 1, .01, 117.093671677, 66.753298368, 66.753298368, 104.600781839, 0},
      {Path::undrained, 1, .05, 104.229224252, 35.643485309, 35.643485309, 114.340744303, 0},
      {Path::undrained, 8, .1, 535.218906558, 168.028890364, 168.028890364, 612.817667123, 0},
      {Path::drained, 1, -.02, 38.856009192, 100, 100, 112.227119557, .0046699273},
      {Path::oedometer, 1, .1, 318.303015879, 206.144823811, 206.144823811, 279.402050716, .1},
      {Path::oedometer, 2, .1, 554.198031355, 358.916506328, 358.916506328, 486.467671334, .1},
      {Path::oedometer, 8, .05, 1021.185598359, 624.183201859, 624.183201859, 901.196128455, .05},
      {Path::plane_undrained, 1, .01, 111.620874266, 80.487180539, 49.353486813, 105.576757914, 0},
      {Path::plane_drained, 1, .05, 184.913537979, 114.888461082, 100, 165.406905205, .0460028065},
      {Path::plane_drained, 2, .1, 301.664814955, 177.389602535, 100, 304.734353272, .0468421243},
      {Path::drained, 1, .1, 218.938564461, 100, 100, 209.994520603, .0683128203, {0, 1}},
      {Path::oedometer, 1, .1, 303.271688752, 196.411538992, 196.411538992, 266.207645560, .1, {0, 1}},
      {Path::undrained, 1, .01, 117.275678678, 68.899577944, 68.899577944, 104.139001716, 0, {0, 0, 2000}},
  };
  return all;
}

// axial, middle, least stress, p_c: compression positive.
Vector4 state_of(const PointDriver<4>& point) {
  return {-point.sigma()[1], -point.sigma()[2], -point.sigma()[0], point.history()[0]};
}
double error_of(const Reference& reference, const Vector4& state) {
  const Vector4 expected(reference.axial, reference.middle, reference.least, reference.p_c);
  return (state - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff();
}

TEST(ModifiedCamClay, PathsInAHundredSteps) {
  for (std::size_t i = 0; i < references().size(); ++i) {
    const Reference& r = references()[i];
    const auto law = clay(r.ocr, r.more);
    const PointDriver<4> point = driven(*law, r.path, r.strain, 100);
    EXPECT_LE(error_of(r, state_of(point)), 3e-4) << i;
    EXPECT_NEAR(-point.eps().head<3>().sum(), r.volume, 3e-5) << i;
  }
}

// The error is of second order; where a held stress bends the path of strains at yield its digits scatter, but fall
// all the same.
TEST(ModifiedCamClay, ErrorsFallWithTheStep) {
  for (std::size_t i = 0; i < references().size(); ++i) {
    const Reference& r = references()[i];
    const auto law = clay(r.ocr, r.more);
    const auto state = [&](int steps) { return state_of(driven(*law, r.path, r.strain, steps)); };
    const Vector4 coarse = state(100), fine = state(800);
    EXPECT_GE(std::log2(error_of(r, coarse) / error_of(r, fine)) / 3.0, 0.95) << i;
    const Vector4 finest = state(1600);
    EXPECT_LE(error_of(r, (4.0 * finest - fine) / 3.0), 1e-6) << i;
  }
}

// K0 of normal compression: 2 eta Lambda/(M^2 - eta^2) + 2 (1 + nu) eta kappa/(9 (1 - 2 nu) lambda) = 2/3.
TEST(ModifiedCamClay, NormalCompressionAtRest) {
  const PointDriver<4> point = driven(*clay(1.0), Path::oedometer, 0.4, 400);
  EXPECT_NEAR(point.sigma()[0] / point.sigma()[1], 0.647629220856, 1e-6);
}

// Undrained paths end at p_f = p0^(kappa/lambda) (p_c0/2)^(1 - kappa/lambda), whatever the path, shape and G.
TEST(ModifiedCamClay, UndrainedCriticalState) {
  for (const double ocr : {1.0, 2.0, 8.0})
    for (const double shape : {0.0, 1.0, 2.0})
      for (const double G : {0.0, 3000.0})
        for (const double sign : {1.0, -1.0}) {
          const auto law = clay(ocr, {shape, 0.0, G});
          const double p = kStart * std::pow(0.5 * ocr, kIrreversible);
          const PointDriver<4> point = driven(*law, Path::undrained, sign, 400);
          const Vector4 s = -point.sigma();
          EXPECT_NEAR(s.head<3>().mean(), p, 2e-4 * p) << ocr << shape << G << sign;
          const double M = shape > 0.0 && sign < 0.0 ? 6.0 / 7.0 : kM;  // 30 degrees of friction
          EXPECT_NEAR(s[1] - s[0], sign * M * p, 2e-4 * M * p) << ocr << shape << G << sign;
        }
}

// Plane strain: s_u = M p_f/sqrt 3 with the circle; values of the other shapes by the Runge-Kutta method.
TEST(ModifiedCamClay, UndrainedStrengthInPlaneStrain) {
  const double expected[] = {39.7920782685, 31.859154655, 31.901190511};
  for (int shape = 0; shape < 3; ++shape) {
    const auto law = clay(1.0, {static_cast<double>(shape)});
    const PointDriver<4> point = driven(*law, Path::plane_undrained, 0.2, 800);
    EXPECT_NEAR(0.5 * (point.sigma()[0] - point.sigma()[1]), expected[shape], 1e-6 * expected[shape]) << shape;
  }
  for (const double ocr : {2.0, 8.0}) {
    const PointDriver<4> point = driven(*clay(ocr), Path::plane_undrained, 0.5, 800);
    const double s_u = kM / std::sqrt(3.0) * kStart * std::pow(0.5 * ocr, kIrreversible);
    EXPECT_NEAR(0.5 * (point.sigma()[0] - point.sigma()[1]), s_u, 1e-6 * s_u) << ocr;
  }
}

// Drained shear of heavily overconsolidated clay: elastic up to the peak at yield, softening behind it.
TEST(ModifiedCamClay, PeakOfTheDrySide) {
  const auto law = clay(8.0);
  PointDriver<4> point = driven(*law, Path::drained, 0.0454124064, 50);
  double q = point.sigma()[0] - point.sigma()[1];
  EXPECT_NEAR(q, 443.9922379395, 1e-6);
  EXPECT_NEAR(point.stress_level(), 1.0, 1e-7);
  for (int i = 0; i < 20; ++i) {
    point.advance({Control::stress, Control::strain, Control::stress, Control::strain},
                  {-kStart, -1e-3, -kStart, 0.0});
    EXPECT_LT(point.sigma()[0] - point.sigma()[1], q) << i;
    q = point.sigma()[0] - point.sigma()[1];
  }
}

// +dp, +dq, -dp, -dq within the surface: constant nu leaves eps_q = dq/3 (1/G(p + dp) - 1/G(p)), constant G nothing.
TEST(ModifiedCamClay, ElasticLoop) {
  for (const double G : {0.0, 3000.0}) {
    const auto law = clay(4.0, {0.0, 0.0, G});
    PointDriver<4> point(*law, kIsotropic);
    for (const auto& [p, q] : {std::pair{150.0, 0.0}, {150.0, 30.0}, {100.0, 30.0}, {100.0, 0.0}})
      point.advance({Control::stress, Control::stress, Control::stress, Control::strain},
                    {-(p - q / 3), -(p + 2 * q / 3), -(p - q / 3), 0.0});
    const double shear = kKappa / kV / (1.5 * (1 - 2 * kNu) / (1 + kNu));  // p/G
    const double left = G > 0.0 ? 0.0 : 30.0 / 3.0 * shear * (1.0 / 150.0 - 1.0 / 100.0);
    EXPECT_NEAR(-2.0 / 3.0 * (point.eps()[1] - point.eps()[0]), left, 1e-14);
    EXPECT_NEAR(point.eps().head<3>().sum(), 0.0, 1e-15);
  }
}

// Isotropic compression follows the lines: exp(eps_v/kappa*) up to p_c, exp(eps_v/lambda*) from there, in one step each.
TEST(ModifiedCamClay, IsotropicLines) {
  const auto law = clay(2.0);
  PointDriver<4> point(*law, kIsotropic);
  const auto compress = [&](double volume) {
    const double e = -volume / 3.0;
    point.advance({Control::strain, Control::strain, Control::strain, Control::strain}, {e, e, e, 0.0});
    return -point.sigma().head<3>().mean();
  };
  const double to_yield = kKappa / kV * std::log(2.0);
  EXPECT_NEAR(compress(0.5 * to_yield), 100 * std::sqrt(2.0), 1e-10);
  EXPECT_EQ(point.status(), PointStatus::elastic);
  EXPECT_NEAR(compress(0.5 * to_yield + 0.1), 200 * std::exp(0.1 * kV / kLambda), 1e-9);
  EXPECT_EQ(point.status(), PointStatus::yielded);
  EXPECT_NEAR(point.history()[0], 200 * std::exp(0.1 * kV / kLambda), 1e-9);
  const double before = -point.sigma().head<3>().mean();
  EXPECT_NEAR(compress(-0.02), before * std::exp(-0.02 * kV / kKappa), 1e-9);
}

// With the current specific volume: v = v0 exp(-eps_v), and v0 - lambda ln p on the normal compression line.
TEST(ModifiedCamClay, CurrentVolumeStaysOnTheLine) {
  const auto law = clay(1.0, {0.0, 1.0});
  PointDriver<4> point(*law, kIsotropic);
  for (int i = 0; i < 50; ++i)
    point.advance({Control::strain, Control::strain, Control::strain, Control::strain},
                  {-1e-3, -1e-3, -1e-3, 0.0});
  const double v = kV * std::exp(-0.15), p = -point.sigma().head<3>().mean();
  EXPECT_NEAR(point.history()[1], v, 1e-14);
  EXPECT_NEAR(kV - kLambda * std::log(p / kStart), v, 1e-12);
}

TEST(ModifiedCamClay, StartOfTheSurface) {
  const Vector4 stress(-60.0, -100.0, -60.0, 0.0);
  const double p = 220.0 / 3.0, size = p + 40.0 / kM * (40.0 / kM) / p;
  struct Start {
    bool carried, adjusted;
    double p_c;
  };
  const auto start = [&](double ocr, double pop, double p_c, const Vector4& sigma) -> Start {
    const auto law = test::solid(11, {kM, kLambda, kKappa, kV, kNu, ocr, pop, p_c});
    std::vector<double> h(5, std::nan(""));
    const bool carried = law->initialise(sigma, h);
    EXPECT_DOUBLE_EQ(h[2], 1e-4 * h[0]);
    return {carried, adjusts_start(*law, sigma), h[0]};
  };
  const auto expect = [](const Start& found, bool adjusted, double p_c) {
    EXPECT_TRUE(found.carried);
    EXPECT_EQ(found.adjusted, adjusted);
    EXPECT_DOUBLE_EQ(found.p_c, p_c);
  };
  expect(start(1.5, 0, 0, stress), false, 1.5 * size);
  expect(start(0, 25, 0, stress), false, size + 25);
  expect(start(0, 0, 150, stress), false, 150);
  expect(start(0, 0, 50, stress), true, size);
  EXPECT_FALSE(start(2, 0, 0, Vector4::Zero()).carried);
  EXPECT_FALSE(start(0, 0, 150, {10, 10, 10, 0}).carried);
}

// Isotropic, normally consolidated and then unloaded along the axis: elastic until the surface is met again.
TEST(ModifiedCamClay, UnloadingFromTheSurfaceIsElastic) {
  const auto law = clay(1.0);
  EXPECT_EQ(driven(*law, Path::drained, -.0074, 1).status(), PointStatus::elastic);
  const PointDriver<4> yielded = driven(*law, Path::drained, -.0074210003, 10);
  EXPECT_NEAR(yielded.sigma()[1] - yielded.sigma()[0], 41.379310345, 1e-5);
  EXPECT_EQ(driven(*law, Path::drained, -.00743, 10).status(), PointStatus::yielded);
}

// Any increment, from a state anywhere: an answer on the surface or inside it, or a refusal that leaves all as it was.
TEST(ModifiedCamClay, HugeIncrementsAndExtremeParameters) {
  std::mt19937 random(5);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int answered = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const double lambda = std::pow(10.0, between(-2.0, -0.3));
    const double part = std::pow(10.0, between(-6.0, -1.0));
    const double kappa = lambda * (trial % 3 == 0 ? 1.0 - part : trial % 3 == 1 ? part : between(0.05, 0.5));
    const auto law = test::solid(11, {between(0.4, 1.7), lambda, kappa, between(1.3, 4.0), between(0.0, 0.45),
                                      std::pow(10.0, between(0.0, 2.0)), 0, 0, double(trial % 3)});
    Vector4 sigma = std::pow(10.0, between(-2.0, 4.0)) * Vector4(-1, -1, -1, 0);
    std::vector<double> h = test::initial_history<4>(*law, sigma);
    for (int step = 0; step < 4; ++step) {
      const Vector4 deps = std::pow(10.0, between(-6.0, 1.0)) *
                           Vector4(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1));
      const auto a = test::update<4>(*law, sigma, deps, h);
      if (a.outcome != Outcome::ok) continue;
      ++answered;
      ASSERT_TRUE(a.sigma.allFinite() && a.D.allFinite());
      ASSERT_LE(law->stress_level(a.sigma, a.h), 1.0 + 1e-9);
      ASSERT_TRUE(law->accepts_history(a.sigma, a.h)) << trial;
      sigma = a.sigma;
      h = a.h;
    }
  }
  EXPECT_GE(answered, 5500);
}

// Beside normal compression a small shear strain gives a shear stress in proportion, however small it is.  The surface was
// followed to 1e-12 of p_c, and no deviator below that had a digit.
TEST(ModifiedCamClay, ASmallDeviatorKeepsItsDigits) {
  for (const double G : {0.0, 2000.0}) {
    const auto law = clay(1.0, {0.0, 0.0, G});
    const auto shear_of = [&](double gamma) {
      const Vector4 deps(-1e-3, -1e-3, -1e-3, gamma);
      return test::update<4>(*law, kIsotropic, deps, test::initial_history<4>(*law, kIsotropic)).sigma[3] /
             gamma;
    };
    const double stiffness = shear_of(1e-7);
    EXPECT_GT(stiffness, 0.0);
    for (const double gamma : {1e-9, 1e-11, 1e-13, 1e-15, 1e-20, 1e-60})
      EXPECT_NEAR(shear_of(gamma), stiffness, 1e-6 * stiffness) << G << ' ' << gamma;
  }
}

// A thousand loops of unloading and reloading leave the state where it was.
TEST(ModifiedCamClay, CyclesDoNotDrift) {
  const auto law = clay(1.0);
  PointDriver<4> point = driven(*law, Path::drained, 0.04, 20);
  const Vector4 sigma = point.sigma(), eps = point.eps();
  const double p_c = point.history()[0];
  for (int cycle = 0; cycle < 1000; ++cycle)
    for (const Vector4& target : {Vector4(-kStart, -105.0, -kStart, 0.0), sigma})
      point.advance({Control::stress, Control::stress, Control::stress, Control::strain}, target);
  EXPECT_LE((point.sigma() - sigma).norm(), 1e-9 * kStart);
  EXPECT_NEAR(point.history()[0], p_c, 1e-9 * p_c);
  EXPECT_LE((point.eps() - eps).norm(), 1e-11);
}

TEST(ModifiedCamClay, RefusesWhatCannotBeMeant) {
  const auto refused = [](int place, double value) {
    std::vector<double> values = parameters(2.0, {0, 0, 0, 1e-4});
    values[place] = value;
    EXPECT_THROW(test::solid(11, values), ParameterError) << place << " " << value;
  };
  for (const auto& [place, value] : {std::pair{0, 0.0},
                                     {0, 3.0},
                                     {1, 0.0},
                                     {1, 0.04},
                                     {2, 0.0},
                                     {2, 0.2},
                                     {3, 1.0},
                                     {4, 0.5},
                                     {5, 0.0},
                                     {5, 0.9},
                                     {5, -1.0},
                                     {6, 10.0},
                                     {7, 10.0},
                                     {7, -10.0},
                                     {8, 3.0},
                                     {9, 2.0},
                                     {10, -1.0},
                                     {11, 0.0},
                                     {11, 0.3}})
    refused(place, value);
  EXPECT_TRUE(test::solid(11, {1.9, 0.2, 0.04, 2, 0.3, 1, 0, 0, 1})->caution().empty());
  EXPECT_NE(test::solid(11, {2.4, 0.2, 0.04, 2, 0.3, 1, 0, 0, 2})->caution(), "");
}

}  // namespace
}  // namespace sage
