// Bars, springs and beams in whole runs: cards, stages, soil beside them, results and messages.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/messages/error.hpp"
#include "sage/model/dof_map.hpp"
#include "tests/support/csv_column.hpp"
#include "tests/support/run_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::test {
namespace {

constexpr int kBar2 = 31, kRing = 34, kBeam2 = 35, kBeam3 = 36, kHinged = 37;
constexpr int kAxial = 31, kOneWay = 32, kPlate = 35, kSection = 36, kPlastic = 37;

std::string held(int node, const std::string& unknown = "rotation") {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}{}", node, 0, 0, 1, 0, "", unknown);
}
std::string moment(int node, double value) {
  return fmt::format("{:5}{:5}{:5}{}{:10}rotation", node, 0, 0, ten_columns(value), "");
}

double rotation(const WholeRun& run, int node) {
  const DofMap map(*run.model);
  return run.last().u[map.of(run.index(node), find_unknown(run.model->unknowns, "rotation"))];
}

std::string refusal(const DeckWriter& deck) {
  try {
    run_text(deck.text());
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// Nodes 1 to n + 1 and beams 1 to n along x from 0 to L, clamped at node 1.
DeckWriter cantilever(int n, double L, int law, const std::vector<double>& parameters) {
  DeckWriter deck(1);
  for (int i = 0; i <= n; ++i) deck.node(i + 1, L * i / n, 0.0);
  deck.material(1, law, parameters);
  deck.group(1, kBeam2, 0, 1);
  for (int i = 1; i <= n; ++i) deck.element(i, 1, {i, i + 1});
  deck.fix(1, 1, 1);
  deck.fixities.push_back(held(1));
  return deck;
}

// EI = 1e4/12, GA = 1e4/3; force P and moment M at the tip.
TEST(Structures, ACantileverByCards) {
  DeckWriter deck = cantilever(4, 10.0, kPlate, {1e4, 0.25, 1.0, 0.0});
  StageCards& stage = deck.stage();
  stage.load(5, 0.0, 1.0);
  stage.loads.push_back(moment(5, 2.0));
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double EI = 1e4 / 12.0, GA = 1e4 / 3.0;
  EXPECT_NEAR(run.u(5).y(), 1000.0 / (3.0 * EI) + 10.0 / GA + 2.0 * 50.0 / EI, 1e-10);
  EXPECT_NEAR(rotation(run, 5), 50.0 / EI + 2.0 * 10.0 / EI, 1e-11);
  EXPECT_NEAR(run.stress[0](3, 0), 12.0, 1e-9);  // M at the clamp
  EXPECT_NEAR(run.stress[0](3, 11), 2.0, 1e-9);  // and at the tip
  EXPECT_NEAR(run.stress[0](2, 5), 1.0, 1e-10);  // Q
  EXPECT_NEAR(run.reaction(1).y(), -1.0, 1e-10);
}

// Forces are then the rounding of rotations, and moments that of displacements: the step ends all the same.
TEST(Structures, MomentsAloneAndMotionsWithoutForceConverge) {
  for (const int n : {1, 2, 4, 16}) {
    DeckWriter bent = cantilever(n, 5.0, kPlate, {3e7, 0.2, 0.4, 0.0});
    bent.stage().loads.push_back(moment(n + 1, 50.0));
    const WholeRun run = run_text(bent.text());
    ASSERT_TRUE(run.completed()) << n << " " << run.failure;
    const double EI = 50.0 * 5.0 / rotation(run, n + 1);
    EXPECT_NEAR(run.stress[0](3, 0), 50.0, 50.0 * 1e-9) << n;
    EXPECT_NEAR(run.u(n + 1).y(), 50.0 * 25.0 / (2.0 * EI), 1e-9 * run.u(n + 1).y()) << n;

    DeckWriter moved = cantilever(n, 5.0, kPlate, {3e7, 0.2, 0.4, 0.0});
    moved.stage().fix(1, 1, 1, 0.01, 0.01);
    const WholeRun rigid = run_text(moved.text());
    ASSERT_TRUE(rigid.completed()) << n << " " << rigid.failure;
    EXPECT_NEAR(rigid.u(n + 1).y(), 0.01, 1e-12) << n;
  }
}

// A thousand beams in a row: the rounding of displacements makes forces of 1e-7 of the load, which no correction balances.
// With a matrix of its own in each iteration the linear step ends there too; where it may not go on so far
// it fails without a word about collapse.
TEST(Structures, LinearBeamsConvergeWithoutKeptFactors) {
  constexpr int kMany = 1000;
  const double EA = 1e6, EI = 1e4, L = 10.0;
  DeckWriter deck = cantilever(kMany, L, kSection, {EA, EI});
  deck.stage(2).load(kMany + 1, 0.0, 1.0);
  RunSettings own, all;
  own.skips.factors = false;
  for (const SkipName& skip : kSkipNames) all.skips.*skip.flag = false;
  for (const RunSettings& settings : {RunSettings{}, own, all}) {
    const WholeRun run = run_text(deck.text(), {}, settings);
    ASSERT_TRUE(run.completed()) << run.failure;
    const double tip = L * L * L / (3.0 * EI) + L / (5.0 / 12.0 * EA);  // bending and shear, GA = 5/12 EA
    EXPECT_NEAR(run.u(kMany + 1).y(), tip, 1e-6 * tip);
  }
  deck.stages[0].max_iterations = 2;
  const WholeRun failed = run_text(deck.text(), {}, own);
  ASSERT_FALSE(failed.completed());
  EXPECT_NE(failed.failure.find("no equilibrium found"), std::string::npos) << failed.failure;
  for (const char* words : {"collapse", "limit load", "mechanism", "displacement control", "equilibrium ends"})
    EXPECT_EQ(failed.failure.find(words), std::string::npos) << failed.failure;
}

// Clamped at 1, a hinge at 3, a roller at 5; P in the middle of the hung span: half of it hangs on the hinge.
TEST(Structures, AHingeCarriesNoMoment) {
  DeckWriter deck(1);
  for (int i = 0; i < 5; ++i) deck.node(i + 1, 2.0 * i, 0.0);
  deck.material(1, kSection, {1e6, 1e4, 4e5});
  deck.group(1, kBeam2, 0, 1);
  deck.group(2, kHinged, 0, 1);
  deck.element(1, 1, {1, 2});
  deck.element(2, 1, {2, 3});
  deck.element(3, 2, {3, 4});
  deck.element(4, 1, {4, 5});
  deck.fix(1, 1, 1);
  deck.fix(5, 0, 1);
  deck.fixities.push_back(held(1));
  deck.stage().load(4, 0.0, -8.0);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.stress[0](3, 0), -4.0 * 4.0, 1e-9);
  EXPECT_NEAR(run.stress[1](3, 0), 0.0, 1e-9);
  EXPECT_NEAR(run.stress[1](3, 2), 8.0, 1e-9);
  EXPECT_NEAR(run.reaction(5).y(), 4.0, 1e-10);
}

TEST(Structures, BeamsThatNothingHoldsAreNamed) {
  DeckWriter deck(1);
  deck.node(1, 0.0, 0.0);
  deck.node(2, 3.0, 0.0);
  deck.material(1, kSection, {1e6, 1e4});
  deck.group(1, kBeam2, 0, 1);
  deck.element(1, 1, {1, 2});
  deck.fix(1, 1, 1);
  deck.stage().load(2, 0.0, -8.0);
  const std::string words = refusal(deck);
  EXPECT_NE(words.find("against a rigid rotation"), std::string::npos) << words;
  EXPECT_NE(words.find("no rotation support"), std::string::npos) << words;
  deck.fixities.push_back(held(2, "rotations"));
  EXPECT_NE(refusal(deck).find("no element of the deck solves for rotations"), std::string::npos);
  deck.fixities.back() = held(2);
  EXPECT_EQ(refusal(deck), "accepted");
}

// A polygon that shrinks evenly, all its nodes held: thrust EA e and no moment but rounding, which no iteration can
// balance.
TEST(Structures, AHeldPolygonIsInEquilibrium) {
  constexpr double kRadius = 10.0, kStrain = 2e-3, kE = 3e7, kThickness = 0.2, kNu = 0.3;
  for (const int n : {3, 6, 12})
    for (const double load : {1.0, 1e-3}) {
      DeckWriter deck(1);
      deck.material(1, kPlate, {kE, kNu, kThickness, 1.0});
      deck.group(1, kBeam2, 0, 1);
      for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n, x = kRadius * std::cos(angle),
                     y = kRadius * std::sin(angle);
        deck.node(i + 1, x, y);
        deck.element(i + 1, 1, {i + 1, i + 1 < n ? i + 2 : 1});
      }
      StageCards& stage = deck.stage();
      for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        stage.fix(i + 1, 1, 1, -load * kStrain * kRadius * std::cos(angle),
                  -load * kStrain * kRadius * std::sin(angle));
      }
      const WholeRun run = run_text(deck.text());
      ASSERT_EQ(run.result.status, RunStatus::completed) << n << ": " << run.failure;
      // Fields of ten columns hold seven digits of a displacement, of the smaller one fewer.
      const double thrust = kE / (1.0 - kNu * kNu) * kThickness * load * kStrain;
      const DofMap map(*run.model);
      const int dof = map.of(run.index(1), 0, 0);
      const double beside = std::sin(std::numbers::pi / n);  // both sides pull at the node
      EXPECT_NEAR(std::abs(run.last().internal[dof]), 2.0 * thrust * beside, 1e-3 * thrust) << n;
    }
}

