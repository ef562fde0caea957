// Initial stress that is out of balance: the note, its size and place, and what the order of its release means.
#include "sage/analysis/initial_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sage/app/commands.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

constexpr char kNote[] = "the initial stress is out of balance by up to ";

enum class Release { over_the_stage, before_it };

// Quarter of the source chapter's specimen, 14 x 28 squares of h = .1, under a rigid platen; specimen and joint
// start at the cell pressure of 50.
struct JointedSpecimen {
  static constexpr double h = 0.1, kCell = 50.0, kRadius = 1.4;
  int rule = 3;        // 1 row-sum, 2 Gauss, 3 Newton-Cotes
  double power = 0.9;  // k_s = k_j gamma_w (sigma_n/p_a)^n
  Release release = Release::over_the_stage;
  std::vector<int> platen;

  std::string text() {
    Block block;
    block.columns = 14;
    block.rows = 28;
    block.place = scenes::rectangle(0.0, kRadius, 0.0, 2.8);
    DeckWriter deck(2);
    deck.atmospheric_pressure = 14.696;
    deck.water_unit_weight = 0.036111;
    block.write_nodes(deck);
    platen = copy_row(deck, block, block.top(), 436);
    deck.material(1, 1, {3000.0, 0.495});
    deck.material(2, 22, {0.0, 28.5, 0.0, 0.0, 5000.0, power, 1e9, 1e9, 0.0, 1.0});
    deck.group(1, 1, 0, 1);
    deck.group(2, 11, rule, 2);
    block.write_elements(deck, 1);
    join(deck, 1001, 2, block.top(), platen, 1);
    for (const int node : block.bottom()) deck.fix(node, 0, 1);
    for (const int node : block.left()) deck.fix(node, 1, 0);
    for (const int node : platen) deck.fix(node, 1, 1);
    deck.initial(1, 0, kCell, kCell, kCell);
    deck.initial(2, 0, 0.0, kCell);
    const bool before = release == Release::before_it;
    const auto cell_pressure = [&](StageCards& stage) {
      for (int j = 0; j < 28; ++j) stage.pressure(block.element(13, j), 2, kCell, kCell);
    };
    if (before) cell_pressure(deck.stage());
    StageCards& stage = deck.stage(20);
    if (!before) cell_pressure(stage);
    for (const int node : platen) stage.fix(node, 0, 1, 0.0, -0.28);
    return deck.text();
  }
};

// Force on the platen at the end of every increment of the compression.
std::vector<double> platen_forces(JointedSpecimen specimen) {
  const WholeRun run = run_text(specimen.text());
  EXPECT_TRUE(run.completed()) << run.failure;
  std::vector<double> forces;
  for (const Snapshot& s : run.increments)
    if (specimen.release == Release::over_the_stage || s.stage == 1)
      forces.push_back(run.reaction(s, specimen.platen, 1));
  return forces;
}

// Newton-Cotes: nothing at r = 0, 2 pi h/2 r p elsewhere.  Consistent: 2 pi h (2 r1 + r2)/6 p at the first end.
// Closed form of the difference, at both ends of the joint: pi h^2 p/3.
TEST(InitialBalance, NewtonCotesPairsAreOutOfBalanceAtBothEnds) {
  for (const int rule : {1, 2, 3}) {
    JointedSpecimen specimen;
    specimen.rule = rule;
    const Model model = app::make_workbench().build(specimen.text());
    const InitialImbalance found = initial_imbalance(model);
    if (rule != 3) {
      EXPECT_FALSE(found.counts()) << found.force;
      EXPECT_LT(std::abs(found.force), 1e-10);
      continue;
    }
    ASSERT_TRUE(found.counts());
    const double h = JointedSpecimen::h;
    EXPECT_NEAR(std::abs(found.force), kPi * h * h * JointedSpecimen::kCell / 3.0, 1e-9);
    // At the side each ring of length h carries 2 pi R h p.
    EXPECT_NEAR(found.largest, 2.0 * kPi * JointedSpecimen::kRadius * h * JointedSpecimen::kCell, 1e-9);
    const int node = model.mesh.number[found.dof / 2];
    EXPECT_TRUE(node == 421 || node == 435) << node;
    EXPECT_EQ(found.dof % 2, 1);
  }
}

// Where the stress puts no force on any node there is no share of its largest one.
TEST(InitialBalance, AStressWithoutForcesHasNoShare) {
  const Model model = app::make_workbench().build(JointedSpecimen().text());
  InitialImbalance imbalance;
  imbalance.dof = 1;
  imbalance.force = 7.5;
  const std::string text = explain_imbalance(model, 0, imbalance);
  EXPECT_NE(text.find("by up to 7.5"), std::string::npos) << text;
  EXPECT_NE(text.find("(it puts no force on any node itself)"), std::string::npos) << text;
}

