// Decks of `sagefe new deck`, which must run as they are, and `sagefe align`, which moves values into their columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

// The number in a column of the last row of a table of the run.
double last_number(const fs::path& file, const std::string& column) {
  std::istringstream lines(read(file));
  std::vector<std::string> names, cells;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream parts(line);
    std::vector<std::string>& row = names.empty() ? names : cells;
    row.clear();
    for (std::string cell; std::getline(parts, cell, ',');) row.push_back(cell);
  }
  for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i)
    if (names[i].starts_with(column)) return std::stod(cells[i]);
  ADD_FAILURE() << file << " has no column " << column;
  return std::nan("");
}

// In the folder a deck of that name, without a warning, and computed.
fs::path run_template(const std::string& name) {
  const fs::path folder = empty_folder("template_" + name);
  EXPECT_EQ(sagefe(folder, "new deck " + name).exit_code, 0);
  const Finished check = sagefe(folder, "check --strict " + name + ".dat");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  const Finished run = sagefe(folder, "run --strict " + name + ".dat -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(read(folder / (name + ".dat")));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
  return folder / "out";
}

// Prandtl: (2 + pi) c on half of 2 m, c = 50 kPa; the mesh is 1 % above (its page says so).
TEST(NewDeck, FootingCarriesPrandtlsLoad) {
  const double load = -last_number(run_template("footing") / "footing.report1.csv", "fy");
  const double prandtl = (2.0 + std::acos(-1.0)) * 50.0;
  EXPECT_GT(load, prandtl);
  EXPECT_LT(load, 1.015 * prandtl);
}

// legacy_inputs/structures/braced_cut, whose expected.csv balances earth and struts.
TEST(NewDeck, ExcavationIsTheBracedCut) {
  run_template("excavation");
  const fs::path folder = empty_folder("template_excavation_json");
  const Finished run = sagefe(folder, "new deck excavation");
  ASSERT_EQ(run.exit_code, 0);
  const std::string out = sagefe(folder, "run excavation.dat -o out").out;
  EXPECT_NE(out.find("force_each [kN]             63.204     255     3     112.15     255     5"),
            std::string::npos)
      << out;
}

// Clay 40 x 10 x 17 and half of the embankment 9 x 4 x 20 stand on the base.
TEST(NewDeck, EmbankmentStandsOnItsBase) {
  EXPECT_NEAR(last_number(run_template("embankment") / "embankment.report1.csv", "fy"), 7520.0, 1e-3);
}

// A log-spiral through the toe: 1.36482 as an upper bound, up to 2 % above it on elements of finite size.
TEST(NewDeck, SlopeHasTheFactorOfTheLogSpiral) {
  run_template("slope");
  const fs::path folder = empty_folder("template_slope_safety");
  ASSERT_EQ(sagefe(folder, "new deck slope").exit_code, 0);
  const std::string out = sagefe(folder, "safety slope.dat -o out --tolerance .05 --start 1.33").out;
  const std::size_t at = out.find("safety factor between ");
  ASSERT_NE(at, std::string::npos) << out;
  double low = 0.0, high = 0.0;
  ASSERT_EQ(std::sscanf(out.c_str() + at, "safety factor between %lf and %lf", &low, &high), 2);
  EXPECT_LT(low, 1.02 * 1.36482);
  EXPECT_GT(high, 1.36482);
}

// Mohr-Coulomb: 2 (c + sigma_3 tan(phi)) cos(phi) / (1 - sin(phi)) with c = 5, phi = 30, sigma_3 = 100.
TEST(NewDeck, TriaxialTestReachesItsStrength) {
  const double phi = std::acos(-1.0) / 6.0;
  const double strength = 2.0 * (5.0 + 100.0 * std::tan(phi)) * std::cos(phi) / (1.0 - std::sin(phi));
  EXPECT_NEAR(last_number(run_template("triaxial") / "triaxial.report1.csv", "measured"), strength, 1e-6);
}

// k h / 2 with k = 1e-5 and h = 4 (docs/theory/seepage.md); tolerance of legacy_inputs/seepage/sheet_pile.
TEST(NewDeck, SeepageHasTheDischargeOfTheClosedForm) {
  EXPECT_NEAR(last_number(run_template("seepage") / "seepage.report1.csv", "discharge"), 2e-5, 2e-8);
}

// legacy_inputs/structures/culvert_bonded, beside Burns and Richard.
TEST(NewDeck, CulvertIsTheBondedPipe) {
  run_template("culvert");
  const fs::path folder = empty_folder("template_culvert_out");
  ASSERT_EQ(sagefe(folder, "new deck culvert").exit_code, 0);
  const std::string out = sagefe(folder, "run culvert.dat -o out").out;
  EXPECT_NE(out.find("axial_force [kN]             43.29     112     1     200.67     104     5"),
            std::string::npos)
      << out;
  EXPECT_EQ(out.find("hoop_force"), std::string::npos) << "rows of zeros say nothing\n" << out;
}

// The commands in its comments can be copied.
TEST(NewDeck, CommentsNameTheFileThatWasWritten) {
  const fs::path folder = empty_folder("template_name");
  for (const char* name : {"culvert", "embankment", "excavation", "footing", "seepage", "slope", "triaxial"}) {
    ASSERT_EQ(sagefe(folder, std::string("new deck ") + name + " -o wall_of_" + name + "2.dat").exit_code, 0);
    const std::string file = std::string(name) + ".dat", written = "wall_of_" + std::string(name) + "2.dat";
    const std::string text = read(folder / written);
    EXPECT_EQ(text.find(file), std::string::npos) << text;
    EXPECT_NE(text.find("sagefe " + std::string(name == std::string("slope") ? "safety " : "run ") + written),
              std::string::npos)
        << text;
  }
}

// The thrust of the half ring is drawn on its outer side, though its elements run counter-clockwise.
TEST(NewDeck, DiagramsOfLiningsAreDrawnOutwards) {
  const fs::path folder = empty_folder("template_culvert_picture");
  ASSERT_EQ(sagefe(folder, "new deck culvert").exit_code, 0);
  ASSERT_EQ(sagefe(folder, "run culvert.dat -o out -q --picture axial_force").exit_code, 0);
  const std::string svg = read(folder / "out/culvert_stage5_axial_force.svg");
  const std::size_t mark = svg.find("fill-opacity=\"0.25\" d=\"");
  ASSERT_NE(mark, std::string::npos) << svg.substr(0, 500);
  const std::string path = svg.substr(mark + 23, svg.find('"', mark + 23) - mark - 22);
  std::vector<std::array<double, 2>> points;  // of each element two on the pipe, then two of the diagram
  for (std::size_t at = 0; at < path.size(); ++at)
    if (path[at] == 'M' || path[at] == 'L') {
      std::array<double, 2> point{};
      ASSERT_EQ(std::sscanf(path.c_str() + at + 1, "%lf %lf", &point[0], &point[1]), 2);
      points.push_back(point);
    }
  ASSERT_EQ(points.size(), 64u);
  double left = 1e9, low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < points.size(); i += 4) {
    left = std::min({left, points[i][0], points[i + 1][0]});
    low = std::min({low, points[i][1], points[i + 1][1]});
    high = std::max({high, points[i][1], points[i + 1][1]});
  }
  const auto radius = [&](std::size_t i) {
    return std::hypot(points[i][0] - left, points[i][1] - 0.5 * (low + high));
  };
  for (std::size_t i = 0; i < points.size(); i += 4) {
    EXPECT_GT(radius(i + 3), radius(i) + 1.0) << i;
    EXPECT_GT(radius(i + 2), radius(i + 1) + 1.0) << i;
  }
}

