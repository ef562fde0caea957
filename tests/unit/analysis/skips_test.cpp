// What a run leaves out must not change what comes out: each skip off, and all off, against all on.
#include <gtest/gtest.h>

#include "sage/app/commands.hpp"
#include "tests/support/run_text.hpp"
#include "tests/support/same_increments.hpp"

namespace sage::test {
namespace {

// An elastic specimen on a hyperbolic interface: a large linear region.  Increments are
// many enough to condense it.
std::string friction(int columns = 8, int increments = 10) {
  SpecimenDeck deck;
  deck.columns = columns;
  deck.rows = 2 * columns;
  deck.increments = increments;
  return deck.text();
}

std::string plastic() {
  SpecimenDeck deck;
  deck.columns = 5;
  deck.rows = 8;
  deck.increments = 10;
  deck.axial_strain = 0.06;
  deck.drucker_prager = true;
  return deck.text();
}

// Ground that is filled and dug, elastic or strong enough to stay so for a while; K0 stress at the start.
std::string staged(int law, double cohesion) {
  DeckWriter deck(1);
  Block ground{8, 4, Cell::quad8, 1, 1, rectangle(0.0, 8.0, -4.0, 0.0)};
  ground.write_nodes(deck);
  for (int n : ground.left()) deck.fix(n, 1, 0);
  for (int n : ground.right()) deck.fix(n, 1, 0);
  for (int n : ground.bottom()) deck.fix(n, 1, 1);
  deck.material(1, law,
                law == 1 ? std::vector<double>{1e4, 0.3} : std::vector<double>{1e4, 0.3, cohesion, 30.0, 0.0},
                20.0);
  for (int g : {1, 2}) deck.group(g, 2, 0, 1);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i) {
      const auto n = [&](int a, int b) { return ground.node(2 * i + a, 2 * j + b); };
      deck.element(ground.element(i, j), j >= 2 && i < 3 ? 2 : 1,
                   {n(0, 0), n(2, 0), n(2, 2), n(0, 2), n(1, 0), n(2, 1), n(1, 2), n(0, 1)});
    }
  for (int g : {1, 2}) deck.initial(g, 1, 0.0, 20.0, 0.5, 0.0);
  deck.stage(1).gravity_y = -1.0;
  deck.stage(4).deaths = {2};
  StageCards& load = deck.stage(4);
  load.pressure(ground.element(6, 3), 3, 30.0, 30.0);
  load.pressure(ground.element(7, 3), 3, 30.0, 30.0);
  return deck.text();
}

// 8 x 4 cells of one size, two increments.
std::string elastic_block(int geometry) {
  DeckWriter deck(geometry);
  Block block{8, 4, Cell::quad4, 1, 1, rectangle(0.0, 4.0, 0.0, 1.0)};
  block.write_nodes(deck);
  block.write_elements(deck, 1);
  deck.material(1, 1, {1e4, 0.3});
  deck.group(1, 1, 0, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  deck.stage(2).load(block.top().back(), 0.0, -1.0);
  return deck.text();
}

// An elastic block whose lower half is another material, moved down (-) or up by a platen behind a joint.
struct Layers {
  int geometry = 1;
  Cell cell = Cell::quad4;
  int columns = 8, rows = 8;
  std::vector<double> upper, lower, joint;  // parameters
  double pressure = 0.0;                    // all round, from the start
  std::vector<double> ways;                 // of the platen, a stage each
  int increments = 1;                       // of a stage
  double tolerance = 0.0;                   // 0 = 1e-8
};

std::string layered(const Layers& scene) {
  DeckWriter deck(scene.geometry);
  const bool quadratic = scene.cell == Cell::quad8;
  Block block{scene.columns, scene.rows, scene.cell, 1, 1, rectangle(0.0, 1.5, 0.0, 3.0)};
  block.write_nodes(deck);
  deck.material(1, 1, scene.upper);
  deck.material(2, 1, scene.lower);
  deck.material(3, 22, scene.joint);
  for (int g : {1, 2}) deck.group(g, static_cast<int>(scene.cell), 1, g);
  deck.group(3, quadratic ? 12 : 11, 0, 3);
  Block half = block;
  half.rows /= 2;
  half.write_elements(deck, 2);
  half.first_node = block.node(0, block.order() * half.rows);
  half.first_element = block.element(0, half.rows);
  half.write_elements(deck, 1);
  const std::vector<int> platen = copy_row(deck, block, block.top(), 1001);
  join(deck, 1001, 3, block.top(), platen, block.order());
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : platen) deck.fix(n, 1, 1);
  const double p = scene.pressure;
  if (p > 0.0)
    for (int g : {1, 2}) deck.initial(g, 0, p, p, p);
  for (double way : scene.ways) {
    StageCards& stage = deck.stage(scene.increments);
    stage.tolerance = scene.tolerance;
    for (int n : platen) stage.fix(n, 0, 1, 0.0, way);
    if (p == 0.0 || deck.stages.size() > 1) continue;
    for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(block.columns - 1, j), 2, p, p);
    for (int i = 0; i < block.columns; ++i) stage.pressure(block.element(i, block.rows - 1), 3, p, p);
  }
  return deck.text();
}

