// compare --converge: two answers on finer and finer meshes, whose stated errors must hold what is known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "tests/regression/program.hpp"
#include "tests/studies/scenes/scenes.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

// A line of "reported at the end".
struct Answer {
  double a = NAN, b = NAN, expected = NAN, error_a = NAN, error_b = NAN;

  double ratio() const { return b / a; }
  double ratio_error() const { return std::abs(ratio()) * (error_a / std::abs(a) + error_b / std::abs(b)); }
};

std::map<std::string, Answer> answers_of(const fs::path& file) {
  std::map<std::string, Answer> answers;
  std::stringstream in(read(file));
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("reported at the end,")) continue;
    std::vector<std::string> cells;
    std::stringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    const auto number = [&](std::size_t i) { return cells.at(i).empty() ? NAN : std::stod(cells.at(i)); };
    answers[cells.at(1)] = {number(3), number(4), number(7), number(8), number(9)};
  }
  return answers;
}

// reference: how far the known value may itself be off.
void expect_held(double value, double error, double known, double reference, const std::string& what) {
  EXPECT_LE(std::abs(value - known), error + reference) << what << ": " << value << " +- " << error;
  EXPECT_LE(error, 1e-4 * std::abs(known)) << what << ": useless";
}

// Flexible load q = 1 on a half-width (radius) of 1, E = 1, nu = .3, box of 5 x 5 with a fixed base and rollers
// at the sides: settlement of the centre in both geometries by an independent hp solution (eight digits).
std::string flexible_load() {
  scenes::DeckWriter deck(1);
  const double x[] = {0.0, 1.0, 2.5, 5.0}, y[] = {0.0, 2.5, 4.0, 5.0};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) deck.node(4 * j + i + 1, x[i], y[j]);
  deck.material(1, 1, {1.0, 0.3});
  deck.group(1, 1, 0, 1);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const int n = 4 * j + i + 1;
      deck.element(3 * j + i + 1, 1, {n, n + 1, n + 5, n + 4});
    }
  for (int j = 0; j < 4; ++j)
    for (const int i : {1, 4}) deck.fix(4 * j + i, 1, 0);
  for (int i = 1; i <= 4; ++i) deck.fix(i, 1, 1);
  deck.stage().pressure(7, 3, 1.0, 1.0);
  deck.reports.push_back("    2    0   13   13    1    1");
  return deck.text();
}

constexpr double kPlaneSettlement = -2.3855905, kRoundSettlement = -1.5561672;

TEST(CompareConverge, SettlementsOfBothGeometriesHoldTheTrueValues) {
  const fs::path folder = empty_folder("compare_settlement");
  write(folder / "load.dat", flexible_load());
  const Finished done = sagefe(folder, "compare load.dat --both --converge 1e-5");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto answers = answers_of(folder / "out/load.compare.csv");
  ASSERT_TRUE(answers.contains("report1.uy"));
  const Answer& uy = answers.at("report1.uy");
  expect_held(uy.a, uy.error_a, kPlaneSettlement, 1e-7, "plane strain");
  expect_held(uy.b, uy.error_b, kRoundSettlement, 1e-7, "axisymmetry");
  expect_held(uy.ratio(), uy.ratio_error(), kRoundSettlement / kPlaneSettlement, 1e-7, "B / A");
  // The first lines are the answer, with its errors; the tables of the meshes go beside it, and into files.
  EXPECT_TRUE(done.out.starts_with("A: load.dat, plane strain")) << done.out;
  EXPECT_LT(done.out.find("reported at the end"), done.out.find("course"));
  EXPECT_NE(done.out.find("-2.38559"), std::string::npos);
  EXPECT_NE(done.out.find(" +- "), std::string::npos);
  EXPECT_EQ(done.out.find("NOT REACHED"), std::string::npos);
  EXPECT_EQ(count(done.err, "result    report1.uy"), 2) << done.err;
  for (const char* name : {"load.a.convergence.csv", "load.b.convergence.csv", "load.a.report1.csv",
                           "load.b.report1.csv", "load.compare.csv"}) {
    EXPECT_TRUE(fs::exists(folder / "out" / name)) << name;
    EXPECT_NE(done.out.find(name), std::string::npos) << name;
  }
  EXPECT_FALSE(fs::exists(folder / "out/load.convergence.csv"));
  EXPECT_FALSE(fs::exists(folder / "out/load.files"));
}

