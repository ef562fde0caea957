// Laws along a laboratory's paths, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/register_materials.hpp"
#include "sage/drive/curve_files.hpp"
#include "sage/drive/subject.hpp"
#include "sage/messages/error.hpp"

namespace sage::drive {
namespace {

constexpr double kDegree = kPi / 180.0;
const UnitSystem kKilopascal{"m", "kN", "kPa", 101.325, 9.81};

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue made;
    register_materials(made);
    return made;
  }();
  return all;
}

struct Asked {
  std::string law, test;
  double pressure = 100.0;
  std::vector<double> turns{};
  bool undrained = false;
  int steps = 20;
  double normal_stiffness = 0.0;
};

Curve curve_of(const Asked& asked) {
  const Subject subject = subject_from(catalogue(), asked.law, kKilopascal, asked.pressure, nullptr);
  const int size = subject.entry->law_size;
  const LabTest* test = find_lab_test(asked.test, size);
  Path path;
  path.start = size == 4 ? std::vector<double>{asked.pressure, asked.pressure, asked.pressure, 0.0}
                         : std::vector<double>{0.0, asked.pressure};
  path.legs = legs_of(*test, asked.undrained, path.start, asked.turns, asked.steps);
  path.normal_stiffness = asked.normal_stiffness;
  if (asked.undrained && size == 4) path.total_stress_stays = test->total_stress_stays;
  return follow(reference(make_law(subject)), kKilopascal, path);
}

double end_of(const Curve& curve, std::string_view column) {
  return curve.find(column)->values.back();
}

const char* const kElastic = "linear_elastic,E=20000,nu=0.3";

// Rounding of a few solves: 1e-12.
TEST(Drive, ElasticTestsGiveTheirModuli) {
  const double E = 2e4, nu = 0.3, e = 0.01, oedometric = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const Curve triaxial = curve_of({kElastic, "triaxial_compression", 100.0, {e}});
  EXPECT_NEAR(end_of(triaxial, "axial_deviator"), E * e, 1e-12 * E * e);
  EXPECT_NEAR(end_of(triaxial, "volume_strain"), (1 - 2 * nu) * e, 1e-12 * e);
  EXPECT_NEAR(end_of(triaxial, "stress_xx"), 100.0, 1e-9);
  EXPECT_EQ(triaxial.rows(), 21u);
  const Curve extension = curve_of({kElastic, "triaxial_extension", 100.0, {e}});
  EXPECT_NEAR(end_of(extension, "axial_deviator"), -E * e, 1e-12 * E * e);
  const Curve oedometer = curve_of({kElastic, "oedometer", 0.0, {e}});
  EXPECT_NEAR(end_of(oedometer, "stress_yy"), oedometric * e, 1e-12 * E * e);
  EXPECT_NEAR(end_of(oedometer, "stress_xx"), nu / (1 - nu) * oedometric * e, 1e-12 * E * e);
  const Curve isotropic = curve_of({kElastic, "isotropic", 100.0, {400.0}});
  EXPECT_NEAR(end_of(isotropic, "volume_strain"), 300.0 * 3 * (1 - 2 * nu) / E, 1e-14);
  const Curve biaxial = curve_of({kElastic, "biaxial", 100.0, {e}});
  EXPECT_NEAR(end_of(biaxial, "axial_deviator"), E / (1 - nu * nu) * e, 1e-12 * E * e);
  const Curve shear = curve_of({kElastic, "simple_shear", 100.0, {e}});
  EXPECT_NEAR(end_of(shear, "stress_xy"), E / (2 * (1 + nu)) * e, 1e-12 * E * e);
}

// Elastic without volume change: p stays, q = 3 G eps_yy, so u = p_total - p = q/3 in compression.
TEST(Drive, UndrainedTestsKeepTheVolumeAndGiveThePorePressure) {
  const double E = 2e4, nu = 0.3, e = 0.01, G = E / (2 * (1 + nu));
  const Curve triaxial = curve_of({kElastic, "triaxial_compression", 100.0, {e}, true});
  EXPECT_NEAR(end_of(triaxial, "axial_deviator"), 3 * G * e, 1e-10);
  EXPECT_NEAR(end_of(triaxial, "volume_strain"), 0.0, 1e-16);
  EXPECT_NEAR(end_of(triaxial, "pore_pressure"), G * e, 1e-10);
  // Plane strain: s_yy - s_xx = 4 G e, the mean of both stays.
  const Curve biaxial = curve_of({kElastic, "biaxial", 100.0, {e}, true});
  EXPECT_NEAR(end_of(biaxial, "pore_pressure"), 2 * G * e, 1e-10);
  const Curve shear = curve_of({kElastic, "simple_shear", 100.0, {e}, true});
  EXPECT_EQ(end_of(shear, "pore_pressure"), 0.0);
  EXPECT_EQ(triaxial.find("pore_pressure")->unit, "kPa");
  EXPECT_EQ(curve_of({kElastic, "triaxial_compression", 100.0, {e}}).find("pore_pressure"), nullptr);
}

