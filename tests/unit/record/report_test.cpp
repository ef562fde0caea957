#include "sage/record/report.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::csv_column;
using test::csv_numbers;
using test::fresh_folder;
using test::Specimen;

// Triaxial report on the specimen's own top (nodes 50, 60), without the interface.
Report top_report(double cell_pressure = 0.0) {
  Report report;
  report.kind = ReportKind::triaxial;
  report.group = 0;
  report.nodes = {4, 5};
  report.height = 2.0;
  report.cell_pressure = cell_pressure;
  return report;
}

// Closed form of the fixture: sigma_yy = -E e over pi r^2, so the ratio is 1.  Tolerance 1e-10: round-off of
// forces over an element (1e-14) and of the driver's stress control (1e-12).
TEST(TriaxialReport, CompressedCylinderIsPositive) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.model.reports.push_back(top_report());
  Reports reports(fresh_folder("triaxial"), "t");
  specimen.run(reports, 0.02, 4);
  const std::vector<TriaxialRow>& rows = reports.triaxial(0);
  ASSERT_EQ(rows.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const TriaxialRow& row = rows[i];
    const double strain = 0.005 * (i + 1);
    EXPECT_EQ(row.stage, 1);
    EXPECT_EQ(row.increment, i + 1);
    EXPECT_NEAR(row.axial_strain, strain, 1e-12);
    EXPECT_NEAR(row.force, Specimen::kE * strain * kPi, 1e-8);
    EXPECT_NEAR(row.measured_deviator, Specimen::kE * strain, 1e-8);
    EXPECT_NEAR(row.correct_deviator, Specimen::kE * strain, 1e-8);
    EXPECT_NEAR(row.ratio, 1.0, 1e-10);
  }
}

// Plane strain with free sides: sigma_yy = E e / (1 - nu^2), force over the width 1.
TEST(TriaxialReport, PlaneStrainDriverHasNoLateralStrainOutOfPlane) {
  Specimen specimen(Geometry::plane_strain, false);
  specimen.model.reports.push_back(top_report());
  Reports reports(fresh_folder("triaxial_plane"), "t");
  specimen.run(reports, 0.02, 2);
  const TriaxialRow row = reports.triaxial(0).back();
  const double expected = Specimen::kE * 0.02 / (1.0 - Specimen::kNu * Specimen::kNu);
  EXPECT_NEAR(row.force, expected, 1e-8);
  EXPECT_NEAR(row.correct_deviator, expected, 1e-8);
  EXPECT_NEAR(row.ratio, 1.0, 1e-10);
}

// What stands before the report's stage does not count; the cell pressure is added to both axial stresses.
TEST(TriaxialReport, CountsFromTheStartOfItsStage) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.model.reports.push_back(top_report(50.0));
  specimen.model.reports[0].stage = 1;
  specimen.model.stages.push_back(specimen.model.stages[0]);
  Reports reports(fresh_folder("triaxial_stage"), "t");
  reports.on_start(specimen.model, specimen.scene, "fake", 1);
  reports.on_stage_start(specimen.model, 0, specimen.solution());
  specimen.compress(0.01);
  reports.on_increment(specimen.model, specimen.step(1, 1, 0), specimen.solution());
  EXPECT_TRUE(reports.triaxial(0).empty());
  reports.on_stage_start(specimen.model, 1, specimen.solution());
  specimen.compress(0.03);
  reports.on_increment(specimen.model, specimen.step(1, 1, 1), specimen.solution());
  ASSERT_EQ(reports.triaxial(0).size(), 1u);
  const TriaxialRow& row = reports.triaxial(0)[0];
  EXPECT_EQ(row.stage, 2);
  EXPECT_NEAR(row.axial_strain, 0.02, 1e-12);
  EXPECT_NEAR(row.force, Specimen::kE * 0.03 * kPi, 1e-8);
  EXPECT_NEAR(row.measured_deviator, Specimen::kE * 0.02, 1e-8);
  EXPECT_NEAR(row.measured_axial, 50.0 + Specimen::kE * 0.02, 1e-8);
  EXPECT_NEAR(row.correct_axial, 50.0 + Specimen::kE * 0.02, 1e-8);
}

// The cone is matched to Mohr-Coulomb in triaxial compression, so the deviator stops at
// q_f = (2 c cos phi + 2 sigma_3 sin phi) / (1 - sin phi).
TEST(CorrectTest, DruckerPragerStopsAtTheMohrCoulombStrength) {
  Catalogue catalogue = Specimen().catalogue;
  const MaterialEntry* entry = nullptr;
  for (const auto& [code, e] : catalogue.materials.entries())
    if (e.name == "drucker_prager") entry = &e;
  ASSERT_NE(entry, nullptr);
  std::vector<double> values(entry->parameters.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = entry->parameters[i].name;
    values[i] = entry->parameters[i].fallback;
    if (name == "youngs_modulus") values[i] = 3000.0;
    if (name == "poissons_ratio") values[i] = 0.3;
    if (name == "cohesion") values[i] = 2.0;
    if (name == "friction_angle") values[i] = 30.0;
  }
  const LawPtr law = entry->make(values, {"in", "lbf", "psi", 14.696, 0.036111});
  CorrectTest correct(*std::get<std::unique_ptr<SolidLaw>>(law), Geometry::axisymmetric, 50.0);
  EXPECT_NEAR(correct.deviator_at(0.001), 3.0, 1e-8);  // elastic: E eps
  const double strength = (2.0 * 2.0 * std::cos(kPi / 6.0) + 2.0 * 50.0 * 0.5) / 0.5;
  EXPECT_NEAR(correct.deviator_at(0.2), strength, 1e-6 * strength);  // the driver's tolerance over many steps
}

