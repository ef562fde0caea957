// Closed form at constant sigma_3: q = eps/(1/E_i + eps R_f/q_f); E_i = 40264.128, q_f = 257.62971.
#include "materials/duncan_chang.hpp"

#include <gtest/gtest.h>

#include "materials/stress_measures.hpp"
#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

const std::vector<double> kEb = {400, 0.5, 0.8, 600, 250, 0.3, 5, 33};
const std::vector<double> k1970 = {400, 0.5, 0.8, 600, 0.35, 0.05, 2.0, 5, 33};

struct Point {
  double strain, q;
};
constexpr Point kTable[] = {{0.001, 35.789399}, {0.005, 123.878397}, {0.010, 178.928255}, {0.020, 230.042010}};

double deviator(int code, const std::vector<double>& values, double strain, int steps) {
  return triaxial_test(*test::solid(code, values), 100.0, strain, steps).back().deviator;
}

// Fine steps give the printed digits; 1e-6 relative: the second-order error of 2000 steps is below that.
TEST(DuncanChang, HyperbolaOfTheTriaxialTest) {
  for (const Point& p : kTable) {
    EXPECT_NEAR(deviator(6, kEb, p.strain, 2000), p.q, 1e-6 * p.q);
    EXPECT_NEAR(deviator(5, k1970, p.strain, 2000), p.q, 1e-6 * p.q);
  }
}

// A straight strain path in one increment equals the same path in 100: the law finds its own
// substeps.  The tolerance (1e-3 by default) is on the Euler half of a substep; Heun's is smaller:
// 1e-4 here, 1e-6 for 1e-5.
TEST(DuncanChang, IncrementSizeDoesNotMatter) {
  std::vector<double> fine = kEb;
  fine.insert(fine.end(), {0.0, 0.49, 0.01, 0.0, 0.0, 1e-5});
  const Vector4 start{-100, -100, -100, 0}, deps{0.001, -0.003, 0.001, 0.0015};
  for (const auto& [values, tolerance] : {std::pair{kEb, 1e-4}, std::pair{fine, 1e-6}}) {
    const auto law = test::solid(6, values);
    const auto one = test::update<4>(*law, start, deps, test::initial_history<4>(*law, start));
    test::Answer<4> many = test::update<4>(*law, start, Vector4::Zero(), test::initial_history<4>(*law, start));
    for (int i = 0; i < 100; ++i) many = test::update<4>(*law, many.sigma, deps / 100, many.h);
    EXPECT_EQ(one.outcome, Outcome::ok);
    EXPECT_LT((one.sigma - many.sigma).norm(), tolerance * many.sigma.norm());
  }
}

// Turned axes turn the answer, and no more: the substeps measure stress as a tensor.  Rounding; 2e-4 where
// shear counts once.
TEST(DuncanChang, AxesDoNotMatter) {
  const double angle = 37.0 * kRadiansPerDegree, c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](const Vector4& a, double shear) {  // shear: 1 for stress, 2 for strain
    const double xx = a[0], yy = a[1], xy = a[3] / shear;
    return Vector4(c * c * xx + s * s * yy - 2 * c * s * xy, s * s * xx + c * c * yy + 2 * c * s * xy, a[2],
                   shear * (c * s * (xx - yy) + (c * c - s * s) * xy));
  };
  const Vector4 start{-110, -140, -100, 10}, deps{0.002, -0.006, 0.001, 0.004};
  for (const auto& [code, values] : {std::pair{5, k1970}, std::pair{6, kEb}, std::pair{7, kEb}}) {
    const auto law = test::solid(code, values);
    const auto update = [&](const Vector4& from, const Vector4& by) {
      return test::update<4>(*law, from, by, test::initial_history<4>(*law, from)).sigma;
    };
    const Vector4 plain = update(start, deps), other = update(turned(start, 1.0), turned(deps, 2.0));
    EXPECT_LT((other - turned(plain, 1.0)).norm(), 1e-12 * plain.norm()) << "law " << code;
  }
}

// In a triaxial test few increments mean a polygon of strain instead of the curved path of constant sigma_3,
// which no law can repair: second order in the number of increments.  10 are good to 0.2 %.
TEST(DuncanChang, FewIncrementsOfATriaxialTest) {
  for (const Point& p : kTable) EXPECT_NEAR(deviator(6, kEb, p.strain, 10), p.q, 2e-3 * p.q);
}