// Peaks of a perfectly plastic point are reached exactly in drained compression; elsewhere by flow: 1e-6.
TEST(Drive, StrengthsOfDruckerPragerAndMohrCoulomb) {
  const double s = std::sin(30 * kDegree), c = 5.0, p = 100.0;
  const double N = (1 + s) / (1 - s), compression = p * (N - 1) + 2 * c * std::sqrt(N);
  const double extension = -(p * (1 - 1 / N) + 2 * c / std::sqrt(N));
  for (const std::string law : {"drucker_prager", "mohr_coulomb"}) {
    const Curve curve = curve_of({law + ",E=2e4,nu=.3,c=5,phi=30", "triaxial_compression", p, {0.1}});
    EXPECT_NEAR(end_of(curve, "axial_deviator"), compression, 1e-9 * compression) << law;
    EXPECT_EQ(curve.status.back(), PointStatus::yielded);
  }
  const Curve mohr = curve_of({"mohr_coulomb,E=2e4,nu=.3,c=5,phi=30", "triaxial_extension", p, {0.1}});
  EXPECT_NEAR(end_of(mohr, "axial_deviator"), extension, 1e-9 * p);
  // The cone of triaxial compression in extension: q = M p, M = 6 s/(3 - s), so q = 3 M sigma_c/(3 + M).
  const double M = 6 * s / (3 - s);
  const Curve cone = curve_of({"drucker_prager,E=2e4,nu=.3,c=0,phi=30", "triaxial_extension", p, {0.1}});
  EXPECT_NEAR(end_of(cone, "axial_deviator"), -3 * M * p / (3 + M), 1e-6 * p);
  // Plane strain of the cone, no volume change at failure: sin phi* = 3 alpha.
  const double alpha = 2 * s / (std::sqrt(3.0) * (3 - s)), sine = 3 * alpha;
  const Curve plane =
      curve_of({"drucker_prager,E=1e5,nu=.3,c=0,phi=30,psi=0,flow=1", "biaxial", p, {1.0}, false, 200});
  EXPECT_NEAR(end_of(plane, "axial_deviator"), p * 2 * sine / (1 - sine), 1e-6 * p);
}

// Dilation at collapse in triaxial compression: d eps_v / d eps_1 = 1 - M, M = (1 + sin psi)/(1 - sin psi).
// Simple shear at collapse: no extension along x, so tan phi_ds = sin phi cos psi/(1 - sin phi sin psi)
// [Davis 1968].
TEST(Drive, DilationAndFrictionOfASimpleShear) {
  const double phi = 35 * kDegree, psi = 10 * kDegree, M = (1 + std::sin(psi)) / (1 - std::sin(psi));
  const Curve triaxial =
      curve_of({"mohr_coulomb,E=2e4,nu=.3,c=0,phi=35,psi=10", "triaxial_compression", 100.0, {0.1}});
  const std::vector<double>& volume = triaxial.find("volume_strain")->values;
  const double rate = (volume[20] - volume[19]) / (0.1 / 20);
  EXPECT_NEAR(rate, 1.0 - M, 1e-10);
  const Curve shear =
      curve_of({"mohr_coulomb,E=2e4,nu=.3,c=0,phi=35,psi=10", "simple_shear", 100.0, {1.0}, false, 200});
  const double ratio = std::sin(phi) * std::cos(psi) / (1 - std::sin(phi) * std::sin(psi));
  EXPECT_NEAR(end_of(shear, "stress_xy") / end_of(shear, "stress_yy"), ratio, 1e-6);
  // The zone between the halves of a box, likewise.
  const Curve box =
      curve_of({"mohr_coulomb,E=2e4,nu=.3,c=0,phi=35,psi=10", "direct_shear", 100.0, {1.0}, false, 200});
  EXPECT_NEAR(end_of(box, "stress_xy") / end_of(box, "stress_yy"), ratio, 1e-6);
}

