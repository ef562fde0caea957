// Parameters from curves of known ones.
#include "sage/drive/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "materials/register_materials.hpp"
#include "sage/drive/subject.hpp"
#include "sage/messages/error.hpp"

namespace sage::drive {
namespace {

const UnitSystem kKilopascal{"m", "kN", "kPa", 101.325, 9.81};

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue made;
    register_materials(made);
    return made;
  }();
  return all;
}

Subject subject(const std::string& text) {
  return subject_from(catalogue(), text, kKilopascal, 0.0, nullptr);
}

// The curve of `truth` as a measured one.
Measured measured_of(const Subject& truth, const std::string& test, double pressure,
                     const std::vector<double>& driven, const std::vector<std::string>& columns) {
  Measured measured{test + " at " + std::to_string(static_cast<int>(pressure)),
                    find_lab_test(test, 4),
                    false,
                    pressure,
                    driven,
                    {}};
  Path path{{pressure, pressure, pressure, 0.0}, {}};
  path.legs = legs_of(*measured.test, false, path.start, driven, 1);
  const Curve curve = follow(reference(make_law(truth)), kKilopascal, path);
  for (const std::string& column : columns) {
    std::vector<double> values = curve.find(column)->values;
    values.erase(values.begin());
    measured.responses.push_back({column, values});
  }
  return measured;
}

// The start of a problem: curves of `truth` at these pressures, as measured at `points` equal strains.
FitProblem problem_of(const Subject& truth, const Subject& start, const std::vector<double>& pressures,
                      const std::vector<std::string>& columns, int points = 12, double strain = 0.03) {
  FitProblem problem;
  problem.subject = start;
  problem.steps = points;
  std::vector<double> strains;
  for (int i = 1; i <= points; ++i) strains.push_back(strain * i / points);
  for (const double pressure : pressures)
    problem.curves.push_back(measured_of(truth, "triaxial_compression", pressure, strains, columns));
  return problem;
}

void set_free(FitProblem& problem, const std::vector<std::string>& names) {
  for (const std::string& name : names) problem.free.push_back(free_parameter_from(problem.subject, name));
}

// Two pressures, stress and volume: all five parameters of Mohr-Coulomb come back.
TEST(Fit, ExactCurvesGiveTheirParametersBack) {
  const Subject truth = subject("mohr_coulomb,E=2e4,nu=.3,c=5,phi=32,psi=6");
  FitProblem problem = problem_of(truth, subject("mohr_coulomb,E=1.5e4,nu=.2,c=8,phi=28,psi=3"), {50.0, 200.0},
                                  {"axial_deviator", "volume_strain"});
  set_free(problem, {"E", "nu", "c", "phi", "psi"});
  const FitResult result = fit(problem);
  EXPECT_TRUE(result.converged);
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_NEAR(result.values[k], truth.values[k], 1e-8 * truth.values[k]) << problem.free[k].name;
  EXPECT_LT(result.rms, 1e-9);
  EXPECT_TRUE(result.undetermined.empty());
  EXPECT_EQ(result.points, 48);
}

TEST(Fit, AHyperbolaGivesItsParametersBack) {
  const std::string fixed =
      "unload_number=600,poisson_G=.3,poisson_F=0,poisson_d=0,c=5,phi=33,modulus_exponent=.5";
  const Subject truth = subject("duncan_chang_1970,modulus_number=400,failure_ratio=.8," + fixed);
  FitProblem problem =
      problem_of(truth, subject("duncan_chang_1970,modulus_number=250,failure_ratio=.7," + fixed), {100.0},
                 {"axial_deviator"});
  set_free(problem, {"modulus_number=50:2000", "failure_ratio=.3:1"});
  const FitResult result = fit(problem);
  // The law divides its steps by their errors, and where it does so its answers jump by a part of their
  // tolerance: 1e-5.
  EXPECT_NEAR(result.values[0], 400.0, 400 * 1e-5);
  EXPECT_NEAR(result.values[1], 0.8, 0.8 * 1e-5);
}