// B rules the volume: d p = B d eps_v while B is constant (m = 0): q/3 = B eps_v at constant sigma_3.
TEST(DuncanChang, VolumeFromTheBulkModulus) {
  std::vector<double> values = kEb;
  values[5] = 0.0;
  const auto path = triaxial_test(*test::solid(6, values), 100.0, 0.005, 100);
  EXPECT_NEAR(path.back().volume_strain, path.back().deviator / 3.0 / (250 * 101.325), 1e-9);
}

// Unload and reload: unloading ends with slope E_ur, reloading comes back to the
// hyperbola and goes on along it.
TEST(DuncanChang, UnloadReload) {
  constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress,
                                             Control::strain};
  const auto law = test::solid(6, kEb);
  PointDriver<4> point(*law, {-100, -100, -100, 0});
  const auto compress = [&](double strain, int steps) {
    for (int i = 0; i < steps; ++i) point.advance(kTriaxial, {-100.0, -strain / steps, -100.0, 0.0});
    return point.sigma()[0] - point.sigma()[1];
  };
  EXPECT_NEAR(compress(0.01, 200), 178.928255, 2e-3);
  // Unloaded past 3/4 of the highest level in 1e-3 of strain, then another 1e-4 with E_ur.
  const double before = compress(-0.002, 20);
  EXPECT_EQ(point.status(), PointStatus::unloading);
  const double after = compress(-1e-4, 1);
  const double E_ur = 600 * 101.325 * std::sqrt(100 / 101.325);
  EXPECT_NEAR((before - after) / 1e-4, E_ur, 1e-6 * E_ur);
  // Reload to the stress of before: the memory is reached with q = 178.93, and then primary loading goes on.
  double strain = 0.0, q = after;
  while (q < 178.928255 - 0.05) {
    q = compress(1e-5, 1);
    strain += 1e-5;
  }
  EXPECT_LT(strain, 0.0022);  // stiffer than first loading, which took 0.0055 for the same stress
  q = compress(0.005, 50);
  EXPECT_EQ(point.status(), PointStatus::elastic);
  const auto from = [](double stress) { return stress / 40264.128 / (1 - 0.8 * stress / 257.62971); };
  EXPECT_NEAR(q, (from(178.928255) + 0.005) / (1 / 40264.128 + (from(178.928255) + 0.005) * 0.8 / 257.62971),
              0.1);
}

// Newton on the consistent tangent: triaxial steps of 0.2 % (two unknown strains) converge within 6 iterations.
TEST(DuncanChang, ConsistentTangentConvergesQuickly) {
  constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress,
                                             Control::strain};
  const auto law = test::solid(6, kEb);
  PointDriver<4> point(*law, {-100, -100, -100, 0});
  for (int i = 0; i < 4; ++i) point.advance(kTriaxial, {-100.0, -0.002, -100.0, 0.0});
  EXPECT_EQ(point.steps(), 4);
  EXPECT_LE(point.iterations(), 4 * 6);
}

// The error that laws tell of an increment is what a triaxial test in one step shows, within a factor of 3;
// along a straight strain path there is none, but the law can't know that it was straight.  Without a surface:
// law 6.
TEST(DuncanChang, PathErrorIsThatOfOneStep) {
  const auto law = test::solid(6, kEb);
  const Vector4 start{-100, -100, -100, 0};
  const auto h = test::initial_history<4>(*law, start);
  for (const double strain : {0.0005, 0.001, 0.0015, 0.002}) {  // below kPathTolerance, so taken in one step
    constexpr std::array<Control, 4> kTriaxial{Control::stress, Control::strain, Control::stress,
                                               Control::strain};
    PointDriver<4> point(*law, start);
    point.advance(kTriaxial, {-100.0, -strain, -100.0, 0.0});
    ASSERT_EQ(point.steps(), 1);
    const auto many = triaxial_test(*law, 100.0, strain, 1000).back();
    const double error = (many.deviator - (point.sigma()[0] - point.sigma()[1])) / point.sigma().norm();
    const double stated =
        path_error<4>(*law, {start, Vector4::Zero(), point.eps(), h}, point.sigma(), point.history());
    EXPECT_GT(stated, error / 3) << strain;
    EXPECT_LT(stated, error * 3) << strain;
  }
}