// q = eps/(1/E_i + eps R_f/q_f), E_i = K p_a (sigma_3/p_a)^n (Duncan & Chang 1970); the law's substeps are good to
// 2e-3.
TEST(Drive, HyperbolaOfDuncanAndChang) {
  const double p_a = 101.325, sigma3 = 100.0, phi = 33 * kDegree, c = 5.0, R_f = 0.8;
  const double E_i = 400 * p_a * std::sqrt(sigma3 / p_a);
  const double q_f = (2 * c * std::cos(phi) + 2 * sigma3 * std::sin(phi)) / (1 - std::sin(phi));
  const Curve curve =
      curve_of({"duncan_chang_1970,modulus_number=400,modulus_exponent=.5,failure_ratio=.8,unload_number=600,"
                "poisson_G=.3,"
                "poisson_F=0,poisson_d=0,c=5,phi=33",
                "triaxial_compression",
                sigma3,
                {0.02},
                false,
                80});
  for (std::size_t row : {20u, 40u, 80u}) {
    const double strain = curve.find("strain_yy")->values[row];
    const double q = strain / (1 / E_i + strain * R_f / q_f);
    EXPECT_NEAR(curve.find("axial_deviator")->values[row], q, 2e-3 * q) << strain;
  }
}

// Goodman: constant stiffness.  Clough and Duncan at constant normal stress with the exact rule:
// tau = w/(1/k_i + R_f w/tau_f), k_i = k_j gamma_w (sigma_n/p_a)^n.
TEST(Drive, JointsSheared) {
  const Curve goodman =
      curve_of({"goodman,shear_stiffness=2e4,normal_stiffness=1e6", "direct_shear", 50.0, {1e-3}});
  EXPECT_NEAR(end_of(goodman, "shear"), 20.0, 1e-10);
  EXPECT_NEAR(end_of(goodman, "normal"), 50.0, 1e-10);
  EXPECT_EQ(goodman.find("relative_shear")->unit, "m");
  const Curve closed = curve_of({"goodman,shear_stiffness=2e4,normal_stiffness=1e6", "closure", 50.0, {1e-5}});
  EXPECT_NEAR(end_of(closed, "normal"), 60.0, 1e-9);
  const std::string law =
      "clough_duncan,c=0,phi=30,tensile_strength=0,failure_ratio=.85,stiffness_number=5000,stiffness_exponent=."
      "7,"
      "compressive_stiffness=1e6,tensile_stiffness=1e6,failure_stiffness=0,shear_rule=2";
  const Curve clough = curve_of({law, "direct_shear", 60.0, {2e-3}});
  const double k_i = 5000 * 9.81 * std::pow(60 / 101.325, 0.7), tau_f = 60 * std::tan(30 * kDegree);
  for (std::size_t row = 1; row < clough.rows(); ++row) {
    const double w = clough.find("relative_shear")->values[row];
    const double tau = std::min(w / (1 / k_i + 0.85 * w / tau_f), tau_f);
    EXPECT_NEAR(clough.find("shear")->values[row], tau, 1e-9 * tau_f) << w;
  }
}

// A joint that dilates by O = lambda tan psi: its pressure grows by K k_n/(K + k_n) O against a spring K, by k_n O where
// the normal displacement stays; tau = c + s tan phi, w = tau/k_s + lambda.
TEST(Drive, JointsAgainstASpringAndAtConstantVolume) {
  const double tan_phi = std::tan(30 * kDegree), tan_psi = std::tan(10 * kDegree), w = 4e-3;
  const std::string law = "dilating_joint,shear_stiffness=2e4,normal_stiffness=1e6,c=5,phi=30,psi=10";
  const auto pressure = [&](double stiffness) {
    const double growth = stiffness * tan_psi;
    return 60 + growth * (w - (5 + 60 * tan_phi) / 2e4) / (1 + growth * tan_phi / 2e4);
  };
  Asked spring{law, "direct_shear", 60.0, {w}};
  spring.normal_stiffness = 1e5;
  const Curve pushed = curve_of(spring);
  const double grown = pressure(1e5 * 1e6 / (1e5 + 1e6));
  EXPECT_NEAR(end_of(pushed, "normal"), grown, 1e-9 * grown);
  EXPECT_NEAR(end_of(pushed, "shear"), 5 + grown * tan_phi, 1e-9 * grown);
  EXPECT_NEAR(end_of(pushed, "normal") - 60, -1e5 * end_of(pushed, "relative_normal"), 1e-9 * grown);
  const Curve fixed = curve_of({law, "direct_shear", 60.0, {w}, true});
  EXPECT_NEAR(end_of(fixed, "normal"), pressure(1e6), 1e-9 * pressure(1e6));
  EXPECT_EQ(end_of(fixed, "relative_normal"), 0.0);
}

