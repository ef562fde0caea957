// Footings under loads beyond collapse: what the program accepts, and what it says of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sage/record/push.hpp"
#include "tests/regression/program.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/support/sanitized.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;
using scenes::Block;
using scenes::Cell;
using scenes::DeckWriter;

// Half of a flexible strip of half width 1 on clay, c = 1, phi = 0: collapse at 2 + pi (Prandtl).
struct Footing {
  int law = 4;  // 3 Drucker-Prager, which is von Mises then
  double E = 1e4, nu = 0.49999;
  int formulation = 2;  // of quad8: 1 reduced, 2 full
  int inside = 3, outside = 5, down = 5;
  double width = 4.0, depth = 2.0, power = 1.0;
  double load = 6.0;
  int increments = 2, method = 1, iterations = 200;
  double tolerance = 0.0;

  std::string text() const {
    Block block;
    block.cell = Cell::quad8;
    block.columns = inside + outside;
    block.rows = down;
    block.straight = true;
    block.place = [*this](double s, double t) -> Vector2 {
      const double at = s * (inside + outside);
      const double x = at <= inside ? 1.0 - std::pow(1.0 - at / inside, power)
                                    : 1.0 + width * std::pow((at - inside) / outside, power);
      return {x, -depth * std::pow(1.0 - t, power)};
    };
    DeckWriter deck(1);
    block.write_nodes(deck);
    std::vector<double> strength{E, nu, 1.0, 0.0, 0.0};
    if (law == 3) strength.insert(strength.end(), {4.0, 1.0});
    deck.material(1, law, strength);
    deck.group(1, 2, formulation, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    scenes::StageCards& stage = deck.stage(increments);
    stage.method = method;
    stage.max_iterations = iterations;
    stage.tolerance = tolerance;
    for (int i = 0; i < inside; ++i) stage.pressure(block.element(i, down - 1), 3, load, load);
    return deck.text();
  }
};

// The numbers of a CSV's column, found by the beginning of its name.
std::vector<double> column(const fs::path& file, const std::string& name) {
  std::istringstream lines(read(file));
  std::vector<double> values;
  int wanted = -1;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    std::string cell;
    const bool header = wanted < 0;
    for (int i = 0; std::getline(cells, cell, ','); ++i) {
      if (header && cell.starts_with(name)) wanted = i;
      if (!header && i == wanted && !cell.empty()) values.push_back(std::stod(cell));
    }
    if (header && wanted < 0) break;
  }
  return values;
}

// Largest less smallest value of a column among the nodes of one output, in the output where that is most.
double differences(const fs::path& file, const std::string& name) {
  const std::vector<double> values = column(file, name), increments = column(file, "increment");
  EXPECT_EQ(values.size(), increments.size());
  double most = 0.0;
  for (std::size_t i = 0, begin = 0; i < values.size(); ++i) {
    if (increments[i] != increments[begin]) begin = i;
    for (std::size_t k = begin; k < i; ++k) most = std::max(most, std::abs(values[i] - values[k]));
  }
  return most;
}

struct Collapse {
  Finished run;
  double motion = 0.0;  // largest so far: difference of displacements along an axis over the extent along it
  double load = 0.0;    // the last in equilibrium, over c
  std::string listing;
};

Collapse collapse(const std::string& name, const Footing& footing) {
  const fs::path folder = empty_folder(name);
  write(folder / "deck.dat", footing.text());
  Collapse result;
  result.run = sagefe(folder, "run deck.dat -o out --nodes");
  result.listing = read(folder / "out/deck.lst");
  result.motion = std::max(differences(folder / "out/deck.nodes.csv", "ux") / (1.0 + footing.width),
                           differences(folder / "out/deck.nodes.csv", "uy") / footing.depth);
  const std::vector<double> factors = column(folder / "out/deck.increments.csv", "load_factor");
  result.load = factors.empty() ? 0.0 : footing.load * factors.back();
  const std::vector<double> shares = column(folder / "out/deck.increments.csv", "displacement_over_extent");
  EXPECT_FALSE(shares.empty());
  if (!shares.empty() && shares.back() > 0.0) {
    EXPECT_NEAR(shares.back(), result.motion, 1e-6 * shares.back());
  }
  return result;
}