// The same histories, what is out of balance let go over the compression or in a stage of its own before it.
// Only Newton-Cotes has anything to let go; with a joint whose stiffness follows its normal stress that leaves
// 1e-5 in the force (docs/theory/elements.md), with constant stiffness nothing at the end.
TEST(InitialBalance, OrderOfReleaseIsWhatNewtonCotesHistoriesDifferBy) {
  for (const int rule : {1, 2, 3})
    for (const double power : {0.9, 0.0}) {
      SCOPED_TRACE("rule " + std::to_string(rule) + ", n = " + std::to_string(power));
      JointedSpecimen specimen;
      specimen.rule = rule;
      specimen.power = power;
      const std::vector<double> over = platen_forces(specimen);
      specimen.release = Release::before_it;
      const std::vector<double> before = platen_forces(specimen);
      ASSERT_EQ(over.size(), before.size());
      double largest = 0.0;
      for (std::size_t i = 0; i < over.size(); ++i)
        largest = std::max(largest, std::abs(over[i] / before[i] - 1.0));
      const double at_end = std::abs(over.back() / before.back() - 1.0);
      if (rule != 3) {
        EXPECT_LT(largest, 1e-9);
        continue;
      }
      EXPECT_GT(largest, 1e-5);
      EXPECT_LT(largest, 1e-4);
      if (power == 0.0) {
        EXPECT_LT(at_end, 1e-9);
      } else {
        EXPECT_GT(at_end, 5e-6);  // 1.15e-5 with 40 and with 160 increments
        EXPECT_LT(at_end, 2e-5);
      }
    }
}

// Ground at rest, 2 x 4 cells of 1 x 1 and unit weight 20, whose initial stress is of another weight: noted
// from 1/1000 of the largest nodal force on.
struct GroundAtRest {
  double weight_of_stress = 20.0, load = 0.0;
  bool gravity = true;

  std::string text() const {
    Ground ground(1, Cell::quad4, 2, 4);
    ground.deck.material(1, 1, {1e4, 0.3}, 20.0);
    ground.deck.group(1, 1, 0, 1);
    ground.block.write_elements(ground.deck, 1);
    ground.deck.initial(1, 1, 0.0, weight_of_stress, 0.5, 0.0);
    StageCards& stage = ground.deck.stage(2);
    if (gravity) stage.gravity_y = -1.0;
    if (load != 0.0)
      for (const int node : ground.block.top()) stage.load(node, 0.0, -load);
    return ground.deck.text();
  }
};

TEST(InitialBalance, GroundAtRest) {
  EXPECT_FALSE(run_text(GroundAtRest{}.text()).warns(kNote));
  EXPECT_FALSE(run_text(GroundAtRest{20.0, 100.0}.text()).warns(kNote)) << "a load on ground at rest is a load";
  EXPECT_FALSE(run_text(GroundAtRest{20.0 * (1 + 1e-4)}.text()).warns(kNote));
  EXPECT_TRUE(run_text(GroundAtRest{20.0, 0.0, false}.text()).warns(kNote)) << "nothing holds it down";
  // A node inside has the weight of one cell, 20, and the forces of the stress, 19.
  const WholeRun run = run_text(GroundAtRest{19.0}.text());
  EXPECT_TRUE(run.warns("stage 1: " + std::string(kNote) + "1 kN"));
  EXPECT_TRUE(run.warns("direction y; what is not balanced is let go in proportion over the 2 increments"));
}

// A later lift may bring its stress along.
TEST(InitialBalance, GroupsThatArePlacedLater) {
  for (const double weight : {20.0, 10.0}) {
    Block low, high;
    low.place = scenes::rectangle(0.0, 1.0, 0.0, 1.0);
    high.place = scenes::rectangle(0.0, 1.0, 1.0, 2.0);
    high.first_node = 3;
    high.first_element = 2;
    DeckWriter deck(1);
    low.write_nodes(deck);
    deck.node(5, 0.0, 2.0);
    deck.node(6, 1.0, 2.0);
    deck.material(1, 1, {1e4, 0.3}, 20.0);
    deck.group(1, 1, 0, 1);
    deck.group(2, 1, 0, 1);
    low.write_elements(deck, 1);
    high.write_elements(deck, 2);
    for (int node = 1; node <= 6; ++node) deck.fix(node, 1, node < 3 ? 1 : 0);
    deck.stage().gravity_y = -1.0;
    StageCards& lift = deck.stage();
    lift.births = {2};
    lift.initial(2, 1, 2.0, weight, 0.5, 0.0);
    const WholeRun run = run_text(deck.text());
    ASSERT_TRUE(run.completed());
    EXPECT_EQ(run.warns("stage 2: " + std::string(kNote)), weight != 20.0);
  }
}

}  // namespace
}  // namespace sage::test
