// Expected values: closed forms of triaxial and plane strain collapse, Krieg & Krieg and the constant-rate
// solution (its printed digits were checked against an eighth-order Runge-Kutta integration).
#include "materials/drucker_prager_four.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "materials/stress_measures.hpp"
#include "sage/core/point_driver.hpp"
#include "tests/support/laws.hpp"

namespace sage {
namespace {

const double kPhi35 = std::asin(0.6) / kRadiansPerDegree;  // 36.87 degrees: sin phi = 3/5

// E nu c phi psi cone flow
std::unique_ptr<SolidLaw> chapter_soil(double nu, double flow) {
  return test::solid(3, {3000.0, nu, 0.0, kPhi35, 0.0, 1.0, flow});
}

TEST(DruckerPrager, ChapterConstants) {
  const Cone cone = match_cone(ConeMatch::triaxial_compression, std::asin(0.6), 1.0);
  EXPECT_NEAR(cone.alpha, 1.0 / (2.0 * std::sqrt(3.0)), 1e-15);
  EXPECT_NEAR(cone.k, 6.0 * 0.8 / (std::sqrt(3.0) * 2.4), 1e-15);
}

// alpha and k of every match in closed form; sin phi = 3/5, cos phi = 4/5, tan phi = 3/4, c = 2.
TEST(DruckerPrager, ConesOfEveryMatch) {
  const double phi = std::asin(0.6), c = 2.0, root3 = std::sqrt(3.0), root = std::sqrt(15.75);
  const Cone extension = match_cone(ConeMatch::triaxial_extension, phi, c);
  EXPECT_NEAR(extension.alpha, 1.2 / (3.6 * root3), 1e-15);
  EXPECT_NEAR(extension.k, 9.6 / (3.6 * root3), 1e-15);
  for (const ConeMatch match : {ConeMatch::plane_strain_associated, ConeMatch::inner}) {
    const Cone cone = match_cone(match, phi, c);
    EXPECT_NEAR(cone.alpha, 0.75 / root, 1e-15);
    EXPECT_NEAR(cone.k, 6.0 / root, 1e-15);
  }
  const Cone deviatoric = match_cone(ConeMatch::plane_strain_deviatoric, phi, c);
  EXPECT_NEAR(deviatoric.alpha, 0.2, 1e-15);
  EXPECT_NEAR(deviatoric.k, 1.6, 1e-15);
}

// Four points, one in each branch: each ends where its closed form says.  K = 1e4, G = 2e3 kPa, alpha = k = 0.3
// and 3, flow without volume change, the apex holds the mean stress: 3.3333 = k / 3 alpha.
TEST(DruckerPrager, FourPointsEachInABranchOfItsOwn) {
  const DruckerPragerParameters parameters{{1e4, 2e3}, {0.3, 3.0}, 0.0, std::numeric_limits<double>::infinity(),
                                           false,      false};
  const DruckerPragerFour law(parameters);
  std::array<FourPointsIn<4>, 1> points{};
  std::array<FourPointsOut<4>, 1> answers;
  FourPointsIn<4>& in = points[0];
  FourPointsOut<4>& out = answers[0];
  const double gamma[kAbreast] = {1e-3, 1e-1, 0.0, 1e-1}, volume[kAbreast] = {0.0, 0.0, 1e-2, 1e-2};
  double h0[kAbreast][2] = {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}, {7.0, 8.0}}, h1[kAbreast][2];
  for (std::size_t l = 0; l < kAbreast; ++l) {
    for (std::size_t i = 0; i < 3; ++i) in.deps[i][l] = volume[l] / 3.0;
    in.deps[3][l] = gamma[l];
    in.h0[l] = h0[l];
    out.h1[l] = h1[l];
  }
  ASSERT_EQ(law.update_four(points, answers), Outcome::ok);
  // Elastic: tau = G gamma = 2.  Cone at p = 0: tau = k = 3.  Apex: p = k / 3 alpha, tau = 0.
  const double apex = 3.0 / 0.9, tau[kAbreast] = {2.0, 3.0, 0.0, 0.0}, p[kAbreast] = {0.0, 0.0, apex, apex};
  const PointStatus status[kAbreast] = {PointStatus::elastic, PointStatus::yielded, PointStatus::apex,
                                        PointStatus::apex};
  for (std::size_t l = 0; l < kAbreast; ++l) {
    EXPECT_EQ(out.status[l], status[l]) << l;
    EXPECT_NEAR(out.sigma[3][l], tau[l], 1e-12) << l;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(out.sigma[i][l], p[l], 1e-12) << l;
    EXPECT_NEAR(h1[l][0], h0[l][0] + gamma[l] - tau[l] / 2e3, 1e-14) << l;
    EXPECT_NEAR(h1[l][1], h0[l][1] + volume[l] - p[l] / 1e4, 1e-14) << l;
  }
  EXPECT_EQ(out.D[3][3][0], 2e3);
  EXPECT_NEAR(out.D[3][3][1], 0.0, 1e-9);  // perfectly plastic along the shear
}

TEST(DruckerPrager, InitialStressStartsTheHistory) {
  std::array<double, 2> h{7.0, 7.0};
  EXPECT_TRUE(chapter_soil(0.3, 1.0)->initialise({-50, -50, -50, 0}, h));
  EXPECT_EQ(h[0], 0.0);
  EXPECT_EQ(h[1], 0.0);
}

// Chapter: sigma_3 = 50, E = 3000, phi = 36.87: yields at 5 % with q = 150, then flows without volume change:
// eps_r = -nu eps_y - (eps_a - eps_y)/2.  Any number of steps.
TEST(DruckerPrager, TriaxialCompressionOfTheChapter) {
  for (const int steps : {1, 3, 100}) {
    const auto path = triaxial_test(*chapter_soil(0.3, 1.0), 50.0, 0.15, steps);
    EXPECT_NEAR(path.back().deviator, 150.0, 150.0 * 1e-10);
    EXPECT_NEAR(path.back().volume_strain, 0.05 * (1.0 - 2.0 * 0.3), 1e-10);
    EXPECT_EQ(path.back().status, PointStatus::yielded);
  }
  const auto before = triaxial_test(*chapter_soil(0.3, 1.0), 50.0, 0.0499999, 1);
  EXPECT_EQ(before.back().status, PointStatus::elastic);
}

// q_f = sigma_3 (K_p - 1) + 2 c sqrt(K_p).
TEST(DruckerPrager, StrengthWithCohesion) {
  const double phi = 25.0 * kRadiansPerDegree, Kp = (1 + std::sin(phi)) / (1 - std::sin(phi));
  const auto law = test::solid(3, {1e4, 0.3, 12.0, 25.0, 10.0});
  const double q = triaxial_test(*law, 80.0, 0.2, 20).back().deviator;
  EXPECT_NEAR(q, 80.0 * (Kp - 1) + 2 * 12.0 * std::sqrt(Kp), q * 1e-10);
}

// Extension with the compression cone: q = M p, sin phi_e = 3M/(6-M); phi = 20: 0.4430.  q is negative here.
TEST(DruckerPrager, TriaxialExtension) {
  const auto law = test::solid(3, {1e4, 0.3, 0.0, 20.0, 0.0, 1.0, 1.0});
  const double q = -triaxial_test(*law, 100.0, -0.2, 20).back().deviator;
  const double M = 6 * std::sin(20 * kRadiansPerDegree) / (3 - std::sin(20 * kRadiansPerDegree));
  EXPECT_NEAR(q / (200.0 - q), 3 * M / (6 - M), 1e-10);
  EXPECT_NEAR(3 * M / (6 - M), 0.4430, 5e-5);
}

// And the extension cone gives Mohr-Coulomb there.
TEST(DruckerPrager, ExtensionConeInExtension) {
  const auto law = test::solid(3, {1e4, 0.3, 0.0, 20.0, 0.0, 2.0, 1.0});
  const double q = -triaxial_test(*law, 100.0, -0.2, 20).back().deviator;
  EXPECT_NEAR(q / (200.0 - q), std::sin(20 * kRadiansPerDegree), 1e-10);
}

// Plane strain collapse at constant lateral stress: mobilised angle in the plane.
// sin phi* = 3 alpha sqrt(1-3 beta^2)/(1-3 alpha beta).
double plane_strain_angle(const std::vector<double>& values) {
  constexpr std::array<Control, 4> kPlane{Control::stress, Control::strain, Control::strain, Control::strain};
  const auto law = test::solid(3, values);
  PointDriver<4> point(*law, {-100.0, -100.0, -100.0, 0.0});
  for (int i = 0; i < 400; ++i) point.advance(kPlane, {-100.0, -0.0025, 0.0, 0.0});
  const double q = point.sigma()[0] - point.sigma()[1], sum = point.sigma()[0] + point.sigma()[1];
  return std::asin(-q / sum) / kRadiansPerDegree;
}
// 1e-3 degrees: sigma_zz approaches its collapse value asymptotically; 0.01 where only two decimals are known.
TEST(DruckerPrager, PlaneStrainCollapse) {
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 20, 0, 1, 1}), 26.47, 0.01);
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 20, 20, 1, 0}), 27.47, 0.01);
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 30, 0, 1, 1}), 43.85, 0.01);
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 30, 30, 3, 0}), 30.0, 1e-3);
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 30, 30, 5, 0}), 30.0, 1e-3);
  EXPECT_NEAR(plane_strain_angle({1e4, 0.3, 0, 30, 0, 4, 1}), 30.0, 1e-3);
}