// The table and the reports of the best mesh are all that --converge writes, and both are named; so is a note about the
// expected memory of a finer mesh, once.
TEST(Converge, NamesAllFilesThatItWrites) {
  const fs::path folder = empty_folder("converge_files");
  write(folder / "load.dat", flexible_load());
  const Finished done = sagefe(folder, "run load.dat --converge 1e-3 --result");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.out.find("out/load.convergence.csv\n            out/load.report1.csv\n"), std::string::npos)
      << done.out;
  EXPECT_EQ(count(done.err, "[S909]"), 1) << done.err;
  std::set<std::string> written;
  for (const fs::directory_entry& file : fs::directory_iterator(folder / "out"))
    written.insert(file.path().filename().string());
  EXPECT_EQ(written, (std::set<std::string>{"load.convergence.csv", "load.files", "load.report1.csv"}));
  const Finished finer = sagefe(folder, "check load.dat --refine 8");
  EXPECT_EQ(count(finer.err + finer.out, "[S409]"), 1) << finer.err << finer.out;
}

// Inner pressure p = 1, outer face held, E = 1: a slab from x = 1 to 2 without strain along y, u = p (1 + nu)(1
// - 2 nu)/(1 - nu); a ring, u = A r + B/r with u(2) = 0 and sigma_r(1) = -p (Lame).
TEST(CompareConverge, SlabAndThickRingHoldTheClosedForms) {
  for (const double nu : {0.3, 0.495}) {
    scenes::DeckWriter deck(2);
    const scenes::Block block{2, 1, scenes::Cell::quad4, 1, 1, scenes::rectangle(1.0, 2.0, 0.0, 1.0)};
    block.write_nodes(deck);
    deck.material(1, 1, {1.0, nu});
    deck.group(1, 1, 1, 1);
    block.write_elements(deck, 1);
    for (const auto& edge : {block.bottom(), block.top()})
      for (int node : edge) deck.fix(node, 0, 1);
    for (int node : block.right()) deck.fix(node, 1, 0);
    deck.stage().pressure(block.element(0, 0), 4, 1.0, 1.0);
    deck.reports.push_back("    2    0    1    1    1    1");
    const fs::path folder = empty_folder("compare_lame");
    write(folder / "lame.dat", deck.text());
    const Finished done = sagefe(folder, "compare lame.dat --both --converge 1e-8 --digits 16");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const auto answers = answers_of(folder / "out/lame.compare.csv");
    ASSERT_TRUE(answers.contains("report1.ux"));
    const Answer& ux = answers.at("report1.ux");
    const double slab = (1 + nu) * (1 - 2 * nu) / (1 - nu);
    // B = -4 A; sigma_r(1) = E/((1 + nu)(1 - 2 nu)) (A - (1 - 2 nu) B).
    const double A = -(1 + nu) * (1 - 2 * nu) / (1 + 4 * (1 - 2 * nu)), ring = A - 4 * A;
    expect_held(ux.a, ux.error_a, slab, 1e-12, "slab");
    expect_held(ux.b, ux.error_b, ring, 1e-12, "ring");
    expect_held(ux.ratio(), ux.ratio_error(), ring / slab, 1e-12, "B / A");
  }
}

// The restrained cylinder, L/D = 1, nu = .495: 1.190558066 (two independent hp solutions,
// docs/theory/accuracy.md). Theory knows the deviators of frictionless ends; those are certain too.
TEST(CompareConverge, RestrainedCylinderBesideItsStrip) {
  const scenes::RestrainedCylinder scene{1.0, 0.495, scenes::Cell::quad4, 2, 2, 2, 1.0};
  scenes::DeckWriter deck = scene.between_rough_platens(0.01);
  const std::vector<int> end = scene.block().top();
  deck.triaxial_report(1, end.front(), end.back(), 1, 1.0);
  const fs::path folder = empty_folder("compare_cylinder");
  write(folder / "cylinder.dat", deck.text());
  const Finished done = sagefe(folder, "compare cylinder.dat --both --converge 1e-6");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto answers = answers_of(folder / "out/cylinder.compare.csv");
  ASSERT_TRUE(answers.contains("report1.ratio") && answers.contains("report1.measured_deviator"));
  const Answer &ratio = answers.at("report1.ratio"), &deviator = answers.at("report1.measured_deviator");
  expect_held(ratio.b, ratio.error_b, 1.190558066, 1e-9, "axisymmetry");
  expect_held(deviator.b, deviator.error_b, 0.01 * 1.190558066, 1e-11, "axisymmetry");
  EXPECT_NEAR(deviator.expected, 1 - 0.495 * 0.495, 1e-6);
  EXPECT_TRUE(std::isfinite(ratio.error_a) && std::isfinite(deviator.error_a));
}