// Near nu = 1/2 a motion that runs away makes self-balancing stress, beside which the whole load was small
// enough to be left out of balance: a step of 2e6 m (the first) and loads of seven times the collapse load (the
// second) were in equilibrium "to the tolerance".
TEST(Collapse, StressOfTheMotionItselfIsNoMeasureOfEquilibrium) {
  Footing matrix_kept;
  matrix_kept.tolerance = 1e-6;
  Footing initial;
  initial.E = 298.0;
  initial.formulation = 1;
  initial.inside = initial.down = 5;
  initial.outside = 3;
  initial.width = 1.0;
  initial.depth = 3.0;
  initial.power = 2.2;
  initial.load = 100.0;
  initial.increments = 5;
  initial.method = 2;
  initial.iterations = 50;
  initial.tolerance = 1e-4;
  for (const Footing& footing : {matrix_kept, initial}) {
    const Collapse end = collapse("self_balanced", footing);
    EXPECT_EQ(end.run.exit_code, 3);
    EXPECT_LT(end.motion, 0.2);
    // Meshes of three to five elements under the half width: 1 % below to 7 % above Prandtl.
    EXPECT_GT(end.load, 0.99 * (2 + kPi));
    EXPECT_LT(end.load, 1.07 * (2 + kPi));
    EXPECT_EQ(end.run.out.find("beyond small strains"), std::string::npos) << end.run.out;
  }
}