// 3 a^2 |d sigma|/|sigma| with a = |K1-K0|/(4(K0+K1)) or the same of G, whichever is larger (H6).  Isotropic
// compression: E = E_i, and of E and B one is proportional to the stress, the other constant.
TEST(DuncanChang, PathErrorOfIsotropicCompression) {
  const double p0 = 50.0, p1 = 100.0, p_a = 101.325;
  const auto stated = [&](double n, double m) {
    const auto law = test::solid(6, {400, n, 0.8, 600, 500, m, 5, 33});
    return path_error<4>(*law,
                         {-p0 * unit_tensor(), Vector4::Zero(), Vector4::Zero(), std::vector<double>{0.0}},
                         -p1 * unit_tensor(), std::vector<double>{0.0});
  };
  const auto G = [](double E, double B) { return 3 * B * E / (9 * B - E); };
  const double lag_B = (p1 - p0) / (p1 + p0) / 4;
  EXPECT_NEAR(stated(0.0, 1.0), 3 * lag_B * lag_B * (p1 - p0) / p1, 1e-12);
  const double G0 = G(400 * p0, 500 * p_a), G1 = G(400 * p1, 500 * p_a), lag_G = (G1 - G0) / (G1 + G0) / 4;
  EXPECT_NEAR(stated(1.0, 0.0), 3 * lag_G * lag_G * (p1 - p0) / p1, 1e-12);
}

// The isotropic tangent is symmetric and is the secant of the step.
TEST(DuncanChang, IsotropicTangent) {
  std::vector<double> values = kEb;
  values.insert(values.end(), {0.0, 0.49, 0.01, 1.0});
  const auto law = test::solid(6, values);
  EXPECT_TRUE(law->traits().symmetric);
  const Vector4 start{-100, -150, -110, 10}, deps{0.001, -0.004, 0.0, 0.003};
  const auto a = test::update<4>(*law, start, deps, test::initial_history<4>(*law, start));
  EXPECT_EQ((a.D - a.D.transpose()).norm(), 0.0);
  EXPECT_LT((a.sigma - start - a.D * deps).norm(), 1e-10 * a.sigma.norm());
}

// Principals in the plane only: sigma_zz has no say.
TEST(DuncanChang, PrincipalsInThePlane) {
  std::vector<double> values = kEb;
  values.insert(values.end(), {0.0, 0.49, 0.01, 0.0, 1.0});
  const Vector4 sigma{-100, -200, -20, 0};
  EXPECT_NEAR(test::solid(6, values)->stress_level(sigma, {}), 100 / 257.62971, 1e-7);
  EXPECT_GT(test::solid(6, kEb)->stress_level(sigma, {}), 1.0);
}

TEST(DuncanChang, InitialStressMustBeAdmissible) {
  const auto law = test::solid(6, kEb);
  std::array<double, 1> h{};
  EXPECT_TRUE(law->initialise({-100, -357, -100, 0}, h));
  EXPECT_GT(h[0], 0.99);
  EXPECT_FALSE(law->initialise({-100, -358, -100, 0}, h));
  EXPECT_TRUE(law->initialise({0, 0, 0, 0}, h));
}

// Status cut_off says that sigma_3 is a tension; first loading in compression is elastic.
TEST(DuncanChang, TensionIsTold) {
  const auto law = test::solid(6, kEb);
  const Vector4 start{-20, -20, -20, 0}, stretch{0.01, 0.0, 0.0, 0.0};
  const auto h = test::initial_history<4>(*law, start);
  const auto torn = test::update<4>(*law, start, stretch, h),
             pressed = test::update<4>(*law, start, -0.1 * stretch, h);
  EXPECT_EQ(torn.outcome, Outcome::ok);
  EXPECT_GT(torn.sigma[0], 0.0);
  EXPECT_EQ(torn.status, PointStatus::cut_off);
  EXPECT_LT(pressed.sigma.head<3>().maxCoeff(), 0.0);
  EXPECT_EQ(pressed.status, PointStatus::elastic);
}