// The lower half a tenth as stiff, pushed down a long way for the upper one, whose stress is a small difference
// of displacements; the interface is rough and nearly rigid.
std::string free_of_stress_at_first(double tolerance = 0.0) {
  return layered({.geometry = 2,
                  .cell = Cell::quad8,
                  .columns = 4,
                  .upper = {3000.0, 0.3},
                  .lower = {300.0, 0.3},
                  .joint = {0.0, 28.5, 0.0, 0.0, 5000.0, 0.9, 1e5, 1e5, 0.0, 1.0},
                  .ways = {-0.03},
                  .increments = 10,
                  .tolerance = tolerance});
}

// A hyperbolic specimen under an elastic cap, on a rough base: cell pressure, then down, up and down again, in
// increments so long that the run divides some.
std::string capped(int law, const std::vector<double>& parameters, double tolerance = 0.0) {
  DeckWriter deck(2);
  Block block{4, 8, Cell::quad4, 1, 1, rectangle(0.0, 1.0, 0.0, 2.0)};
  block.write_nodes(deck);
  deck.material(1, 1, {1e5, 0.3});
  deck.material(2, law, parameters);
  for (int g : {1, 2}) deck.group(g, 1, 2, g);
  Block cap = block;
  block.rows = 6;
  block.write_elements(deck, 2);
  cap.rows = 2;
  cap.first_node = block.node(0, 6);
  cap.first_element = block.element(0, 6);
  cap.write_elements(deck, 1);
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : cap.left()) deck.fix(n, 1, 0);
  for (int g : {1, 2}) deck.initial(g, 0, 100.0, 100.0, 100.0);
  for (double down : {0.02, -0.01, 0.02}) {
    StageCards& stage = deck.stage(10);
    stage.tolerance = tolerance;
    for (int n : cap.top()) stage.fix(n, 0, 1, 0.0, -down);
    if (deck.stages.size() > 1) continue;
    for (int j = 0; j < 8; ++j) stage.pressure(block.element(3, j), 2, 100.0, 100.0);
  }
  return deck.text();
}

struct SkipCase {
  const char* name;
  std::string deck;
};

class Skipping : public testing::TestWithParam<SkipCase> {};

// Newton's residual is 1e-8 of the forces at most and quadratic convergence leaves far less; without the skips
// the sums are taken in another order.
void expect_same(const WholeRun& a, const WholeRun& b, double tolerance) {
  ASSERT_TRUE(a.completed()) << a.failure;
  expect_same_increments(a, b, tolerance);
}

// The same iteration, to its rounding.
RunSettings without_prediction() {
  RunSettings settings;
  settings.skips.prediction = false;
  return settings;
}

// A condensed region is not predicted: none is condensed here.  Without kept factors it is not known which steps were
// linear, so that others are predicted.
TEST_P(Skipping, EachSkipLeavesAPredictedResult) {
  RunSettings predicted;
  predicted.skips.condensation = false;
  const WholeRun all_on = run_text(GetParam().deck, {}, predicted);
  ASSERT_TRUE(all_on.completed()) << all_on.failure;
  for (const SkipName& skip : kSkipNames) {
    if (skip.name == "prediction" || skip.name == "factors") continue;  // other iterations
    SCOPED_TRACE(std::string(skip.name));
    RunSettings settings = predicted;
    settings.skips.*skip.flag = false;
    expect_same(run_text(GetParam().deck, {}, settings), all_on, 1e-10);
  }
}

