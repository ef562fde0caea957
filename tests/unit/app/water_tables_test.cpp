// Closed specimens between rough platens whose water is free to move.
#include "sage/app/water_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "sage/app/closed_specimen.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/input.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {

namespace {

constexpr double kNu = 0.2;

ClosedSpecimen elastic(double slenderness, int columns) {
  return {.slenderness = slenderness,
          .skeleton = {"linear_elastic", {{"youngs_modulus", 1.0}, {"poissons_ratio", kNu}}},
          .permeability = (1.0 + kNu) * (1.0 - 2.0 * kNu) / (1.0 - kNu),
          .columns = columns,
          .element = "quad9p4"};
}

// Ratios and pressures over those without friction, of a mixed spectral discretisation by an independent program: force
// when the water is shut in, and when it has one pressure.
TEST(ClosedSpecimen, ForceAndPressureOfAnElasticSkeleton) {
  struct Row {
    double slenderness, shut, equal, pressure;
  };
  for (const Row& row : {Row{1.0, 1.196271, 1.140501, 1.421504}, Row{2.0, 1.08861, 1.060955, 1.18287}}) {
    const SpecimenCurve curve = run_specimen(elastic(row.slenderness, row.slenderness > 1.0 ? 16 : 32),
                                             {{0.01, 0.0, 1}, {0.0, 1e5, 8}}, full_catalogue());
    ASSERT_EQ(curve.reason, "");
    const double correct = 3.0 / (2.0 * (1.0 + kNu)) * 0.01;
    EXPECT_NEAR(curve.states.front().deviator / correct, row.shut, 1e-4);
    const SpecimenState& last = curve.states.back();
    EXPECT_NEAR(last.deviator / correct, row.equal, 3e-5);
    for (const double pressure :
         {last.pressure_end, last.pressure_middle, last.pressure_rim, last.pressure_mean})
      EXPECT_NEAR(pressure / (correct / 3.0), row.pressure, 1e-4);
  }
}

// Pressures over the correct one when nothing has moved yet, at the platen's centre, the middle and its rim, extrapolated from two
// meshes by the second order.  Of another mixed program, whose mesh is graded to the rim of the platen: degrees 7 and 8, with
// continuous and with discontinuous pressures, agree within 2e-5 (docs/theory/closed_specimen.md).
TEST(ClosedSpecimen, FirstPressuresAreThoseOfAnotherDiscretisation) {
  const auto first = [](int columns) -> Eigen::Vector3d {
    const SpecimenCurve curve = run_specimen(elastic(1.0, columns), {{0.01, 0.0, 1}}, full_catalogue());
    EXPECT_EQ(curve.reason, "");
    const SpecimenState& state = curve.states.front();
    const double correct = 0.01 / (2.0 * (1.0 + kNu));
    return Eigen::Vector3d(state.pressure_end, state.pressure_middle, state.pressure_rim) / correct;
  };
  const Eigen::Vector3d expected(3.11968, 1.470644, 0.901877), coarse = first(16), fine = first(32);
  const Eigen::Vector3d limit = (4.0 * fine - coarse) / 3.0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(limit[i], expected[i], 3e-4 * expected[i]) << i;
    EXPECT_LT(std::abs(fine[i] - expected[i]), 0.35 * std::abs(coarse[i] - expected[i])) << i;
  }
}

// Undrained critical state: p_f = p0 (OCR/2)^(1 - kappa/lambda), q_f = M p_f; the total radial stress stays.
TEST(ClosedSpecimen, WithoutFrictionClayGoesToItsCriticalState) {
  for (const double ocr : {1.0, 2.0, 4.0}) {
    ClosedSpecimen specimen;
    specimen.skeleton = {"modified_cam_clay",
                         {{"M", 1.2},
                          {"lambda", 0.2},
                          {"kappa", 0.04},
                          {"specific_volume", 2.0},
                          {"poissons_ratio", 0.3},
                          {"ocr", ocr}}};
    specimen.cell = 100.0;
    const FrictionlessState last = frictionless_test(specimen, 1.0, 2000, full_catalogue()).back();
    const double p = 100.0 * std::pow(ocr / 2.0, 0.8);
    EXPECT_NEAR(last.deviator, 1.2 * p, 2e-3 * p) << ocr;
    EXPECT_NEAR(last.pressure, 100.0 + 0.4 * p - p, 2e-3 * p) << ocr;
  }
}

TEST(WaterTables, StateWhatTheyShowInFilesAndModels) {
  const std::filesystem::path folder = test::scratch_folder("water_tables");
  WaterStudy study;
  study.poissons_ratios = {kNu};
  study.slenderness = {1.0};
  study.ocr = {2.0};
  study.elastic = {6, 2, "quad8p4"};
  study.clay = {3, 2, "quad8p4"};
  testing::internal::CaptureStdout();
  print_water_tables(study, folder, full_catalogue());
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* words : {"0.200 1", "2    0.15", "T95"})
    EXPECT_NE(text.find(words), std::string::npos) << text;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.size() <= 80U || line.starts_with(folder.string())) << line;
  for (const char* name : {"closed_nu0.2_ld1.sage.toml", "closed_clay_ocr2.sage.toml"}) {
    const Model model = build_model(read_input((folder / name).string(), {}), full_catalogue());
    for (const Diagnostic& one : model.diagnostics.list())
      EXPECT_NE(one.severity, Severity::warning) << name << ": " << one.message;
    // What nobody wrote is worth no note: neither step nor columns of an element.
    EXPECT_EQ(std::ranges::count(model.diagnostics.list(), Code("S219"), &Diagnostic::code), 0) << name;
  }
  std::ifstream csv(folder / "closed_specimens.csv");
  std::map<std::string, int> tests;
  for (std::string line; std::getline(csv, line);) ++tests[line.substr(0, line.find(',', line.find(',') + 1))];
  EXPECT_EQ(tests["linear_elastic,shut in"], 1);
  EXPECT_EQ(tests["linear_elastic,at once"], 3);
  EXPECT_EQ(tests["linear_elastic,equalised"], 1);
  EXPECT_EQ(tests["modified_cam_clay,shut in"], 30);  // at strains that half of the steps reach too
  EXPECT_EQ(tests["modified_cam_clay,constant rate"], 90);
}

}  // namespace

}  // namespace sage::app