// Each group of solids has a curve of its own.
TEST(NewDeck, SafetyGraphShowsTheGroupsOfTheDeck) {
  const fs::path folder = empty_folder("template_embankment_safety");
  ASSERT_EQ(sagefe(folder, "new deck embankment").exit_code, 0);
  const Finished run = sagefe(folder, "safety embankment.dat -o out --tolerance .2 --start 1.8");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string svg = read(folder / "out/embankment.safety.svg");
  for (const char* name : {">clay<", ">lift 1<", ">lift 4<", ">equilibrium<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
}

TEST(NewDeck, NothingIsOverwrittenAndUnknownNamesAreNamed) {
  const fs::path folder = empty_folder("template_refused");
  write(folder / "slope.dat", "mine\n");
  EXPECT_EQ(sagefe(folder, "new deck slope").exit_code, 1);
  EXPECT_EQ(read(folder / "slope.dat"), "mine\n");
  const Finished unknown = sagefe(folder, "new deck slop");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.err.find("did you mean slope?"), std::string::npos) << unknown.err;
  EXPECT_EQ(sagefe(folder, "new deck footing -o other.dat").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "other.dat"));
}

// The triaxial deck with one line changed, aligned.
struct Aligned {
  Finished run;
  std::string before, after;
};

Aligned align(const std::string& name, const std::string& line, const std::string& changed) {
  const fs::path folder = empty_folder("align_" + name);
  EXPECT_EQ(sagefe(folder, "new deck triaxial").exit_code, 0);
  Aligned result;
  result.before = read(folder / "triaxial.dat");
  std::string text = result.before;
  const std::size_t at = text.find("\n" + line + "\n");
  EXPECT_NE(at, std::string::npos) << line;
  text.replace(at + 1, line.size(), changed);
  write(folder / "moved.dat", text);
  result.run = sagefe(folder, "align moved.dat");
  if (fs::exists(folder / "moved_aligned.dat")) result.after = read(folder / "moved_aligned.dat");
  return result;
}