TEST_P(Skipping, EachSkipLeavesTheResult) {
  const WholeRun all_on = run_text(GetParam().deck, {}, without_prediction());
  ASSERT_TRUE(all_on.completed()) << all_on.failure;
  RunSettings none;
  for (const SkipName& skip : kSkipNames) {
    SCOPED_TRACE(std::string(skip.name));
    RunSettings settings = without_prediction();
    settings.skips.*skip.flag = false;
    none.skips.*skip.flag = false;
    expect_same(run_text(GetParam().deck, {}, settings), all_on, 1e-10);
  }
  SCOPED_TRACE("all");
  expect_same(run_text(GetParam().deck, {}, none), all_on, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Skipping,
    testing::Values(SkipCase{"Friction", friction()}, SkipCase{"Plastic", plastic()},
                    SkipCase{"StagedElastic", staged(1, 0.0)}, SkipCase{"StagedPlastic", staged(4, 5.0)},
                    SkipCase{"StagedStrong", staged(4, 500.0)},
                    // 8e-5 and 1e-3 where the error of an increment is a mean that counts linear elements
                    // in one run and not in the other: it is then divided in other parts.
                    SkipCase{"Hyperbolic", capped(6, {400, 0.5, 0.8, 600, 250, 0.3, 5, 33})},
                    SkipCase{"Hyperbolic1970", capped(5, {400, 0.5, 0.8, 600, 0.35, 0.05, 2.0, 5, 33})},
                    // 5e-8 where the two runs judge a step by different force scales.
                    SkipCase{"FreeOfStressAtFirst", free_of_stress_at_first()}),
    [](const auto& one) { return std::string(one.param.name); });

// Steps that start from the way of the one before are as near to equilibrium as those that end with quadratic
// convergence.  Against an iteration to 1e-12, which without prediction is up to 5e-8 away at the usual tolerance.
TEST(Skips, PredictionComesNearEquilibrium) {
  const std::vector<double> hyperbolic{400, 0.5, 0.8, 600, 250, 0.3, 5, 33};
  const auto check = [](const auto& deck) {
    RunSettings whole;
    whole.skips.condensation = false;
    RunSettings reference = whole;
    reference.skips.prediction = false;
    const WholeRun predicted = run_text(deck(0.0), {}, whole);
    expect_same(predicted, run_text(deck(1e-12), {}, reference), 2e-10);
    EXPECT_LT(predicted.result.work.factorisations,
              run_text(deck(0.0), {}, reference).result.work.factorisations);
  };
  check([&](double tolerance) { return capped(6, hyperbolic, tolerance); });
  check([&](double tolerance) { return free_of_stress_at_first(tolerance); });
}

// Rounding decides neither whether a joint is open that is unloaded to nothing, nor whether one is on its
// memory that has slipped: every increment agrees, for skips and for solvers, by the last one's size (the joint
// may be without stress before).  1e-9: k_n is stiff.
void expect_same_path(const std::string& deck) {
  const WholeRun all_on = run_text(deck);
  ASSERT_TRUE(all_on.completed()) << all_on.failure;
  const double u = all_on.last().u.norm(), force = all_on.last().internal.norm();
  for (const int solver : {-1, 1, 4, 5}) {  // as ever; profile, UMFPACK, multifrontal
    SCOPED_TRACE(solver);
    RunSettings none;
    none.solver = solver;
    for (const SkipName& skip : kSkipNames) none.skips.*skip.flag = false;
    const WholeRun off = run_text(deck, {}, none);
    ASSERT_TRUE(off.completed()) << off.failure;
    for (std::size_t i = 0; i < off.increments.size(); ++i) {
      EXPECT_LE((off.increments[i].u - all_on.increments[i].u).norm(), 1e-9 * u) << i;
      EXPECT_LE((off.increments[i].internal - all_on.increments[i].internal).norm(), 1e-9 * force) << i;
    }
  }
}

// The platen comes back to where it started and goes down again: 3e-4 of the forces, where some points were
// open and without memory by rounding.
TEST(Skips, JointUnloadedToNothing) {
  expect_same_path(layered({.geometry = 2,
                            .cell = Cell::quad8,
                            .columns = 3,
                            .rows = 4,
                            .upper = {3000.0, 0.25},
                            .lower = {3000.0, 0.3},
                            .joint = {0.0, 0.8, 0.0, 0.8, 120.0, 0.0, 1e7, 1e7, 0.0, 2.0},
                            .ways = {-0.03, 0.03, -0.03}}));
}

// Down, half of it up, and down again, with the stiffness of the start of an increment: 4e-5 where slipping
// points were below their memory by 1e-11 in one run and on it in the other.
TEST(Skips, JointOnItsMemory) {
  expect_same_path(layered({.upper = {3000.0, 0.25},
                            .lower = {3000.0, 0.3},
                            .joint = {0.0, 0.8, 5.0, 0.8, 5000.0, 0.9, 1e9, 1e9, 0.0, 0.0},
                            .pressure = 50.0,
                            .ways = {-0.03, 0.015, -0.03},
                            .increments = 4}));
}

// A platen on a block that is pressed sideways, free to follow it: nothing presses the joint, and
// rounding made it open, the platen loose and the matrix singular, with the profile and multifrontal
// solvers but not with UMFPACK.
TEST(Skips, PlatenThatNothingPresses) {
  DeckWriter deck(1);
  Block block{3, 4, Cell::quad8, 1, 1, rectangle(0.0, 1.0, 0.0, 2.0)};
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3});
  deck.material(2, 22, {0.0, 28.5, 0.0, 0.8, 500.0, 0.5, 1e6, 1e6, 0.0, 2.0});
  deck.group(1, 2, 1, 1);
  deck.group(2, 12, 0, 2);
  block.write_elements(deck, 1);
  const std::vector<int> platen = copy_row(deck, block, block.top(), 1001);
  join(deck, 1001, 2, block.top(), platen, 2);
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : platen) deck.fix(n, 1, 0);
  StageCards& stage = deck.stage(4);
  for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(block.columns - 1, j), 2, 20.0, 20.0);
  expect_same_path(deck.text());
}