TEST(Structures, ARingIsForAxisymmetry) {
  DeckWriter deck(1);
  deck.node(1, 2.0, 0.0);
  deck.material(1, kAxial, {100.0});
  deck.group(1, kRing, 0, 1);
  deck.element(1, 1, {1, 1});
  deck.fix(1, 0, 1);
  deck.stage().load(1, 1.0, 0.0);
  EXPECT_NE(refusal(deck).find("ring1 is for axisymmetry"), std::string::npos) << refusal(deck);
  deck.geometry = 2;
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.u(1).x(), 1.0 * 2.0 / (2.0 * kPi * 100.0), 1e-14);  // P r/(2 pi EA)
}

// A node on a tie (EA/L = 50) is loaded, then a strut (EA/L = 100) is put in without force where the node has gone
// to, loaded with it, and taken away.
TEST(Structures, AStrutComesAndGoesWithoutForce) {
  for (const double prestress : {0.0, 6.0}) {
    DeckWriter deck(1);
    deck.node(1, 0.0, 0.0);
    deck.node(2, 2.0, 0.0);
    deck.node(3, 6.0, 0.0);
    deck.material(1, kAxial, {100.0});
    deck.material(2, kAxial, {800.0, 2.0});  // 800 of a strut, every 2
    deck.group(1, kBar2, 0, 1);
    deck.group(2, kBar2, 0, 2);
    deck.element(1, 1, {1, 2});
    deck.element(2, 2, {2, 3});
    for (const int node : {1, 3}) deck.fix(node, 1, 1);
    deck.fix(2, 0, 1);
    deck.stage().load(2, 5.0, 0.0);
    StageCards& in = deck.stage();
    in.births = {2};
    if (prestress > 0.0) in.initial(2, 0, prestress);  // compression
    deck.stage().load(2, 3.0, 0.0);
    deck.stage().deaths = {2};
    const WholeRun run = run_text(deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    const double k = 50.0, strut = 100.0, pushed = prestress / (k + strut);
    const auto u = [&](std::size_t stage) { return run.increments[stage].u[2 * run.index(2)]; };
    EXPECT_NEAR(u(0), 5.0 / k, 1e-14);
    EXPECT_NEAR(u(1), 5.0 / k - pushed, 1e-14);
    EXPECT_NEAR(u(2), 5.0 / k - pushed + 3.0 / (k + strut), 1e-14);
    EXPECT_NEAR(u(3), 8.0 / k, 1e-14);
  }
}

// Two ties across a node, of which one is slack: it takes up its load where it left off.
TEST(Structures, ATieDoesNotPush) {
  DeckWriter deck(1);
  for (int i = 0; i < 3; ++i) deck.node(i + 1, 2.0 * i, 0.0);
  deck.material(1, kOneWay, {100.0});
  deck.group(1, kBar2, 0, 1);
  deck.element(1, 1, {1, 2});
  deck.element(2, 1, {2, 3});
  for (const int node : {1, 3}) deck.fix(node, 1, 1);
  deck.fix(2, 0, 1);
  for (const double load : {5.0, -5.0, -3.0}) deck.stage().load(2, load, 0.0);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double wanted[] = {0.1, 0.0, -0.06};  // one tie at a time, EA/L = 50
  for (std::size_t s = 0; s < 3; ++s) EXPECT_NEAR(run.increments[s].u[2 * run.index(2)], wanted[s], 1e-12);
}

// Clamped at both ends under an even load the beam fails at q = 16 M_p/L^2.
TEST(Structures, ABeamFailsAtItsPlasticLoad) {
  for (const double share : {0.999, 1.001}) {
    DeckWriter deck = cantilever(8, 4.0, kPlastic, {1e6, 1e4, 0.0, 30.0});
    deck.fix(9, 1, 1);
    deck.fixities.push_back(held(9));
    StageCards& stage = deck.stage(10);
    for (int e = 1; e <= 8; ++e) stage.pressure(e, 1, -share * 30.0, -share * 30.0);
    EXPECT_EQ(run_text(deck.text()).completed(), share < 1.0);
  }
}

// Soil 8 x 2 held below, a beam along its top, pushed in the middle.
struct RaftOnSoil {
  int columns = 8, rows = 2, geometry = 1;
  double EA = 1e4, EI = 1e3;
  bool quadratic = false, mirrored = false, beam = true, reversed = false;
  std::vector<double> soil{1000.0, 0.3};
  int soil_law = 1, increments = 1;
  Block block{};

  DeckWriter deck() {
    DeckWriter deck(geometry);
    block.cell = quadratic ? Cell::quad8 : Cell::quad4;
    block.columns = columns;
    block.rows = rows;
    block.place = rectangle(mirrored ? 8.0 : 0.0, mirrored ? 0.0 : 8.0, 0.0, 2.0);
    if (mirrored) block.place = rectangle(-8.0, 0.0, 0.0, 2.0);
    block.write_nodes(deck);
    deck.material(1, soil_law, soil);
    deck.group(1, quadratic ? 2 : 1, 0, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    const std::vector<int> top = block.top();
    if (beam) {
      deck.material(2, kSection, {EA, EI});
      deck.group(2, quadratic ? kBeam3 : kBeam2, 0, 2);
      const std::size_t order = quadratic ? 2 : 1;
      for (std::size_t i = 0; i + order < top.size(); i += order) {
        const auto [a, z] = reversed ? std::pair{top[i + order], top[i]} : std::pair{top[i], top[i + order]};
        std::vector<int> nodes{a, z};
        if (quadratic) nodes.push_back(top[i + 1]);
        deck.element(1000 + static_cast<int>(i), 2, nodes);
      }
    }
    deck.stage(increments).load(loaded(), 1.0 * side(), -10.0);
    return deck;
  }
  double side() const { return mirrored ? -1.0 : 1.0; }
  int loaded() const {
    const std::vector<int> top = block.top();
    const std::size_t at = top.size() * 3 / 8;
    return mirrored ? top[top.size() - 1 - at] : top[at];
  }
};

double largest_difference(const WholeRun& a, const WholeRun& b) {
  const Eigen::Index n = std::min(a.last().u.size(), b.last().u.size());
  return (a.last().u.head(n) - b.last().u.head(n)).cwiseAbs().maxCoeff() / a.largest_u();
}

TEST(Structures, ABeamWithoutStiffnessChangesNothing) {
  RaftOnSoil with, without;
  with.EA = with.EI = 1e-9;  // 1e-12 of the soil's
  without.beam = false;
  const WholeRun a = run_text(without.deck().text()), b = run_text(with.deck().text());
  ASSERT_TRUE(a.completed() && b.completed()) << b.failure;
  EXPECT_LT(largest_difference(a, b), 1e-10);
}

TEST(Structures, AStiffBeamStaysStraight) {
  RaftOnSoil raft;
  raft.EA = raft.EI = 1e11;
  const WholeRun run = run_text(raft.deck().text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const std::vector<int> top = raft.block.top();
  const double turn = rotation(run, top.front());
  for (std::size_t i = 0; i < top.size(); ++i) {
    const double y = run.u(top.front()).y() + turn * 8.0 * static_cast<double>(i) / 8.0;
    EXPECT_NEAR(run.u(top[i]).y(), y, 1e-6 * run.largest_u());
    EXPECT_NEAR(run.u(top[i]).x(), run.u(top.front()).x(), 1e-6 * run.largest_u());
  }
}

// The same to 1e-10 with reversed beams, and mirrored; of both kinds of sides.
TEST(Structures, ReversedAndMirroredAreTheSame) {
  for (const bool quadratic : {false, true}) {
    RaftOnSoil raft, reversed, mirrored;
    raft.quadratic = reversed.quadratic = mirrored.quadratic = quadratic;
    reversed.reversed = true;
    mirrored.mirrored = true;
    const WholeRun a = run_text(raft.deck().text()), b = run_text(reversed.deck().text()),
                   c = run_text(mirrored.deck().text());
    ASSERT_TRUE(a.completed() && b.completed() && c.completed()) << a.failure;
    EXPECT_LT(largest_difference(a, b), 1e-10);
    const std::vector<int> top = raft.block.top();
    for (std::size_t i = 0; i < top.size(); ++i) {
      const Vector2 here = a.u(top[i]), there = c.u(top[top.size() - 1 - i]);
      EXPECT_NEAR(here.x(), -there.x(), 1e-10 * a.largest_u());
      EXPECT_NEAR(here.y(), there.y(), 1e-10 * a.largest_u());
      EXPECT_NEAR(rotation(a, top[i]), -rotation(c, top[top.size() - 1 - i]), 1e-10);
    }
  }
}

// A refined mesh takes the beam along: the same as the finer mesh by cards.
TEST(Structures, ABeamIsRefinedWithItsSoil) {
  for (const bool quadratic : {false, true}) {
    RaftOnSoil coarse, fine;
    coarse.quadratic = fine.quadratic = quadratic;
    fine.columns = 16;
    fine.rows = 4;
    BuildOptions options;
    options.refine = 1;
    const WholeRun b = run_text(fine.deck().text());
    DeckWriter deck = coarse.deck();
    const Vector2 at = b.position(fine.loaded());
    ASSERT_EQ(at.x(), 3.0);
    const WholeRun a = run_text(deck.text(), options);
    ASSERT_TRUE(a.completed() && b.completed()) << a.failure << b.failure;
    EXPECT_EQ(a.model->groups[1].elements(), b.model->groups[1].elements());
    EXPECT_NEAR(a.u(coarse.loaded()).y(), b.u(fine.loaded()).y(), 1e-11 * a.largest_u());
  }
}

// With the solids' sides their beams get a node in the middle; where they can't, a warning says so.
TEST(Structures, OtherSolidsGetOtherBeams) {
  RaftOnSoil raft, by_cards;
  by_cards.quadratic = true;
  const std::string deck = raft.deck().text();
  BuildOptions options;
  options.element = 2;
  const WholeRun a = run_text(deck, options), b = run_text(by_cards.deck().text());
  ASSERT_TRUE(a.completed() && b.completed()) << a.failure << b.failure;
  EXPECT_EQ(a.model->groups[1].entry->name, "beam3");
  EXPECT_NEAR(a.u(raft.loaded()).y(), b.u(by_cards.loaded()).y(), 1e-10 * a.largest_u());
  EXPECT_FALSE(a.warns("are not connected"));
  options.element = 7;
  EXPECT_THROW(run_text(deck, options), InputError) << "no beam has the five nodes of a side";
}

// Plastic soil beside a beam; skipping work that isn't needed changes nothing, nor does a restart.
TEST(Structures, NonlinearSoilSkipsAndRestarts) {
  RaftOnSoil raft;
  raft.soil_law = 4;
  raft.soil = {1000.0, 0.3, 3.0, 25.0, 0.0};
  raft.increments = 4;
  const std::string deck = raft.deck().text();
  std::vector<std::string> checkpoints;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { checkpoints.push_back(bytes); };
  const WholeRun whole = run_text(deck, {}, settings);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  RunSettings plain;
  plain.skips.elements = plain.skips.states = plain.skips.condensation = false;
  EXPECT_LT(largest_difference(whole, run_text(deck, {}, plain)), 1e-9);
  for (const std::string& bytes : checkpoints) {
    RunSettings again;
    again.resume_from = bytes;
    const WholeRun resumed = run_text(deck, {}, again);
    ASSERT_TRUE(resumed.completed());
    EXPECT_TRUE(resumed.last().u == whole.last().u);
    EXPECT_TRUE(resumed.stress[1] == whole.stress[1]);
  }
}

// A wall between two bodies of soil, 4 x 4 each, held below: on the nodes that they share, or with nodes of its own
// and stiff joints on both sides.  Pushed at the upper left corner; in axisymmetry a shaft with soil in and around.
WholeRun run_wall(int geometry, bool joints) {
  constexpr int n = 8;
  DeckWriter deck(geometry);
  Block left, right;
  left.columns = left.rows = right.columns = right.rows = n;
  left.place = rectangle(1.0, 5.0, 0.0, 4.0);
  right.place = rectangle(5.0, 9.0, 0.0, 4.0);
  right.first_node = 1001;
  right.first_element = 1001;
  deck.material(1, 1, {1000.0, 0.3});
  deck.material(2, kSection, {1e5, 1e3, 4e4, 1e5, 1e3});
  deck.material(3, 21, {1e9, 1e9, 1.0});
  deck.group(1, 1, 0, 1);
  deck.group(2, kBeam2, 0, 2);
  left.write_nodes(deck);
  left.write_elements(deck, 1);
  std::vector<int> wall = left.right();
  if (joints) {
    deck.group(3, 11, 2, 3);
    right.write_nodes(deck);
    right.write_elements(deck, 1);
    wall = copy_row(deck, left, left.right(), 2001);
    join(deck, 3001, 3, wall, left.right(), 1);
    join(deck, 4001, 3, right.left(), wall, 1);
  } else {
    const std::vector<int> edge = left.right();
    for (int j = 0; j < right.up(); ++j)
      for (int i = 1; i < right.across(); ++i)
        deck.node(right.node(i, j), right.at(i, j).x(), right.at(i, j).y());
    const auto of = [&](int i, int j) { return i == 0 ? edge[j] : right.node(i, j); };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        deck.element(right.element(i, j), 1, {of(i, j), of(i + 1, j), of(i + 1, j + 1), of(i, j + 1)});
  }
  for (std::size_t i = 0; i + 1 < wall.size(); ++i)
    deck.element(6001 + static_cast<int>(i), 2, {wall[i], wall[i + 1]});
  for (const int node : left.bottom()) deck.fix(node, 1, 1);
  for (const int node : right.bottom())
    if (joints || node != right.bottom().front()) deck.fix(node, 1, 1);
  deck.fix(wall.front(), 1, 1);
  deck.stage().load(left.node(0, n), 10.0, 0.0);
  return run_text(deck.text());
}

TEST(Structures, StiffJointsOnBothSidesAreAsSharedNodes) {
  for (const int geometry : {1, 2}) {
    const WholeRun shared = run_wall(geometry, false), apart = run_wall(geometry, true);
    ASSERT_TRUE(shared.completed() && apart.completed()) << shared.failure << apart.failure;
    const double size = shared.largest_u();
    for (int j = 0; j <= 8; ++j)
      EXPECT_LT((shared.u(9 * j + 9) - apart.u(2001 + j)).norm(), 1e-5 * size) << j;  // E/(k h) = 2e-6
    const Eigen::RowVectorXd M = shared.stress[1].row(3);
    EXPECT_LT((M - apart.stress[1].row(3)).cwiseAbs().maxCoeff(), 1e-4 * M.cwiseAbs().maxCoeff());
    EXPECT_GT(M.cwiseAbs().maxCoeff(), 1e-3);
  }
}

// A circular plate to the axis by cards: what can't turn there is held by symmetry.
TEST(Structures, APlateReachesTheAxis) {
  DeckWriter deck(2);
  constexpr int n = 32;
  for (int i = 0; i <= n; ++i) deck.node(i + 1, i / 32.0, 0.0);
  deck.material(1, kPlate, {1000.0, 0.3, 0.1});
  deck.group(1, kBeam2, 0, 1);
  for (int i = 1; i <= n; ++i) deck.element(i, 1, {i, i + 1});
  deck.fix(n + 1, 1, 1);
  deck.fixities.push_back(held(n + 1));
  StageCards& stage = deck.stage();
  for (int e = 1; e <= n; ++e) stage.pressure(e, 1, -1.0, -1.0);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.u(1).y(), -0.178425, 1e-4 * 0.178425);
  EXPECT_EQ(rotation(run, 1), 0.0);
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// N, Q and M at both ends, in the table of structures, listing and VTU.
TEST(Structures, ForcesAtBothEndsAreInTheOutputs) {
  DeckWriter deck = cantilever(2, 10.0, kSection, {1e6, 1e4, 4e5});
  StageCards& stage = deck.stage();
  stage.load(3, -5.0, 1.0);
  const std::filesystem::path folder = scratch_folder("structures");
  std::ofstream(folder / "deck.dat") << deck.text();
  app::RunRequest request;
  request.deck = (folder / "deck.dat").string();
  request.quiet = true;
  request.stem = "deck";
  request.output.folder = folder;
  request.output.points = request.output.nodes = request.output.vtu = true;
  request.output.tables = Tables::all;
  ASSERT_EQ(app::run_deck(request, app::full_catalogue()).exit_code, app::kOk);
  const std::string table = contents(folder / "deck.structures.csv");
  EXPECT_NE(table.find("axial_force[kN],axial_strain[-],shear_force[kN],bending_moment[kN m]"),
            std::string::npos)
      << table;
  const std::vector<double> M = csv_column(table, "bending_moment"), Q = csv_column(table, "shear_force"),
                            N = csv_column(table, "axial_force");
  ASSERT_EQ(M.size(), 6u);
  const double wanted[] = {10.0, 7.5, 5.0, 5.0, 2.5, 0.0};
  for (std::size_t p = 0; p < 6; ++p) {
    EXPECT_NEAR(M[p], wanted[p], 1e-8);
    EXPECT_NEAR(Q[p], 1.0, 1e-9);
    EXPECT_NEAR(N[p], 5.0, 1e-9);  // compression
  }
  EXPECT_NE(contents(folder / "deck.lst").find("bending_moment [kN m]"), std::string::npos);
  EXPECT_NE(contents(folder / "deck.nodes.csv").find("rotation_reaction[kN m]"), std::string::npos);
  EXPECT_NE(contents(folder / "deck_0001.vtu").find("Name=\"bending_moment\""), std::string::npos);
}

}  // namespace
}  // namespace sage::test