// No cell pressure that tension could carry: blank, with the reason.
TEST(CorrectTest, SaysWhyItHasNoAnswer) {
  Catalogue catalogue = Specimen().catalogue;
  const LawPtr law = catalogue.materials.find(3)->make(std::vector<double>{3000.0, 0.3, 0.0, 30.0},
                                                       {"in", "lbf", "psi", 14.696, 0.036111});
  CorrectTest correct(*std::get<std::unique_ptr<SolidLaw>>(law), Geometry::axisymmetric, -50.0);
  EXPECT_TRUE(std::isnan(correct.deviator_at(0.001)));
  EXPECT_NE(correct.failure().find("can't carry the initial stress"), std::string::npos) << correct.failure();
}

// From an axial stress of 60 beside a cell pressure of 50 the strength leaves 10 less to come.
TEST(CorrectTest, StartsFromTheStressOfTheMesh) {
  Catalogue catalogue = Specimen().catalogue;
  const LawPtr law = catalogue.materials.find(3)->make(std::vector<double>{3000.0, 0.3, 2.0, 30.0},
                                                       {"in", "lbf", "psi", 14.696, 0.036111});
  const double strength = (2.0 * 2.0 * std::cos(kPi / 6.0) + 2.0 * 50.0 * 0.5) / 0.5;
  CorrectTest correct(*std::get<std::unique_ptr<SolidLaw>>(law), Geometry::axisymmetric, 50.0,
                      {{-50.0, -60.0, -50.0, 0.0}, {0.0, 0.0}, ""});
  EXPECT_NEAR(correct.deviator_at(0.2), strength - 10.0, 1e-8 * strength);
}

TEST(TriaxialReport, UsesAGivenArea) {
  Specimen specimen;
  Report report = top_report();
  EXPECT_DOUBLE_EQ(report_area(specimen.model, report), kPi);
  report.area = 7.0;
  EXPECT_DOUBLE_EQ(report_area(specimen.model, report), 7.0);
  Specimen plane(Geometry::plane_strain);
  EXPECT_DOUBLE_EQ(report_area(plane.model, top_report()), 1.0);
}

TEST(TriaxialReport, FileHoldsTheRows) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.model.reports.push_back(top_report());
  const auto folder = fresh_folder("triaxial_file");
  Reports reports(folder, "t");
  specimen.run(reports, 0.02, 2);
  ASSERT_EQ(reports.files().size(), 1u);
  const std::string text = contents(folder / "t.report1.csv");
  EXPECT_EQ(csv_column(text, "increment"), (std::vector<std::string>{"1", "2"}));
  EXPECT_NEAR(csv_numbers(text, "measured_deviator").back(), 20.0, 1e-8);
  EXPECT_NEAR(csv_numbers(text, "ratio").back(), 1.0, 1e-9);
  EXPECT_NE(text.find("compression positive"), std::string::npos);
  EXPECT_NE(text.find("measured_deviator[psi]"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "t.report1.csv.partial"));
}

TEST(TriaxialReport, FailedRunKeepsTheLastEquilibriumAndSaysSo) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.model.reports.push_back(top_report());
  const auto folder = fresh_folder("triaxial_fail");
  Reports reports(folder, "t");
  specimen.run_and_fail(reports, 0.02, 4);
  const std::string text = contents(folder / "t.report1.csv");
  EXPECT_NE(text.find("NOT CONVERGED in stage 1, increment 4"), std::string::npos);
  ASSERT_EQ(reports.triaxial(0).size(), 4u);
  EXPECT_NEAR(reports.triaxial(0).back().axial_strain, 0.02 * 3.5 / 4.0, 1e-12);
}

TEST(NodeReport, SumsForcesAndMeansDisplacements) {
  Specimen specimen(Geometry::axisymmetric, false);
  Report report = top_report();
  report.kind = ReportKind::nodes;
  specimen.model.reports.push_back(report);
  const auto folder = fresh_folder("nodes_report");
  Reports reports(folder, "t");
  specimen.run(reports, 0.02, 1);
  ASSERT_EQ(reports.nodes(0).size(), 1u);
  const NodesRow& row = reports.nodes(0)[0];
  EXPECT_NEAR(row.displacement[0], 0.5 * Specimen::kNu * 0.02, 1e-12);  // mean of r = 0 and r = 1
  EXPECT_NEAR(row.displacement[1], -0.04, 1e-12);                       // along +y: down is negative
  EXPECT_NEAR(row.force[1], -Specimen::kE * 0.02 * kPi, 1e-8);          // pushed down
  EXPECT_NE(contents(folder / "t.report1.csv").find("ux[in],uy[in],fx[lbf],fy[lbf]"), std::string::npos);
}

}  // namespace
}  // namespace sage