constexpr const char* kNode = "    5    0    0      0.05        0.";

TEST(Align, CardsAndValuesThatSlippedComeBack) {
  const struct {
    const char *name, *line, *changed, *words;
  } cases[] = {
      {"card", kNode, "      5    0    0      0.05        0.", "node card: moved 2 columns to the left"},
      {"value", kNode, "    5    0    0         0.05     0.",
       "\"0.05\" from columns 25-28 to columns 22-25 (x)"},
      {"free", kNode, "5 0 0 0.05 0.", "\"5\" from column 1 to column 5 (number)"},
      {"tabs", kNode, "5\t0\t0\t0.05\t0.", "(system)"},
      {"list", "    20000.      0.30        5.       30.        0.",
       "       20000.      0.30        5.       30.        0.",
       "parameters card: \"20000.\" from columns 8-13"},
      {"support", "    1   21    5    1    0", "1 21 5 1 0", "fixity card: \"1\" from column 1 to column 5"},
      {"pressure", "    4    2   16    4      100.      100.", "    4    2   16    4         100.      100.",
       "pressure card: moved 3 columns to the left from \"100.\" on"},
  };
  for (const auto& one : cases) {
    const Aligned aligned = align(one.name, one.line, one.changed);
    EXPECT_EQ(aligned.run.exit_code, 0) << one.name << aligned.run.err;
    EXPECT_EQ(aligned.after, aligned.before) << one.name;
    EXPECT_NE(aligned.run.out.find(one.words), std::string::npos) << one.name << aligned.run.out;
  }
}

// Ten integers for fourteen fields fit in many ways: nothing is guessed.
TEST(Align, WhatFitsInSeveralWaysIsLeftAlone) {
  const Aligned aligned =
      align("several", "    1    1    1    2    7    6                        4    4    1    5",
            "1 1 1 2 7 6 4 4 1 5");
  EXPECT_EQ(aligned.run.exit_code, 2);
  EXPECT_EQ(aligned.after, "");
  EXPECT_NE(aligned.run.err.find("[S590]"), std::string::npos) << aligned.run.err;
}

TEST(Align, DecksInTheirColumnsStayAsTheyAre) {
  const fs::path folder = empty_folder("align_right");
  for (const char* name : {"footing", "excavation", "embankment", "slope", "triaxial", "seepage", "culvert"}) {
    const std::string deck = std::string(name) + ".dat";
    ASSERT_EQ(sagefe(folder, "new deck " + std::string(name)).exit_code, 0);
    const std::string before = read(folder / deck);
    const Finished run = sagefe(folder, "align --in-place " + deck);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("no value was moved"), std::string::npos) << run.out;
    EXPECT_EQ(read(folder / deck), before);
  }
}

}  // namespace
}  // namespace sage::test
