#include "sage/record/listing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "sage/messages/error.hpp"
#include "tests/support/text.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::fresh_folder;
using test::has;
using test::lines_of;
using test::Specimen;

// Words of the line that starts (after blanks) with `first` and comes after the line that holds `after`.
std::vector<std::string> row(const std::string& text, const std::string& after, const std::string& first) {
  bool found = false;
  for (const std::string& line : lines_of(text)) {
    found = found || line.find(after) != std::string::npos;
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (found && !words.empty() && words[0] == first) return words;
  }
  ADD_FAILURE() << "no row " << first << " after " << after;
  return std::vector<std::string>(12, "0");
}

long count(const std::string& text, const std::string& part) {
  long n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::string run_listing(const std::string& name, Specimen& specimen, ListingOptions options = {},
                        bool fail = false) {
  const auto folder = fresh_folder(name);
  Listing listing(folder, "t", specimen.catalogue, std::move(options));
  if (fail)
    specimen.run_and_fail(listing, 0.01, 4);
  else
    specimen.run(listing, 0.01, 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "t.lst.partial"));
  EXPECT_EQ(listing.files().size(), 1u);
  return contents(folder / "t.lst");
}

// Fixture: sigma_yy = -E e = -10 inside, so +10 here; all other components vanish.  Five digits are printed.
TEST(Listing, CompressionIsPositive) {
  Specimen specimen;
  const std::string text = run_listing("listing_signs", specimen);
  const auto point = row(text, "Stresses of group 1", "101");
  EXPECT_EQ(point[5], "1.0000E+01");  // element, point, r, z, sig-r, sig-z
  EXPECT_NEAR(std::stod(point[4]), 0.0, 1e-12);
  EXPECT_NEAR(std::stod(point[6]), 0.0, 1e-12);
  EXPECT_EQ(point[9], "elastic");
  // k_n = 2000: 10 psi close the joint by 0.005 in; both are positive.
  const auto joint = row(text, "Interface of group 2", "201");
  EXPECT_EQ(joint[5], "1.0000E+01");
  EXPECT_EQ(joint[7], "5.0000E-03");
}

// Displacements and reactions are along the axes: the top goes down and is pushed down.
TEST(Listing, DisplacementsAndReactionsAreAlongTheAxes) {
  Specimen specimen(Geometry::axisymmetric, false);
  const std::string text = run_listing("listing_nodes", specimen);
  const auto node = row(text, "Nodes (displacement", "60");
  EXPECT_EQ(node[3], "2.5000E-03");   // u_r = nu e r
  EXPECT_EQ(node[4], "-2.0000E-02");  // u_z = -2 e
  EXPECT_LT(std::stod(node[6]), 0.0);
  const auto axis = row(text, "Nodes (displacement", "50");
  EXPECT_NEAR(std::stod(node[6]) + std::stod(axis[6]), -10.0 * kPi, 1e-3);  // five digits
  // node 40 is free: no reactions in its row
  EXPECT_EQ(row(text, "Nodes (displacement", "40").size(), 5u);
}

// The supports of the fixture push with 0.25 that no load balances: no rounding, so it is shown.
TEST(Listing, SumsOfForcesNameWhatTheyBelongToAndShowWhatIsUnbalanced) {
  Specimen specimen;
  const std::string text = run_listing("listing_sums", specimen);
  EXPECT_TRUE(
      has(text, "Equilibrium of the whole model (" + specimen.model.units.force + ", for the full circle"))
      << text;
  EXPECT_TRUE(has(text, "reaction of supports " + specimen.model.units.force + ", for the full circle"));
  EXPECT_EQ(row(text, "Equilibrium of the whole model", "z")[3], "2.5000000E-01");
}

TEST(Listing, StatesTheToleranceThatDoglegIsHeldTo) {
  Specimen specimen;
  specimen.model.stages[0].method = Method::dogleg;
  specimen.model.stages[0].tolerance = 0.5;
  EXPECT_TRUE(has(run_listing("listing_dogleg", specimen), "tolerance 1.0e-03"));
}

TEST(Listing, StatesUnitsAndSigns) {
  Specimen specimen;
  const std::string text = run_listing("listing_header", specimen);
  for (const char* part : {"compressed specimen", "axisymmetric; x = r", "length in, force lbf, stress psi",
                           "compression positive", "full circle (2 pi r)", "linear", "solver fake",
                           "nodes 8, elements 3", "atmospheric pressure 14.696", "RUN COMPLETED"})
    EXPECT_TRUE(has(text, part)) << part;
  EXPECT_FALSE(has(text, "date"));
  EXPECT_FALSE(has(text, "NOT CONVERGED"));
  Specimen plane(Geometry::plane_strain);
  EXPECT_TRUE(has(run_listing("listing_plane", plane), "forces: per "));
}

TEST(Listing, NamesParametersWithUnits) {
  Specimen specimen;
  specimen.model.materials[1].parameters.pop_back();  // `tension` falls back to its default
  const std::string text = run_listing("listing_materials", specimen);
  EXPECT_EQ(row(text, "MATERIALS", "youngs_modulus")[1], "1000");
  EXPECT_EQ(row(text, "MATERIALS", "youngs_modulus")[2], "psi");
  EXPECT_EQ(row(text, "MATERIALS", "normal_stiffness")[2], "psi/in");
  EXPECT_TRUE(has(text, "(not given: default)"));
}