// 1 % of noise with a fixed seed.  Of 30 such data sets 95 % should cover the truth; fewer than 80 % would be a wrong
// error, and errors ten times too large would cover it too, so that their size is compared with the scatter.
TEST(Fit, NoisyCurvesCoverTheTruthWithinTheirErrors) {
  const Subject truth = subject("mohr_coulomb,E=2e4,nu=.3,c=5,phi=32");
  std::mt19937 random(12);
  std::normal_distribution<double> noise(0.0, 1.0);
  const FitProblem clean =
      problem_of(truth, subject("mohr_coulomb,E=1.5e4,nu=.3,c=8,phi=28"), {50.0, 200.0}, {"axial_deviator"});
  double largest = 0.0;
  for (const double value : clean.curves[1].responses[0].values) largest = std::max(largest, value);
  constexpr int kSets = 30;
  std::array<int, 3> covered{};
  std::array<double, 3> scatter{}, stated{};
  for (int set = 0; set < kSets; ++set) {
    FitProblem problem = clean;
    for (Measured& curve : problem.curves)
      for (double& value : curve.responses[0].values) value += 0.01 * largest * noise(random);
    set_free(problem, {"E", "c", "phi"});
    const FitResult result = fit(problem);
    const double expected[] = {2e4, 5.0, 32.0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (result.low[k] <= expected[k] && expected[k] <= result.high[k]) ++covered[k];
      scatter[k] += std::pow(result.values[k] - expected[k], 2) / kSets;
      stated[k] += std::pow(result.standard_errors[k], 2) / kSets;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GE(covered[k], kSets * 8 / 10) << k;
    EXPECT_GT(std::sqrt(stated[k] / scatter[k]), 0.6) << k;
    EXPECT_LT(std::sqrt(stated[k] / scatter[k]), 1.7) << k;
  }
}

// One confining pressure gives one strength, from which c and phi can't both come.
TEST(Fit, CohesionAndFrictionFromOnePressureAreNamed) {
  FitProblem problem =
      problem_of(subject("mohr_coulomb,E=2e4,nu=.3,c=5,phi=32"),
                 subject("mohr_coulomb,E=1.5e4,nu=.3,c=8,phi=28"), {100.0}, {"axial_deviator"});
  set_free(problem, {"E", "c", "phi"});
  const FitResult result = fit(problem);
  ASSERT_EQ(result.undetermined.size(), 1u);
  ASSERT_EQ(result.undetermined[0].names, (std::vector<std::string>{"cohesion", "friction_angle"}))
      << fit_text(problem, result);
  // In opposite directions.
  EXPECT_LT(result.undetermined[0].shares[0] * result.undetermined[0].shares[1], 0.0);
  EXPECT_TRUE(std::isnan(result.standard_errors[1]));
  EXPECT_TRUE(std::isnan(result.standard_errors[2]));
  EXPECT_NEAR(result.values[0], 2e4, 2e4 * 1e-8);
  EXPECT_FALSE(std::isnan(result.standard_errors[0]));
  EXPECT_NE(fit_text(problem, result).find("can't tell apart: cohesion"), std::string::npos)
      << fit_text(problem, result);
  EXPECT_NE(fit_plot(problem, result).find("fitted less measured"), std::string::npos);
  // Where the fit ends with little cohesion a small change of the friction angle makes up for all of it.
  problem.subject = subject("mohr_coulomb,E=1.5e4,nu=.3,c=.01,phi=33");
  const FitResult little = fit(problem);
  ASSERT_LT(little.values[1], 1.0);
  ASSERT_EQ(little.undetermined.size(), 1u);
  EXPECT_EQ(little.undetermined[0].names, (std::vector<std::string>{"cohesion", "friction_angle"}))
      << fit_text(problem, little);
}

// What the curve leaves open stays at its start: rounding, here of the start's last digits, doesn't choose it.
TEST(Fit, WhatTheCurveLeavesOpenStaysAtItsStart) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> rounding(-1e-12, 1e-12);
  FitProblem problem =
      problem_of(subject("mohr_coulomb,E=2e4,nu=.3,c=5,phi=32"),
                 subject("mohr_coulomb,E=1.5e4,nu=.3,c=8,phi=28"), {100.0}, {"axial_deviator"});
  set_free(problem, {"E", "c", "phi"});
  const std::vector<double> start = problem.subject.values;
  for (int trial = 0; trial < 20; ++trial) {
    for (std::size_t k = 0; k < 4; ++k) problem.subject.values[k] = start[k] * (1.0 + rounding(random));
    const FitResult result = fit(problem);
    EXPECT_NEAR(result.values[1], 8.0, 0.05) << "cohesion";
    // The strength of the curve: 2 c cos(phi) + 2 x 100 sin(phi), over 1 - sin(phi), is that of c = 5, phi = 32.
    const double phi = result.values[2] * std::numbers::pi / 180.0;
    const double strength =
        (2.0 * result.values[1] * std::cos(phi) + 200.0 * std::sin(phi)) / (1.0 - std::sin(phi));
    EXPECT_NEAR(strength, 243.49930788, 243.5e-6);
  }
}

