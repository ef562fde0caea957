// Hyperbolic soils in whole models: the answer must not depend on how many increments the user asks
// for.  The run divides an increment that is too long for the bend of its strain path
// (PathError).  1 % is what is promised.
#include <gtest/gtest.h>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

const std::vector<double> kBulk = {400, 0.5, 0.8, 600, 250, 0.3, 5, 33};         // laws 6, 7
const std::vector<double> k1970 = {400, 0.5, 0.8, 600, 0.35, 0.05, 2.0, 5, 33};  // law 5
constexpr double kCell = 100.0;

struct Answer {
  double value;
  int iterations;
};

int increments_in(const WholeRun& run) {
  return static_cast<int>(run.increments.size());
}

// Frictionless ends, cell pressure 100 kPa, one element: deviator at an axial strain.
Answer triaxial(int law, double strain, int increments) {
  TriaxialDeck deck;
  deck.law = law;
  deck.parameters = law == 5 ? k1970 : kBulk;
  deck.cell = kCell;
  deck.strains = {strain};
  deck.increments = increments;
  deck.columns = deck.rows = 1;
  const WholeRun run = run_text(deck.text());
  EXPECT_TRUE(run.completed()) << run.failure;
  EXPECT_EQ(increments_in(run), increments);
  return {axial_stress(deck, run, 0) - kCell, run.iterations()};
}

class HyperbolicIncrements : public testing::TestWithParam<int> {};

TEST_P(HyperbolicIncrements, OneOrAHundredInATriaxialTest) {
  for (const double strain : {0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.10}) {
    const Answer hundred = triaxial(GetParam(), strain, 100);
    for (const int increments : {1, 2, 5}) {
      const Answer few = triaxial(GetParam(), strain, increments);
      EXPECT_NEAR(few.value, hundred.value, 0.01 * hundred.value) << strain << " in " << increments;
      EXPECT_LE(few.iterations, 200);  // parts of an increment, not hundreds
    }
  }
}

// A specimen between smooth plates in a cell whose pressure rises or falls, then compressed: its
// stress is isotropic to rounding, and that must not choose between loading and unloading.  Three solvers agree
// to 1e-10; with a memory of rounding size they were up to 1e-3 apart (law 5: 9e-3, or no equilibrium at all).
TEST_P(HyperbolicIncrements, IsotropicCompressionIsFirstLoading) {
  struct Path {
    double from, to;
    int increments;
  };
  for (const auto& [from, to, increments] : {Path{10.0, 100.0, 1}, Path{100.0, 80.0, 3}}) {
    TriaxialDeck triaxial;
    triaxial.law = GetParam();
    triaxial.parameters = GetParam() == 5 ? k1970 : kBulk;
    triaxial.columns = 4;
    triaxial.rows = 6;
    triaxial.strains = {};
    DeckWriter deck = triaxial.deck();
    deck.initial(1, 0, from, from, from);
    const Block block = triaxial.block();
    StageCards& cell = deck.stage(increments);
    for (int j = 0; j < block.rows; ++j) cell.pressure(block.element(3, j), 2, to, to);
    for (int i = 0; i < block.columns; ++i) cell.pressure(block.element(i, 5), 3, to, to);
    for (const double down : {2e-4, 2e-3}) {
      StageCards& stage = deck.stage();
      for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -down);
    }
    std::vector<WholeRun> runs;
    for (const int solver : {-1, 1, 4, 5}) {  // as ever; profile, UMFPACK, multifrontal without skips
      RunSettings settings;
      settings.solver = solver;
      for (const SkipName& skip : kSkipNames) settings.skips.*skip.flag = solver < 0;
      runs.push_back(run_text(deck.text(), {}, settings));
      ASSERT_TRUE(runs.back().completed()) << runs.back().failure;
    }
    for (const WholeRun& run : runs) {
      EXPECT_EQ(run.increments[static_cast<std::size_t>(increments) - 1]
                    .points[static_cast<std::size_t>(PointStatus::unloading)],
                0);
      for (std::size_t i = 0; i < run.increments.size(); ++i) {
        const Snapshot &one = run.increments[i], &other = runs.front().increments[i];
        EXPECT_LE((one.u - other.u).norm(), 1e-10 * other.u.norm()) << "increment " << i;
        EXPECT_LE((one.internal - other.internal).norm(), 1e-10 * other.internal.norm()) << "increment " << i;
      }
    }
  }
}

// A hundred increments need no help: 3 or 4 iterations each.
TEST_P(HyperbolicIncrements, SmallOnesAreNotDivided) {
  EXPECT_LE(triaxial(GetParam(), 0.02, 100).iterations, 400);
}

// Half of a strip, 2 m wide, 100 kPa on a layer with own weight: settlement of its middle.
TEST_P(HyperbolicIncrements, OneOrAHundredUnderAStrip) {
  const auto settlement = [](int increments) {
    Block block;
    block.columns = 8;
    block.rows = 6;
    block.place = rectangle(0.0, 8.0, -6.0, 0.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, GetParam(), GetParam() == 5 ? k1970 : kBulk, 18.0);
    deck.group(1, static_cast<int>(Cell::quad4), 2, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 1, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    for (int n : block.right()) deck.fix(n, 1, 0);
    deck.initial(1, 1, 0.0, 18.0, 0.5, 0.0);
    deck.stage().gravity_y = -1.0;
    deck.stage(increments).pressure(block.element(0, 5), 3, 100.0, 100.0);
    const WholeRun run = run_text(deck.text());
    EXPECT_TRUE(run.completed()) << run.failure;
    return -run.u(block.node(0, 6)).y();
  };
  const double hundred = settlement(100);
  EXPECT_GT(hundred, 0.01);
  for (const int increments : {1, 3, 10}) EXPECT_NEAR(settlement(increments), hundred, 0.01 * hundred);
}

INSTANTIATE_TEST_SUITE_P(Laws, HyperbolicIncrements, testing::Values(5, 6, 7));

}  // namespace
}  // namespace sage::test
