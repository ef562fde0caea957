// Stages of whole models: what the verification book does not hold.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

constexpr double kWeight = 20.0, kE = 1e4, kNu = 0.3;

// Ground of `columns` x `rows` cells, unit cells, on rollers at the sides and fixed (or on rollers) below.
struct Ground {
  Block block;
  DeckWriter deck;

  Ground(int geometry, Cell cell, int columns, int rows) : deck(geometry) {
    block.cell = cell;
    block.columns = columns;
    block.rows = rows;
    block.place = rectangle(0.0, columns, -rows, 0.0);
    block.write_nodes(deck);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
  }
};

// The stress that the strength can't carry is reported, not swallowed.
TEST(NullStageWarning, InadmissibleK0IsReported) {
  Ground ground(1, Cell::quad4, 2, 4);
  ground.deck.material(1, 4, {kE, kNu, 0.0, 30.0, 0.0}, kWeight);  // K0 = 0.2 < Ka = 1/3
  ground.deck.group(1, 1, 0, 1);
  ground.block.write_elements(ground.deck, 1);
  ground.deck.initial(1, 1, 0.0, kWeight, 0.2, 0.0);
  ground.deck.stage(4).gravity_y = -1.0;
  const WholeRun run = run_text(ground.deck.text());
  bool told = false;
  for (const std::string& w : run.warnings)
    told = told || w.find("outside the yield surface") != std::string::npos;
  EXPECT_TRUE(told);
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

}  // namespace
}  // namespace sage::test