// An oedometer test with an unloading and a drained triaxial test together: slopes, M and p_c of Cam clay.
TEST(Fit, CamClayFromTwoKindsOfTests) {
  const std::string rest = ",specific_volume=2,nu=.3";
  const Subject truth = subject("modified_cam_clay,M=1.1,lambda=.2,kappa=.04,p_c=180" + rest);
  FitProblem problem;
  problem.subject = subject("modified_cam_clay,M=.9,lambda=.15,kappa=.05,p_c=130" + rest);
  problem.steps = 12;
  problem.curves.push_back(measured_of(
      truth, "oedometer", 50.0, {.01, .02, .03, .04, .06, .08, .075, .07, .065, .07, .08, .1}, {"stress_yy"}));
  problem.curves.push_back(measured_of(truth, "triaxial_compression", 100.0,
                                       {.005, .01, .015, .02, .03, .04, .05, .06, .08, .1, .12, .15},
                                       {"axial_deviator", "volume_strain"}));
  set_free(problem, {"M", "lambda", "kappa", "p_c"});
  const FitResult result = fit(problem);
  EXPECT_TRUE(result.converged);
  const double expected[] = {1.1, .2, .04, 180.0};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(result.values[k], expected[k], 1e-5 * expected[k]) << k;
  const std::string plot = fit_plot(problem, result);
  EXPECT_NE(plot.find("stress yy"), std::string::npos);
  EXPECT_NE(plot.find("volume strain"), std::string::npos);
}

// Poisson's ratio says nothing about the deviator.
TEST(Fit, AParameterWithoutInfluenceIsNamed) {
  FitProblem problem = problem_of(subject("linear_elastic,E=2e4,nu=.3"),
                                  subject("linear_elastic,E=1.5e4,nu=.2"), {100.0}, {"axial_deviator"});
  set_free(problem, {"E", "nu"});
  const FitResult result = fit(problem);
  ASSERT_EQ(result.undetermined.size(), 1u);
  EXPECT_EQ(result.undetermined[0].names, (std::vector<std::string>{"poissons_ratio"}));
}

TEST(Fit, AValueAtItsBoundIsSaid) {
  FitProblem problem = problem_of(subject("linear_elastic,E=2e4,nu=.3"), subject("linear_elastic,E=1e4,nu=.3"),
                                  {100.0}, {"axial_deviator"});
  set_free(problem, {"E=5e3:1.5e4"});
  const FitResult result = fit(problem);
  EXPECT_TRUE(result.at_bound[0]);
  EXPECT_NEAR(result.values[0], 1.5e4, 1.0);
  EXPECT_NE(fit_text(problem, result).find("at its bound"), std::string::npos);
}

TEST(Fit, RefusesWhatHasNoAnswer) {
  const auto refusal = [](FitProblem& problem) -> std::string {
    try {
      fit(problem);
    } catch (const InputError& error) {
      return error.diagnostics().list().front().message;
    }
    return "";
  };
  const Subject elastic = subject("linear_elastic,E=2e4,nu=.3");
  FitProblem few = problem_of(elastic, elastic, {100.0}, {"axial_deviator"}, 2);
  EXPECT_NE(refusal(few).find("which parameters"), std::string::npos);
  set_free(few, {"E", "nu"});
  EXPECT_NE(refusal(few).find("2 measured values can't give 2 parameters"), std::string::npos);
  set_free(few, {"E"});
  EXPECT_NE(refusal(few).find("youngs_modulus is free twice"), std::string::npos);
  FitProblem wrong = problem_of(elastic, elastic, {100.0}, {"axial_deviator"});
  wrong.curves[0].responses[0].column = "q";
  set_free(wrong, {"E"});
  EXPECT_NE(refusal(wrong).find("column q: the law's curve has leg, step"), std::string::npos);
  EXPECT_THROW(free_parameter_from(elastic, "G"), InputError);
  EXPECT_THROW(free_parameter_from(elastic, "E=1"), InputError);
  EXPECT_THROW(free_parameter_from(elastic, "E=2:1"), InputError);
  EXPECT_THROW(free_parameter_from(elastic, "E=1:2"), InputError);
}

}  // namespace
}  // namespace sage::drive