// Solvers that keep the border (5) and those that don't find the same matrix of it; loads and motions of three
// stages, of which the third begins elsewhere than the second ended.
TEST(Skips, RegionsAreCondensedByAnySolver) {
  const std::string three_ways = layered({.upper = {3000.0, 0.25},
                                          .lower = {3000.0, 0.3},
                                          .joint = {0.0, 28.5, 5.0, 0.8, 5000.0, 0.9, 1e5, 1e5, 0.0, 0.0},
                                          .pressure = 50.0,
                                          .ways = {-0.03, 0.015, -0.03},
                                          .increments = 4});
  for (const std::string& deck : {friction(), free_of_stress_at_first(), three_ways}) {
    RunSettings whole = without_prediction();
    whole.skips.condensation = false;
    const WholeRun reference = run_text(deck, {}, whole);
    for (const int solver : {1, 4, 5}) {
      SCOPED_TRACE(solver);
      RunSettings settings;
      settings.solver = solver;
      const WholeRun condensed = run_text(deck, {}, settings);
      EXPECT_GT(condensed.result.work.condensed, 100);
      expect_same(condensed, reference, 1e-10);
    }
  }
}

// A border that two increments would not pay for, a solution a dof; and the same bits on any number of threads.
TEST(Skips, ABorderOrderedLastPaysInFewIncrements) {
  const std::string deck = friction(48, 2);
  RunSettings whole = without_prediction();
  whole.skips.condensation = false;
  const WholeRun one = run_text(deck);
  EXPECT_GT(one.result.work.condensed, 9000);
  expect_same(one, run_text(deck, {}, whole), 1e-10);
  for (const int threads : {2, 3}) {
    RunSettings settings;
    settings.threads = threads;
    const WholeRun several = run_text(deck, {}, settings);
    EXPECT_TRUE(several.last().u == one.last().u) << threads;
    EXPECT_TRUE(several.last().internal == one.last().internal) << threads;
  }
}

// A square that is held below and pushed down above, in so many increments.
struct PushedSquare {
  DeckWriter deck{1};
  Block block;

