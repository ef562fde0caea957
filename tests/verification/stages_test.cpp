// Stages of whole models: what the verification book does not hold.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/record/report.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/run_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::test {
namespace {

constexpr double kWeight = 20.0, kE = 1e4, kNu = 0.3;

// The stress that the strength can't carry is reported, not swallowed.
TEST(NullStageWarning, InadmissibleK0IsReported) {
  Ground ground(1, Cell::quad4, 2, 4);
  ground.deck.material(1, 4, {kE, kNu, 0.0, 30.0, 0.0}, kWeight);  // K0 = 0.2 < Ka = 1/3
  ground.deck.group(1, 1, 0, 1);
  ground.block.write_elements(ground.deck, 1);
  ground.deck.initial(1, 1, 0.0, kWeight, 0.2, 0.0);
  ground.deck.stage(4).gravity_y = -1.0;
  EXPECT_TRUE(run_text(ground.deck.text()).warns("outside the yield surface"));
}

// A smooth plate on heavy soil at rest is pushed down by d: the force on it is M d/h times its width, whatever
// the soil weighs and however much of it a node carries (M = E (1 - nu)/((1 + nu)(1 - 2 nu))).
TEST(NodeReport, LeavesOutTheWeightOfTheSoil) {
  const Catalogue catalogue = app::full_catalogue();
  for (int cells : {1, 2, 4}) {
    Ground ground(1, Cell::quad4, cells, cells);
    ground.deck.material(1, 1, {kE, kNu}, kWeight);
    ground.deck.group(1, 1, 0, 1);
    ground.block.write_elements(ground.deck, 1);
    ground.deck.initial(1, 1, 0.0, kWeight, 0.5, 0.0);
    ground.deck.stage().gravity_y = -1.0;
    StageCards& push = ground.deck.stage();
    for (int node : ground.block.top()) push.fix(node, 0, 1, 0.0, -0.001);
    WholeRun run = run_text(ground.deck.text());
    Report report;
    report.kind = ReportKind::nodes;
    for (int node : ground.block.top()) report.nodes.push_back(run.index(node));
    run.model->reports = {report};
    Reports reports(scratch_folder("weight"), "plate");
    Observer* observers[] = {&reports};
    RunSettings settings;
    settings.solver = 1;
    ASSERT_EQ(sage::run(*run.model, catalogue, settings, observers).status, RunStatus::completed);
    const auto y = run.model->mesh.x.row(1), x = run.model->mesh.x.row(0);
    const double width = x.maxCoeff() - x.minCoeff(), height = y.maxCoeff() - y.minCoeff();
    const double M = kE * (1.0 - kNu) / ((1.0 + kNu) * (1.0 - 2.0 * kNu));
    ASSERT_EQ(reports.nodes(0).size(), 2u);
    EXPECT_NEAR(reports.nodes(0)[0].force[1], 0.0, 1e-9);  // of 80
    EXPECT_NEAR(reports.nodes(0)[1].force[1], -M * 0.001 / height * width, 1e-9);
  }
}

std::string shipped(const std::string& name) {
  std::ifstream file(SAGE_SOURCE_DIR "/legacy_inputs/stages/" + name + "/deck.dat");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The same over decks that are shipped, with a wall and its interfaces; and the base
// carries the weight that is left.
TEST(Excavation, ShippedTwinsAgree) {
  for (const std::string name : {"cut", "shaft"}) {
    SCOPED_TRACE(name);
    const WholeRun lifts = run_text(shipped(name + "_lifts")), once = run_text(shipped(name + "_at_once"));
    ASSERT_TRUE(lifts.completed() && once.completed()) << lifts.failure << once.failure;
    EXPECT_LT(lifts.increments.front().u.cwiseAbs().maxCoeff(), 1e-13) << "the null step";
    double difference = 0.0, size = 0.0;
    for (std::size_t g = 0; g < once.model->groups.size(); ++g) {
      const Group& group = once.model->groups[g];
      if (group.name != "ground" && group.name != "wall") continue;
      for (const int node : group.nodes) {
        const Vector2 a = lifts.last().u.segment<2>(2 * node), b = once.last().u.segment<2>(2 * node);
        difference = std::max(difference, (a - b).norm());
        size = std::max(size, a.norm());
      }
      EXPECT_LT((lifts.stress[g] - once.stress[g]).cwiseAbs().maxCoeff(),
                1e-9 * once.stress[g].cwiseAbs().maxCoeff());
    }
    EXPECT_LT(difference, 1e-10 * size);
    EXPECT_GT(size, 1e-3);
    for (std::size_t stage = 0; stage < lifts.increments.size(); ++stage) {
      const auto dug = static_cast<double>(stage);
      double up = 0.0;
      for (int i = 0; i < lifts.model->mesh.nodes(); ++i)
        if (std::abs(lifts.model->mesh.x(1, i) + 10.0) < 1e-9)
          up += lifts.reaction(lifts.increments[stage], lifts.model->mesh.number[i]).y();
      const double left = name == "cut" ? 16.5 * 10.0 - 4.0 * dug : M_PI * (16.5 * 16.5 * 10.0 - 16.0 * dug);
      EXPECT_NEAR(up, 18.0 * left, 1e-9 * 18.0 * left) << "stage " << stage + 1;
    }
  }
}

// A bar is pulled by its end, then the end is let go over a stage: the reaction falls in proportion to nothing,
// the bar is as it was, and its last increment, which ends without any stress, counts as equilibrium.
TEST(ReleasedFixity, ReactionFadesOverTheStage) {
  Block block;
  block.columns = 4;
  block.place = rectangle(0.0, 4.0, 0.0, 1.0);
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 1, {kE, 0.0});
  deck.group(1, 1, 1, 1);
  block.write_elements(deck, 1);
  for (int n : block.left()) deck.fix(n, 1, 0);
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  StageCards& pull = deck.stage();
  for (int n : block.right()) pull.fix(n, 1, 0, 0.04);
  StageCards& release = deck.stage(4);
  for (int n : block.right()) release.fix(n, -1, 0);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double force = kE * 0.01;
  EXPECT_NEAR(run.reaction(run.increments[0], block.right(), 0), force, 1e-9 * force);
  for (std::size_t i = 1; i <= 4; ++i) {
    const double part = 1.0 - 0.25 * static_cast<double>(i);
    const int dof = 2 * run.index(block.right().front());
    EXPECT_NEAR(run.increments[i].u[dof], 0.04 * part, 1e-12);
    EXPECT_NEAR(-run.reaction(run.increments[i], block.left(), 0), force * part, 1e-9 * force);
  }
  EXPECT_TRUE(run.warnings.empty()) << run.warnings.front();
}

// A column of a lower cell (nodes 1 2 4 3, group 1) and an upper one (3 4 6 5) that every further group has;
// nu = 0, so one-dimensional.
DeckWriter column_with_upper_groups(std::initializer_list<int> upper) {
  Block block;
  block.rows = 2;
  block.place = rectangle(0.0, 1.0, 0.0, 2.0);
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 1, {kE, 0.0});
  deck.group(1, 1, 1, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  for (int group : upper) {
    deck.group(group, 1, 1, 1);
    deck.element(group, group, {3, 4, 6, 5});
  }
  for (int n : block.bottom()) deck.fix(n, 1, 1);
  for (int n : {3, 5}) deck.fix(n, 1, 0);
  return deck;
}

// P on each upper corner.  The upper half goes and takes the loads with it; what is born there later has not
// moved, and bears only what comes after it.
TEST(Refill, BeginsWithoutDisplacementAndWithoutTheOldLoads) {
  DeckWriter deck = column_with_upper_groups({2, 3});
  const double P = 10.0, Q = 3.0;
  StageCards& load = deck.stage();
  for (int n : {5, 6}) load.load(n, 0.0, -P);
  deck.stage().deaths = {2};
  deck.stage().births = {3};
  StageCards& again = deck.stage();
  for (int n : {5, 6}) again.load(n, 0.0, -Q);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const auto settlement = [&](std::size_t stage, int node) {
    return -run.increments[stage].u[2 * run.index(node) + 1];
  };
  const double cell = 2.0 / kE;  // shortening of one cell by a unit force on each upper corner
  const double rounding = 1e-12 * P * cell;
  EXPECT_NEAR(settlement(0, 5), 2 * P * cell, rounding);
  EXPECT_NEAR(settlement(1, 3), 0.0, rounding);
  for (int node : {3, 5}) EXPECT_NEAR(settlement(2, node), 0.0, rounding) << node;
  EXPECT_NEAR(settlement(3, 3), Q * cell, rounding);
  EXPECT_NEAR(settlement(3, 5), 2 * Q * cell, rounding);
  EXPECT_NEAR(run.reaction(run.last(), {1, 2}, 1), 2 * Q, 1e-12 * P);
}

// A load on what is born only later never acts: the warning says so.
TEST(Refill, LoadsBeforeThePlacingNeverAct) {
  DeckWriter deck = column_with_upper_groups({2});
  StageCards& early = deck.stage();
  early.load(6, 0.0, -10.0);
  early.pressure(2, 3, 10.0, 10.0);
  deck.stage().births = {2};
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_TRUE(run.warns("the load of node 6 of stage 1 does nothing"));
  EXPECT_TRUE(run.warns("the pressure on element 2 of stage 1 does nothing"));
  EXPECT_EQ(run.largest_u(), 0.0);
}

}  // namespace
}  // namespace sage::test