// 2000 % of strain in one increment or in a thousand; and an increment that needs more substeps than there are
// is refused.
TEST(DuncanChang, FollowsOrRefuses) {
  std::vector<double> values = kEb;
  const Vector4 start{-100, -100, -100, 0}, deps{10, -20, 3, 5};
  const auto law = test::solid(6, values);
  const auto one = test::update<4>(*law, start, deps, test::initial_history<4>(*law, start));
  test::Answer<4> many = test::update<4>(*law, start, Vector4::Zero(), test::initial_history<4>(*law, start));
  for (int i = 0; i < 1000; ++i) many = test::update<4>(*law, many.sigma, deps / 1000, many.h);
  EXPECT_EQ(one.outcome, Outcome::ok);
  EXPECT_LT((one.sigma - many.sigma).norm(), 1e-3 * many.sigma.norm());

  values.insert(values.end(), {0.0, 0.49, 0.01, 0.0, 0.0, 1e-9});
  const auto exact = test::solid(6, values);
  const auto refused = test::update<4>(*exact, start, deps, test::initial_history<4>(*exact, start));
  EXPECT_EQ(refused.outcome, Outcome::cut_step);
}

// Isotropic compression, B = K_b sqrt(p p_a): the volume strain for which the error of the first substep (half
// of Heun's against Euler's), shortened by 1/(sqrt(e)(3/4 + min(e, 2)/4)) in six trials, is still 4 tolerances,
// is the largest one that is answered.
TEST(DuncanChang, RefusesAnErrorOfFourTolerances) {
  const double p0 = 100.0, tolerance = 0.01;
  const auto B = [](double p) { return 250 * std::sqrt(p * 101.325); };
  const auto error_left = [&](double volume) {
    double share = 1.0, error = 0.0;
    for (int trial = 1; trial <= 6; ++trial) {
      const double mean = 0.5 * (B(p0) + B(p0 + share * B(p0) * volume));
      error = share * (mean - B(p0)) * volume / (tolerance * (p0 + share * mean * volume));
      if (error <= 1.0) break;
      if (trial < 6) share /= std::sqrt(error) * (0.75 + 0.25 * std::min(error, 2.0));
    }
    return error;
  };
  double least = 1.0, most = 1000.0;
  for (int i = 0; i < 60; ++i) (error_left(0.5 * (least + most)) < 4.0 ? least : most) = 0.5 * (least + most);
  ASSERT_NEAR(error_left(least), 4.0, 1e-6);

  const auto law = test::solid(6, {400, 0.5, 0.8, 600, 250, 0.5, 5, 33, 0, 0.49, 0.01, 0, 0, tolerance});
  const Vector4 start = -p0 * unit_tensor();
  const auto outcome = [&](double volume) {
    return test::update<4>(*law, start, -volume / 3.0 * unit_tensor(), {0.0}).outcome;
  };
  EXPECT_EQ(outcome(0.99 * least), Outcome::ok) << least;
  EXPECT_EQ(outcome(1.01 * least), Outcome::cut_step) << least;
}

// Along a line of increments, 1e-4 of it apart, the stress changes as the tangents say: to 1e-5 of the stress.
void expect_continuous(const SolidLaw& law, const Vector4& deps) {
  const Vector4 start{-100, -100, -100, 0};
  const auto h = test::initial_history<4>(law, start);
  test::Answer<4> last = test::update<4>(law, start, 0.05 * deps, h);
  for (int i = 501; i <= 10000; ++i) {
    const auto next = test::update<4>(law, start, 1e-4 * i * deps, h);
    const Vector4 predicted = last.sigma + 0.5e-4 * (last.D + next.D) * deps;
    EXPECT_LE((next.sigma - predicted).norm(), 1e-5 * next.sigma.norm()) << i;
    last = next;
  }
}

// The substeps do not make the stress jump, also where another one comes in: kinks at the surface leave 5e-6 of
// it, the number of equal substeps used to make it jump by 1e-4.
TEST(DuncanChang, StressIsContinuousInTheIncrement) {
  for (const int code : {6, 7}) {
    SCOPED_TRACE(code);
    expect_continuous(*test::solid(code, kEb), {0.012, -0.02, 0.009, 0.01});
  }
}

// The same with coarse substeps, whose errors are far above 1e-5: a substep that is shortened a little later or
// earlier than at its tolerance would show.
TEST(DuncanChang, CoarseSubstepsAreContinuousToo) {
  std::vector<double> coarse = kEb;
  coarse.insert(coarse.end(), {0.0, 0.49, 0.01, 0.0, 0.0, 0.05});
  expect_continuous(*test::solid(6, coarse), {0.004, -0.006, 0.003, 0.004});
}

}  // namespace
}  // namespace sage