TEST(Listing, OneLineAnIncrement) {
  Specimen specimen;
  const std::string text = run_listing("listing_increments", specimen);
  const auto third = row(text, "STAGE 1 OF 1: axial compression", "3");
  EXPECT_EQ(third[1], "7.50000E-01");
  EXPECT_EQ(third[2], "2");
  EXPECT_EQ(third[3], "1.50E-11");
  EXPECT_EQ(third[5], "3.50E-13");
}

TEST(Listing, TablesAsAsked) {
  Specimen specimen;
  specimen.model.stages[0].output_every = 2;
  EXPECT_EQ(count(run_listing("listing_all", specimen, {.tables = Tables::all}), "Stresses of group 1"), 2);
  EXPECT_EQ(count(run_listing("listing_end", specimen), "Stresses of group 1"), 1);
  EXPECT_EQ(count(run_listing("listing_none", specimen, {.tables = Tables::none}), "Stresses of group 1"), 0);
}

TEST(Listing, LeavesTheTablesOfLargeModelsOutUnlessAsked) {
  Specimen specimen;
  specimen.scene.points = kManyPoints + 1;
  const std::string text = run_listing("listing_large", specimen);
  EXPECT_EQ(count(text, "Stresses of group 1"), 0);
  EXPECT_TRUE(has(text, "To get them"));
  EXPECT_EQ(
      count(run_listing("listing_large_asked", specimen, {.tables = Tables::stage_end}), "Stresses of group 1"),
      1);
}

TEST(Listing, FailedRunShowsReasonAndLastConvergedState) {
  Specimen specimen;
  const std::string text = run_listing("listing_fail", specimen, {}, true);
  EXPECT_TRUE(has(text, "NOT CONVERGED"));
  EXPECT_TRUE(has(text, "no equilibrium found\n     try: something else"));
  EXPECT_TRUE(has(text, "LAST CONVERGED STATE"));
  EXPECT_TRUE(has(text, "load factor 0.875 of the stage"));
  EXPECT_FALSE(has(text, "RUN COMPLETED"));
  EXPECT_EQ(row(text, "LAST CONVERGED STATE", "101")[5], "8.7500E+00");  // E e at load factor 0.875
}

TEST(Listing, ShowsWarningsOfReadingAndOfTheRun) {
  Specimen specimen;
  specimen.model.diagnostics.warning("S331", {"specimen.dat", 12, 0, 0}, "something odd");
  const auto folder = fresh_folder("listing_warn");
  Listing listing(folder, "t", specimen.catalogue);
  listing.on_warning({Severity::warning, "S520", {"specimen.dat", 13, 0, 0}, "outside the yield surface", {}});
  specimen.run(listing, 0.01, 1);
  const std::string text = contents(folder / "t.lst");
  EXPECT_TRUE(has(text, "specimen.dat:12: warning: something odd"));
  EXPECT_TRUE(has(text, "specimen.dat:13: warning: outside the yield surface"));
}

TEST(Listing, RepeatsTheReports) {
  Specimen specimen(Geometry::axisymmetric, false);
  Report report;
  report.group = 0;
  report.nodes = {4, 5};
  report.height = 2.0;
  specimen.model.reports.push_back(report);
  const auto folder = fresh_folder("listing_report");
  Reports reports(folder, "t");
  Listing listing(folder, "t", specimen.catalogue, {.reports = &reports});
  specimen.run(reports, 0.01, 1);
  specimen.run(listing, 0.01, 1);
  const auto words = row(contents(folder / "t.lst"), "REPORT 1: TRIAXIAL", "1");
  EXPECT_EQ(words[2], "1.0000E-02");
  EXPECT_EQ(words[4], "1.00000E+01");
  EXPECT_EQ(words[8], "1.00000");
}

TEST(Listing, AKilledRunLeavesOnlyThePartialFile) {
  Specimen specimen;
  const auto folder = fresh_folder("listing_killed");
  {
    Listing listing(folder, "t", specimen.catalogue);
    listing.on_start(specimen.model, specimen.scene, "fake", 7);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "t.lst"));
  EXPECT_TRUE(has(contents(folder / "t.lst.partial"), "compressed specimen"));
}

TEST(Listing, AStoppedRunSaysSo) {
  Specimen specimen;
  const auto folder = fresh_folder("listing_stopped");
  Listing listing(folder, "t", specimen.catalogue);
  listing.on_start(specimen.model, specimen.scene, "fake", 7);
  listing.stop("stage 2: a law cannot start");
  const std::string text = contents(folder / "t.lst");
  EXPECT_TRUE(has(text, "RUN STOPPED, NOT COMPLETE"));
  EXPECT_TRUE(has(text, "a law cannot start"));
}

TEST(Listing, RefusesAnUnwritableFolderAtOnce) {
  const auto folder = fresh_folder("listing_folder");
  test::contents(folder);
  Specimen specimen;
  EXPECT_THROW(Listing("/dev/null/results", "t", specimen.catalogue), OutputError);
}

TEST(Listing, NoLineIsVeryLong) {
  Specimen specimen;
  const std::string text = run_listing("listing_width", specimen, {}, true);
  for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), 132u) << line;
}

}  // namespace
}  // namespace sage