// phi = 0: von Mises, and simple shear yields at tau = k; k = 2c/sqrt3 for the compression cone.
TEST(DruckerPrager, VonMisesInSimpleShear) {
  const auto law = test::solid(3, {3000.0, 0.3, 10.0, 0.0});
  const auto a = test::update<4>(*law, {-7.0, -7.0, -7.0, 0.0}, {0.0, 0.0, 0.0, 0.1}, {0.0, 0.0});
  EXPECT_NEAR(a.sigma[3], 20.0 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(a.sigma[0], -7.0, 1e-12);
  const double G = 3000.0 / 2.6;
  EXPECT_NEAR(a.h[0], 0.1 - a.sigma[3] / G, 1e-14);  // plastic shear strain = gamma - tau/G
  EXPECT_NEAR(a.h[1], 0.0, 1e-16);
}

// Dilation: d eps_v^p = 3 beta d gamma^p.
TEST(DruckerPrager, PlasticVolumeFollowsTheDilationAngle) {
  const auto law = test::solid(3, {3000.0, 0.3, 10.0, 30.0, 10.0});
  const double beta = match_cone(ConeMatch::triaxial_compression, 10.0 * kRadiansPerDegree, 0.0).alpha;
  const auto a = test::update<4>(*law, {-20, -20, -20, 0}, {0.0, -0.002, 0.0, 0.05}, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::yielded);
  EXPECT_NEAR(a.h[1], 3.0 * beta * a.h[0], 1e-14);
}

// Beyond the tip: p = k/(3 alpha), no deviator, for any dilation; the tangent keeps 1e-7 of the elastic one.
TEST(DruckerPrager, ApexForAnyDilation) {
  const double phi = 30.0 * kRadiansPerDegree;
  const Cone cone = match_cone(ConeMatch::triaxial_compression, phi, 10.0);
  for (const double psi : {0.0, 10.0, 30.0}) {
    const auto law = test::solid(3, {3000.0, 0.3, 10.0, 30.0, psi});
    const auto a = test::update<4>(*law, Vector4::Zero(), {0.1, 0.1, 0.09, 0.001}, {0.0, 0.0});
    EXPECT_EQ(a.status, PointStatus::apex);
    EXPECT_NEAR(mean_stress(a.sigma), cone.k / (3 * cone.alpha), 1e-12);
    EXPECT_LT(sqrt_j2(a.sigma), 1e-12);
    EXPECT_LT((a.D - 1e-7 * elastic_matrix(moduli_from_young(3000.0, 0.3))).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(law->stress_level(a.sigma, a.h), 1.0);
  }
}

// Without an apex: the mean stress stays elastic, p = K eps_v, and nothing else is left.
TEST(DruckerPrager, FreeMeanStress) {
  const auto law = test::solid(3, {3000.0, 0.3, 10.0, 30.0, 0.0, 1.0, 1.0, -1.0, 1.0});
  const auto a = test::update<4>(*law, Vector4::Zero(), {0.1, 0.1, 0.09, 0.001}, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::apex);
  EXPECT_NEAR(mean_stress(a.sigma), 2500.0 * 0.29, 1e-10);
  EXPECT_EQ(sqrt_j2(a.sigma), 0.0);
  EXPECT_NEAR(a.h[1], 0.0, 1e-16);
  // K 1 1^T, and 1e-7 of the elastic tangent
  const Matrix4 D = 2500.0 * unit_tensor() * unit_tensor().transpose();
  EXPECT_LT((a.D - D - 1e-7 * elastic_matrix(moduli_from_young(3000.0, 0.3))).norm(), 1e-11);
}

// Mean tension limit on a von Mises soil: uniaxial tension stretches until p = 2, the deviator is untouched.
TEST(DruckerPrager, MeanTensionLimit) {
  const auto law = test::solid(3, {3000.0, 0.25, 100.0, 0.0, 0.0, 1.0, 0.0, 2.0});
  const auto a = test::update<4>(*law, Vector4::Zero(), {0.01, 0.0, 0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::cut_off);
  EXPECT_NEAR(mean_stress(a.sigma), 2.0, 1e-13);
  EXPECT_NEAR(a.sigma[0] - a.sigma[1], 2.0 * 1200.0 * 0.01, 1e-12);
}

// Constant strain rate: G = 1000, nu = .3, alpha = .2, k = 10, p0 = -20, s0 along axis 1 on the surface,
// de = .02 (.3, .8, 0) in the (axis 1, orthogonal) deviatoric plane, d eps_v = -.004.
struct RateCase {
  double alpha, beta, R, p, psi;
};
class ConstantRate : public ::testing::TestWithParam<RateCase> {
 protected:
  // Deviatoric axes: (2,-1,-1)/sqrt6 and (0,1,-1)/sqrt2 in xx, yy, zz.
  Vector4 e1{2.0 / std::sqrt(6.0), -1.0 / std::sqrt(6.0), -1.0 / std::sqrt(6.0), 0.0};
  Vector4 e2{0.0, 1.0 / std::sqrt(2.0), -1.0 / std::sqrt(2.0), 0.0};

  Vector4 final_stress(const DruckerPragerParameters& p, int steps) const {
    const DruckerPrager law(p);
    Vector4 sigma = std::sqrt(2.0) * (p.cone.k + 60.0 * p.cone.alpha) * e1 - 20.0 * unit_tensor();
    const Vector4 deps = (0.02 * (0.3 * e1 + 0.8 * e2) - 0.004 / 3.0 * unit_tensor()) / steps;
    std::vector<double> h(2, 0.0);
    for (int i = 0; i < steps; ++i) {
      const auto a = test::update<4>(law, sigma, deps, h);
      sigma = a.sigma;
      h = a.h;
    }
    return sigma;
  }
  DruckerPragerParameters parameters(bool exact) const {
    const double G = 1000.0, K = 2.0 * G * 1.3 / (3.0 * 0.4);
    return {{K, G}, {GetParam().alpha, 10.0}, GetParam().beta, std::numeric_limits<double>::infinity(), exact,
            false};
  }
};

class ConstantRateNoDilation : public ConstantRate {};

// Radial return converges to the exact rate solution, first order: 1e-4 at 4000 steps.
TEST_P(ConstantRate, RadialReturnConverges) {
  const Vector4 sigma = final_stress(parameters(false), 4000), s = deviator(sigma);
  const double R = std::sqrt(contract(s, s));
  EXPECT_NEAR(R, GetParam().R, 1e-4 * GetParam().R);
  EXPECT_NEAR(mean_stress(sigma), GetParam().p, 1e-4 * std::abs(GetParam().p));
  const Vector4 rate = (0.3 * e1 + 0.8 * e2).normalized();
  EXPECT_NEAR(std::acos(contract(s, rate) / R), GetParam().psi, 2e-4);
}

// With beta = 0 the exact integration needs one step.  Ten digits are known.
TEST_P(ConstantRateNoDilation, ExactIntegrationInOneStep) {
  for (const int steps : {1, 3}) {
    const Vector4 sigma = final_stress(parameters(true), steps), s = deviator(sigma);
    const double R = std::sqrt(contract(s, s));
    const Vector4 rate = (0.3 * e1 + 0.8 * e2).normalized();
    EXPECT_NEAR(R, GetParam().R, 1e-8);
    EXPECT_NEAR(mean_stress(sigma), GetParam().p, 1e-8);
    EXPECT_NEAR(std::acos(contract(s, rate) / R), GetParam().psi, 1e-9);
  }
}
constexpr RateCase kFrictional{0.2, 0.0, 38.466608897, -28.66666667, 0.5059691287};
constexpr RateCase kFrictionless{0.0, 0.0, 14.142135624, -28.66666667, 0.1235068187};
INSTANTIATE_TEST_SUITE_P(Table, ConstantRate,
                         ::testing::Values(RateCase{0.2, 0.2, 45.268943836, -36.68329527, 0.5386025838},
                                           RateCase{0.2, 0.05, 41.025704081, -31.68258926, 0.5187885227},
                                           kFrictional, kFrictionless));
INSTANTIATE_TEST_SUITE_P(Table, ConstantRateNoDilation, ::testing::Values(kFrictional, kFrictionless));

// The exact integration must not depend on how the increment is divided; a wrong elastic part, or a fall back
// to radial return, would.  Each start and increment takes another branch.
void exact_in_any_number_of_steps(const Vector4& start, const Vector4& deps, double phi) {
  const auto law = test::solid(3, {3000.0, 0.3, 5.0, phi, 0.0, 1.0, 1.0, -1.0, 0.0, 1.0});
  const auto one = test::update<4>(*law, start, deps, {0.0, 0.0});
  EXPECT_EQ(one.status, PointStatus::yielded);
  test::Answer<4> many;
  many.sigma = start;
  many.h = {0.0, 0.0};
  for (int i = 0; i < 50; ++i) many = test::update<4>(*law, many.sigma, deps / 50, many.h);
  EXPECT_LT((one.sigma - many.sigma).norm(), 1e-10 * one.sigma.norm());
  const Matrix4 D = test::difference_tangent<4>(*law, start, deps, {0.0, 0.0}, 1e-6);
  EXPECT_LT((one.D - D).norm(), 1e-5 * D.norm());
}
// From inside the cone, and towards it from the first moment (s0:de > 0).
TEST(DruckerPrager, ExactIntegrationFromInside) {
  exact_in_any_number_of_steps({-30.0, -20.0, -25.0, 3.0}, {-0.04, 0.018, 0.016, 0.03}, 30.0);
}
// From inside, first away from the shear there is.
TEST(DruckerPrager, ExactIntegrationThroughTheAxis) {
  exact_in_any_number_of_steps({-30.0, -20.0, -25.0, 3.0}, {0.018, -0.04, 0.016, -0.03}, 30.0);
}
// From the cone, through its inside to the other side.
TEST(DruckerPrager, ExactIntegrationFromTheConeThroughTheInside) {
  const double k = 10.0 / std::sqrt(3.0);  // phi = 0, c = 5
  exact_in_any_number_of_steps({-20.0, -20.0, -20.0, k}, {0.01, -0.012, 0.0, -0.03}, 0.0);
}
// Compression that makes the radius of the cone more than twice as large.
TEST(DruckerPrager, ExactIntegrationWithAGrowingCone) {
  exact_in_any_number_of_steps({-5.0, -5.0, -5.0, 1.0}, {-0.03, 0.005, -0.005, 0.06}, 30.0);
}
// From the cone, with a shear rate inwards, but the cone shrinks faster: plastic from the start.
TEST(DruckerPrager, ExactIntegrationWithAShrinkingCone) {
  const Cone cone = match_cone(ConeMatch::triaxial_compression, 30.0 * kRadiansPerDegree, 5.0);
  const double tau = cone.k + 300.0 * cone.alpha;
  exact_in_any_number_of_steps({-100.0, -100.0, -100.0, tau}, {0.014, 0.008, 0.008, -0.025}, 30.0);
}

// Tension limit p_max = 5 on a cone with friction: both are reached, so p = 5 and sqrt(J2) = k - 3 alpha 5.
TEST(DruckerPrager, CornerOfConeAndTensionLimit) {
  const auto law = test::solid(3, {2e4, 0.3, 30.0, 20.0, 5.0, 1.0, 0.0, 5.0});
  const Cone cone = match_cone(ConeMatch::triaxial_compression, 20.0 * kRadiansPerDegree, 30.0);
  const Vector4 deps{0.004, 0.001, 0.002, 0.006};
  const auto a = test::update<4>(*law, Vector4::Zero(), deps, {0.0, 0.0});
  EXPECT_EQ(a.status, PointStatus::cut_off);
  EXPECT_NEAR(mean_stress(a.sigma), 5.0, 1e-12);
  EXPECT_NEAR(sqrt_j2(a.sigma), cone.k - 15.0 * cone.alpha, 1e-12);
  // 1e-7: central differences; the tangent keeps 1e-7 of the elastic one.
  const Matrix4 D = test::difference_tangent<4>(*law, Vector4::Zero(), deps, {0.0, 0.0}, 1e-7);
  const Matrix4 kept = 1e-7 * elastic_matrix(moduli_from_young(2e4, 0.3));
  EXPECT_LT((a.D - D - kept).norm(), 1e-7 * D.norm());
}

// Exactly at the tension limit: admissible, elastic until strained, and on the cone if only sheared.
TEST(DruckerPrager, AtTheTensionLimit) {
  const auto law = test::solid(3, {3000.0, 0.25, 10.0, 0.0, 0.0, 1.0, 0.0, 2.0});
  const Vector4 start{2.0, 2.0, 2.0, 0.0};
  std::array<double, 2> h{};
  EXPECT_TRUE(law->initialise(start, h));
  const auto still = test::update<4>(*law, start, Vector4::Zero(), {0.0, 0.0});
  EXPECT_EQ(still.status, PointStatus::elastic);
  EXPECT_EQ((still.D - elastic_matrix(moduli_from_young(3000.0, 0.25))).norm(), 0.0);
  const auto sheared = test::update<4>(*law, start, {0.0, 0.0, 0.0, 0.1}, {0.0, 0.0});
  EXPECT_EQ(sheared.status, PointStatus::yielded);
  EXPECT_NEAR(sheared.sigma[3], 20.0 / std::sqrt(3.0), 1e-12);
}

// sin phi = 3/5 puts triaxial extension on the cone at sigma_3 = 0.
TEST(DruckerPrager, CautionsAboutTheCone) {
  const auto caution = [](double c, double phi) {
    return test::solid(3, {3000.0, 0.3, c, phi, 0.0})->caution();
  };
  EXPECT_NE(caution(0.0, 0.0).find("no shear strength"), std::string::npos);
  EXPECT_NE(caution(1.0, kPhi35).find("tension limit"), std::string::npos);
  EXPECT_NE(caution(1.0, 40.0).find("tension limit"), std::string::npos);
  EXPECT_EQ(caution(1.0, 36.0), "");
  EXPECT_EQ(caution(1.0, 30.0), "");
  EXPECT_EQ(caution(0.0, 30.0), "");
  EXPECT_EQ(caution(1.0, 0.0), "");
}

TEST(DruckerPrager, SymmetricOnlyIfAssociated) {
  EXPECT_TRUE(test::solid(3, {3000, 0.3, 1, 30, 30})->traits().symmetric);
  EXPECT_TRUE(test::solid(3, {3000, 0.3, 1, 0, 0})->traits().symmetric);
  EXPECT_FALSE(test::solid(3, {3000, 0.3, 1, 30, 29})->traits().symmetric);
  EXPECT_FALSE(test::solid(3, {3000, 0.3, 1, 30, 30, 1, 1})->traits().symmetric);
}

TEST(DruckerPrager, InitialStressMustBeAdmissible) {
  const auto law = chapter_soil(0.3, 1.0);
  std::array<double, 2> h{};
  EXPECT_TRUE(law->initialise({-50, -199.9, -50, 0}, h));
  EXPECT_FALSE(law->initialise({-50, -201, -50, 0}, h));
  EXPECT_FALSE(law->initialise({1, 1, 1, 0}, h));
  EXPECT_NEAR(law->stress_level({-50, -200, -50, 0}, h), 1.0, 1e-12);
  EXPECT_NEAR(law->stress_level({-50, -125, -50, 0}, h), 75.0 / 225.0 / (150.0 / 300.0), 1e-12);
}

}  // namespace
}  // namespace sage