// A column of clay (strength 20) within a filling of E = 1e-7 on the same nodes: 30 are in
// equilibrium only after about 10 / 1e-7 = 10^8 times the column's height, which is no answer to a
// load; up to 20 nothing is refused.
TEST(Collapse, AStepOfFlowWithoutEndIsRefused) {
  const DeckText deck = collapse_deck()
                            .with("control", card({"1", "0", "4", "0", "2", "2", "2", "2", "0", "1", "0"}))
                            .behind("parameters", "filling", card({"2", "1", "2"}, {""}) + "filling")
                            .behind("filling", "filling_parameters", card({}, {"1.E-7", ".3"}))
                            .behind("group", "filling_group", card({"2", "1", "", "2"}))
                            .behind("element", "filling_element", card({"2", "2", "1", "2", "4", "3"}));
  const fs::path folder = empty_folder("refused");
  write(folder / "deck.dat", deck.text());
  const Finished run = sagefe(folder, "run deck.dat -o out");
  EXPECT_EQ(run.exit_code, 3) << run.out;
  EXPECT_NE(run.err.find("refused: a step of this increment balances its forces only after a motion of"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(run.out.find("beyond small strains"), std::string::npos) << run.out;
  // c_u = 10 in plane strain stands 20 of pressure: 2/3 of the stage.
  const std::vector<double> factors = column(folder / "out/deck.increments.csv", "load_factor");
  ASSERT_FALSE(factors.empty());
  EXPECT_NEAR(factors.back(), 2.0 / 3.0, 0.1 / 4096 * 2);
}

// A coarse mesh stands a load a little above collapse by moving thrice its size: that stands wherever the
// result is, and does not read like an ordinary one.
TEST(Collapse, DisplacementsBeyondSmallStrainsAreNamed) {
  Footing footing;
  footing.law = 3;
  footing.nu = 0.3;
  footing.E = 100.0;
  footing.formulation = 1;
  footing.inside = 2;
  footing.outside = footing.down = 3;
  footing.depth = 3.0;
  footing.load = 5.3;
  footing.increments = 3;
  footing.method = 0;
  footing.iterations = 0;
  const Collapse end = collapse("large_motion", footing);
  ASSERT_GT(end.motion, 0.2);
  EXPECT_EQ(end.run.out.find("every increment in equilibrium"), std::string::npos) << end.run.out;
  EXPECT_NE(end.run.out.find("times the model's size, beyond small strains"), std::string::npos) << end.run.out;
  EXPECT_NE(end.listing.find("times the model's size: results that suppose small strains"), std::string::npos);
  EXPECT_NE(end.listing.find("times the model's size, beyond small strains"), std::string::npos);
}

// A layer 100 m wide and 1 m high with a node far away that no element has, its top moved by `down` and
// everything moved along by `along`: strains of 30 % are named, a translation is none.
TEST(Collapse, AThinLayersStrainIsNamedAndATranslationIsNot) {
  for (const auto& [down, along] : {std::pair{0.3, 0.0}, std::pair{0.0, 50.0}}) {
    DeckWriter deck(1);
    for (int i = 0; i < 4; ++i) deck.node(i + 1, 100.0 * (i % 2), i / 2);
    deck.node(5, 1e4, 1e4);
    deck.material(1, 1, {1e4, 0.3});
    deck.group(1, 1, 0, 1);
    deck.element(1, 1, {1, 2, 4, 3});
    scenes::StageCards& stage = deck.stage();
    for (int node = 1; node <= 4; ++node)
      stage.fix(node, node % 2, 1, node % 2 == 1 ? along : 0.0, node > 2 ? -down : 0.0);
    const fs::path folder = empty_folder("thin");
    write(folder / "deck.dat", deck.text());
    const Finished run = sagefe(folder, "run deck.dat -o out");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out.find("0.3 times the model's size, beyond small strains") != std::string::npos, down > 0.0)
        << run.out;
    EXPECT_EQ(run.out.find("every increment in equilibrium") != std::string::npos, down == 0.0) << run.out;
  }
}

// legacy_inputs/hyperbolic/strip_footing/README.md: with five layers quad8 stop at 40 of 200 kPa, and more
// increments or iterations do not help.
TEST(Collapse, FewerLayersAreTheAdviceWhereUniquenessIsLostOnAGradedMesh) {
  const fs::path folder = empty_folder("layers");
  fs::copy(SAGE_SOURCE_DIR "/legacy_inputs/hyperbolic/strip_footing/deck.dat", folder / "deck.dat");
  const Finished graded = sagefe(folder, "run deck.dat -o out --grade auto --element quad8");
  EXPECT_EQ(graded.exit_code, 3);
  EXPECT_NE(graded.err.find("loss of uniqueness"), std::string::npos) << graded.err;
  EXPECT_NE(graded.err.find("try: fewer layers of grading (--grade auto:2)"), std::string::npos) << graded.err;
}

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// A rough strip with phi = 30 and psi = 0.  An explicit code of others follows this mesh to 78.7 +- 1.3 kN after a first peak
// of 83.5; the associated load is 95.0.  Newton's method alone stops in the second of 60 increments with 31.8.  Half of
// the push shows the plateau; a tenth of it, under sanitizers, runs the same lines.
TEST(Collapse, FootingWithoutDilationReachesItsPlateau) {
  const fs::path folder = empty_folder("no_dilation");
  const std::string increments = kSanitized ? "        10" : "        30",
                    settlement = kSanitized ? "-.01" : "-.05";
  std::string deck = read(SAGE_SOURCE_DIR "/tests/regression/data/footing_phi30_psi0_quad8.dat");
  deck = with_replaced(deck, "\n        60         0        60 ", "\n" + increments + "         0        60 ");
  write(folder / "push.dat", with_replaced(deck, "-0.1\n", settlement + "\n"));
  const Finished run = sagefe(folder, "run push.dat -o out");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_NE(run.out.find("  push        stage 2: force along the motion"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("dilation is less than friction"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("S550"), std::string::npos) << run.out;
  if (kSanitized) return;
  const std::vector<double> forces = column(folder / "out/push.report1.csv", "fy");
  ASSERT_EQ(forces.size(), 30u);
  const Plateau plateau = plateau_of(forces);
  EXPECT_NEAR(-plateau.mean, 78.7, 1.6);
  EXPECT_LT(-*std::ranges::min_element(forces), 0.95 * 95.0);
}

// With phi = 20 the motion alone follows a smooth path: from increment to increment the load changes by at most .01 kN.  Steps
// of Newton's method between those of the motion make it change by up to .23.
TEST(Collapse, RelaxedPushIsSmooth) {
  const fs::path folder = empty_folder("smooth_push");
  std::string deck = read(SAGE_SOURCE_DIR "/tests/regression/data/footing_phi30_psi0_quad8.dat");
  deck = with_replaced(deck, "\n        60         0        60 ", "\n        30         0        60 ");
  deck = with_replaced(deck, "                 30.                  0.\n",
                       "                 20.                  0.\n");
  write(folder / "push.dat", with_replaced(deck, "-0.1\n", "-.03\n"));
  const Finished run = sagefe(folder, "run push.dat -o out");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const std::vector<double> forces = column(folder / "out/push.report1.csv", "fy");
  ASSERT_EQ(forces.size(), 30u);
  for (std::size_t i = 15; i < forces.size(); ++i) EXPECT_NEAR(forces[i], forces[i - 1], 0.04) << i;
}

TEST(Collapse, PlateauOfTheSecondHalf) {
  const Plateau plateau = plateau_of({1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 6.0, 10.0});
  EXPECT_DOUBLE_EQ(plateau.mean, 7.0);
  EXPECT_DOUBLE_EQ(plateau.scatter, std::sqrt(14.0 / 4.0));
  EXPECT_DOUBLE_EQ(plateau.third_quarter, 6.0);
  EXPECT_DOUBLE_EQ(plateau.last_quarter, 8.0);
}

}  // namespace
}  // namespace sage::test