// A uniform body: theory's ratio of the forces over their areas lies within the error of the one that was found.
TEST(CompareConverge, TheoryStandsBesideTheRatioAndItsError) {
  scenes::DeckWriter deck(2);
  const scenes::Block block{2, 3, scenes::Cell::quad4, 1, 1, scenes::rectangle(0.0, 1.0, 0.0, 2.0)};
  block.write_nodes(deck);
  deck.material(1, 1, {3000.0, 0.3});
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (int node : block.bottom()) deck.fix(node, 0, 1);
  for (int node : block.left()) deck.fix(node, 1, 0);
  scenes::StageCards& stage = deck.stage();
  for (int node : block.top()) stage.fix(node, 0, 1, 0.0, -0.02);
  deck.reports.push_back("    2    0   10   12    1    1");
  const fs::path folder = empty_folder("compare_uniform");
  write(folder / "uniform.dat", deck.text());
  const Finished done = sagefe(folder, "compare uniform.dat --both --converge 1e-8");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto answers = answers_of(folder / "out/uniform.compare.csv");
  ASSERT_TRUE(answers.contains("report1.fy / area"));
  const Answer& fy = answers.at("report1.fy / area");
  const double expected = 1 - 0.09;
  EXPECT_NEAR(fy.expected, expected, 1e-8);
  expect_held(fy.ratio(), fy.ratio_error(), expected, 1e-8, "B / A");
}

// Limits are those of `run`; the best that there is stands in the answer, which says what it is.
TEST(CompareConverge, ASideThatIsNotReachedIsNamed) {
  const fs::path folder = empty_folder("compare_limits");
  write(folder / "load.dat", flexible_load());
  const Finished few = sagefe(folder, "compare load.dat --both --converge 1e-9 --max-dofs 3000");
  EXPECT_EQ(few.exit_code, 3) << few.err;
  EXPECT_EQ(count(few.out, "NOT REACHED: relative error 1e-09 asked for"), 2) << few.out;
  EXPECT_NE(few.out.find("--max-dofs"), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("NOT REACHED in A and B"), std::string::npos) << few.out;
  const auto answers = answers_of(folder / "out/load.compare.csv");
  ASSERT_TRUE(answers.contains("report1.uy"));
  const Answer& uy = answers.at("report1.uy");
  EXPECT_LE(std::abs(uy.a - kPlaneSettlement), uy.error_a + 1e-7);
  EXPECT_LE(std::abs(uy.b - kRoundSettlement), uy.error_b + 1e-7);
  const Finished none = sagefe(folder, "compare load.dat --both --converge 1e-9 --max-dofs 10");
  EXPECT_EQ(none.exit_code, 3) << none.err;
  EXPECT_EQ(count(none.out, "NO RESULTS"), 2) << none.out;
  EXPECT_EQ(sagefe(folder, "compare load.dat --both --converge 1e-4 --follow report1.fz").exit_code, 2);
  // A point of both, followed alone, on the deck's elements halved; --element and --refine act as in `run`.
  const Finished point =
      sagefe(folder,
             "compare load.dat --both --point 0.5,4.5 --element quad9 --refine 1 --converge 2e-3 "
             "--follow report2.uy");
  EXPECT_EQ(point.exit_code, 0) << point.err << point.out;
  EXPECT_NE(point.out.find("quad9"), std::string::npos) << point.out;
  EXPECT_EQ(count(point.err, "result    report2.uy"), 2) << point.err;
  EXPECT_EQ(sagefe(folder, "compare load.dat --both --point 9,9 --converge 1e-3").exit_code, 2);
}

}  // namespace
}  // namespace sage::test