  PushedSquare(int columns, int rows, int increments)
      : block{columns, rows, Cell::quad4, 1, 1, rectangle(0.0, 1.0, 0.0, 1.0)} {
    block.write_nodes(deck);
    deck.material(1, 1, {1e4, 0.3});
    deck.group(1, 1, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    StageCards& push = deck.stage(increments);
    for (int n : block.top()) push.fix(n, 0, 1, 0.0, -0.01);
  }
};

// Each skip does something where it should: counters, not clocks.
TEST(Skips, AreTaken) {
  const WorkCounters friction_work = run_text(friction()).result.work;
  EXPECT_GT(friction_work.condensed, 200);
  EXPECT_GT(friction_work.linear_products, 0);
  const WorkCounters elastic = run_text(staged(1, 0.0)).result.work;
  EXPECT_GT(elastic.kept_factors, 0);
  const WorkCounters strong = run_text(staged(4, 500.0)).result.work;
  EXPECT_GT(strong.repeats, 2);
  EXPECT_LE(strong.factorisations, 3);
  const WorkCounters fine = run_text(friction(40)).result.work;  // large enough for the multifrontal solver
  EXPECT_GT(fine.twin_equations, 1500);
  EXPECT_GT(run_text(PushedSquare(50, 50, 1).deck.text()).result.work.twin_equations, 2000);
  const WorkCounters predicted = run_text(plastic()).result.work;
  const WorkCounters whole = run_text(plastic(), {}, without_prediction()).result.work;
  EXPECT_LE(predicted.factorisations, whole.factorisations - 5);
}

// Factors that serve a second stage, in which nothing moves a support: the displacements of the first one have no
// part in its first correction, which is the whole answer.
TEST(Skips, KeptFactorsForgetWhatMovedBefore) {
  auto [deck, block] = PushedSquare(4, 4, 1);
  for (int n : block.top()) deck.fix(n, 0, 1);
  deck.stage(1).pressure(block.element(3, 1), 2, 20.0, 20.0);
  const WholeRun run = run_text(deck.text());
  EXPECT_EQ(run.last().stage, 1);
  EXPECT_EQ(run.last().iterations, 1);
  EXPECT_EQ(run.result.work.factorisations, 1);
}

// Increments of a large linear scene are one step again and again; what that leaves out of balance does not grow with
// them.
TEST(Skips, LinearIncrementsAreRepeatedInLargeMeshes) {
  auto [deck, block] = PushedSquare(110, 100, 5);
  deck.stages.front().pressure(block.element(109, 50), 1, 20.0, 20.0);
  RunSettings solved;
  solved.skips.repeats = false;
  const WholeRun one = run_text(deck.text()), other = run_text(deck.text(), {}, solved);
  EXPECT_EQ(one.result.work.repeats, 4);
  EXPECT_EQ(other.result.work.repeats, 0);
  expect_same(one, other, 1e-11);
  RunSettings threads;
  threads.threads = 3;
  EXPECT_TRUE(run_text(deck.text(), {}, threads).last().internal == one.last().internal);
}

TEST(Skips, OffMeansOff) {
  RunSettings none;
  for (const SkipName& skip : kSkipNames) none.skips.*skip.flag = false;
  const WorkCounters friction_work = run_text(friction(), {}, none).result.work;
  EXPECT_EQ(friction_work.condensed, 0);
  EXPECT_EQ(friction_work.linear_products, 0);
  const WorkCounters strong = run_text(staged(4, 500.0), {}, none).result.work;
  EXPECT_EQ(strong.repeats, 0);
  EXPECT_EQ(strong.kept_factors, 0);
  RunSettings one_by_one;
  one_by_one.skips.twins = false;
  for (const std::string& deck : {friction(40), PushedSquare(50, 50, 1).deck.text()}) {
    const WholeRun with = run_text(deck), without = run_text(deck, {}, one_by_one);
    EXPECT_EQ(without.result.work.twin_equations, 0);
    EXPECT_TRUE(with.last().u == without.last().u);
    EXPECT_TRUE(with.last().internal == without.last().internal);
  }
}

// Looks at the stress of linear elements at the start of every stage and after every increment, if it does.
struct Looker : Observer {
  explicit Looker(bool look) : looks(look) {}
  bool wants_states(const Model&, const StepReport&) const override { return looks; }
  void on_stage_start(const Model&, int, const Solution& now) override { count(now); }
  void on_increment(const Model&, const StepReport&, const Solution& now) override { count(now); }
  void count(const Solution& now) {
    sizes.push_back(now.assembly->groups().front().state.committed.sigma.size());
  }
  bool looks;
  std::vector<std::size_t> sizes;
};

// Stress of linear elements has room where somebody looks, and none at all where nobody does.
TEST(Skips, StressOfLinearElementsIsThereForWhoeverLooks) {
  const Catalogue all = app::full_catalogue();
  for (const bool look : {true, false}) {
    Looker looker(look);
    Observer* observers[] = {&looker};
    const WholeRun plain = run_text(elastic_block(1));
    RunSettings settings;
    settings.solver = 1;
    ASSERT_EQ(run(*plain.model, all, settings, observers).status, RunStatus::completed);
    ASSERT_EQ(looker.sizes.size(), 3u);
    for (std::size_t size : looker.sizes) EXPECT_EQ(size, look ? 4u * 4u * 32u : 0u);
  }
}

// Congruent elements: 8 x 4 cells of one size have one matrix; in a ring one for each column.
TEST(Skips, CongruentElementsShareAMatrix) {
  for (int geometry : {1, 2}) {
    const WholeRun run = run_text(elastic_block(geometry));
    EXPECT_EQ(analyse_scene(*run.model).linear_shapes, geometry == 1 ? 1 : 8);
  }
}

}  // namespace
}  // namespace sage::test