// Paths that turn: the elastic law comes back to where it was.
TEST(Drive, CyclesTurnWhereTheyAreToldTo) {
  const Curve curve = curve_of({kElastic, "simple_shear", 100.0, {0.01, -0.01, 0.0}, false, 4});
  ASSERT_EQ(curve.rows(), 13u);
  EXPECT_NEAR(curve.find("strain_xy")->values[4], 0.01, 1e-15);
  EXPECT_NEAR(curve.find("strain_xy")->values[8], -0.01, 1e-15);
  EXPECT_NEAR(end_of(curve, "stress_xy"), 0.0, 1e-10);
  EXPECT_EQ(curve.find("leg")->values[8], 2.0);
  EXPECT_EQ(curve.find("step")->values[8], 4.0);
}

// A stress beyond the strength: the curve ends at the strength, to the smallest part of a step, and says so.
TEST(Drive, APathThatCannotBeFollowedEndsWhereItStands) {
  const Subject subject =
      subject_from(catalogue(), "mohr_coulomb,E=2e4,nu=.3,c=0,phi=30", kKilopascal, 100.0, nullptr);
  Path path{{100, 100, 100, 0}, {}};
  path.legs.push_back({{{Control::stress, 100}, {Control::stress, 400}, {Control::stress, 100}, {}}, 10, 1.0});
  const Curve curve = follow(reference(make_law(subject)), kKilopascal, path);
  EXPECT_NE(curve.failure.find("leg 1, step 7 of 10"), std::string::npos) << curve.failure;
  EXPECT_NEAR(end_of(curve, "stress_yy"), 300.0, 30.0 / 1024);
  EXPECT_NE(csv_text({"t", {}, kKilopascal}, {curve}, 10).find("ends in leg 1"), std::string::npos);
  Path beyond = path;
  beyond.start = {100, 400, 100, 0};
  EXPECT_THROW(follow(reference(make_law(subject)), kKilopascal, beyond), InputError);
  beyond.start = {0, 100};
  EXPECT_THROW(follow(reference(make_law(subject)), kKilopascal, beyond), InputError);
}

TEST(Drive, SubjectsByNameCodeAndShortName) {
  const Subject a = subject_from(catalogue(), "soft clay:4,E=1e4,nu=0.3,c=+5,phi=20,psi=2,pressure=80",
                                 kKilopascal, 100.0, nullptr);
  EXPECT_EQ(a.name, "soft clay");
  EXPECT_EQ(a.pressure, 80.0);
  EXPECT_EQ(a.values, (std::vector<double>{1e4, 0.3, 5, 20, 2, -1}));
  const Subject b = subject_from(catalogue(), "stiff:,E=3e4", kKilopascal, 100.0, &a);
  EXPECT_EQ(b.values[0], 3e4);
  EXPECT_EQ(b.values[4], 2.0);
  EXPECT_NE(words_of(b).find("youngs_modulus = 30000 kPa"), std::string::npos) << words_of(b);
}

std::string refusal(const std::string& text) {
  try {
    subject_from(catalogue(), text, kKilopascal, 0.0, nullptr);
  } catch (const InputError& error) {
    return error.diagnostics().list().front().message;
  }
  return "";
}

TEST(Drive, RefusesWhatIsNoSubject) {
  const auto says = [](const std::string& text, const std::string& words) {
    EXPECT_NE(refusal(text).find(words), std::string::npos) << text << ": " << refusal(text);
  };
  says("elastic,E=1", "there is no law elastic");
  says("linear_elastic,E=1", "not set: poissons_ratio");
  says("linear_elastic,E=1,nu=.6", "must be below 0.5");
  says("linear_elastic,E=1,nu=x", "wanted a finite number");
  says("linear_elastic,E=1,nu", "wanted NAME=VALUE");
  says("linear_elastic,E=1,mu=.3", "has no parameter mu; it has youngs_modulus, poissons_ratio");
  says("a:,E=1", "wanted NAME:LAW");
  says(":linear_elastic,E=1,nu=.2", "wanted a name");
}

}  // namespace
}  // namespace sage::drive
