// Stages of whole models: null stage, excavation in one go and in several, fill in lifts, earth pressure at
// rest, released supports.  Closed forms, or one model computed in two ways that must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

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

struct NullCase {
  const char* name;
  int geometry;
  Cell cell;
  int law;  // 1 elastic, 3 Drucker-Prager, 4 Mohr-Coulomb
  double K0;
  int formulation = 0;
};

class NullStage : public testing::TestWithParam<NullCase> {};

// Geostatic stress and gravity in balance: nothing moves.  Rounding: gamma H^2 eps / E is 1e-15 H.  In a ring,
// tri6 needs its six points: N,r sigma r is of third degree, which three points don't integrate (they leave
// 4e-6 H).
TEST_P(NullStage, NothingMoves) {
  const NullCase c = GetParam();
  Ground ground(c.geometry, c.cell, 4, 6);
  std::vector<double> parameters{kE, kNu};
  if (c.law != 1) parameters.insert(parameters.end(), {5.0, 30.0, 0.0});
  ground.deck.material(1, c.law, parameters, kWeight);
  ground.deck.group(1, static_cast<int>(c.cell), c.formulation, 1);
  ground.block.write_elements(ground.deck, 1);
  ground.deck.initial(1, 1, 0.0, kWeight, c.K0, 0.0);
  ground.deck.stage(3).gravity_y = -1.0;
  const WholeRun run = run_text(ground.deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_LT(run.largest_u(), 1e-10 * 6.0);
  EXPECT_LE(run.iterations(), 3);  // one an increment
  const std::vector<int> base = ground.block.bottom();
  const double area = c.geometry == 1 ? 4.0 : M_PI * 16.0;
  EXPECT_NEAR(run.reaction(run.last(), base, 1), kWeight * 6.0 * area, 1e-9 * kWeight * 6.0 * area);
}

INSTANTIATE_TEST_SUITE_P(Grounds, NullStage,
                         testing::Values(NullCase{"PlaneQuad4", 1, Cell::quad4, 1, 0.5},
                                         NullCase{"RingQuad4", 2, Cell::quad4, 1, 0.5},
                                         NullCase{"PlaneQuad8", 1, Cell::quad8, 1, 0.8},
                                         NullCase{"RingQuad8", 2, Cell::quad8, 1, 0.8},
                                         NullCase{"PlaneTri6", 1, Cell::tri6, 1, 1.2},
                                         NullCase{"RingTri6SixPoints", 2, Cell::tri6, 1, 1.2, 2},
                                         NullCase{"PlaneQuad9", 1, Cell::quad9, 1, 0.5},
                                         NullCase{"RingQuad9", 2, Cell::quad9, 1, 0.5},
                                         NullCase{"PlaneMohrCoulomb", 1, Cell::quad8, 4, 0.5},
                                         NullCase{"RingMohrCoulomb", 2, Cell::quad4, 4, 0.5},
                                         NullCase{"PlaneDruckerPrager", 1, Cell::quad4, 3, 0.6},
                                         NullCase{"RingDruckerPrager", 2, Cell::quad8, 3, 0.6}),
                         [](const auto& one) { return std::string(one.param.name); });

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

// Gravity on a column that can't widen: sigma_h = nu/(1-nu) sigma_v, and the settlement gamma H^2/(2 M).
TEST(RestColumn, HorizontalStressAndSettlement) {
  for (int geometry : {1, 2}) {
    Ground ground(geometry, Cell::quad8, 1, 5);
    ground.deck.material(1, 1, {kE, kNu}, kWeight);
    ground.deck.group(1, 2, 0, 1);
    ground.block.write_elements(ground.deck, 1);
    ground.deck.stage().gravity_y = -1.0;
    const WholeRun run = run_text(ground.deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    const double modulus = kE * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu));
    EXPECT_NEAR(run.u(ground.block.top().front()).y(), -kWeight * 25.0 / (2 * modulus), 1e-12);
    const PointStresses& s = run.stress[0];
    EXPECT_LT((s.row(0) - kNu / (1 - kNu) * s.row(1)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((s.row(2) - s.row(0)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(s.row(1).maxCoeff(), 0.0);
  }
}

// A pit of four cells' depth beside a wall of ground, dug in the given portions of rows (a group a row).
WholeRun dig(int geometry, const std::vector<int>& portions, bool initial_stress) {
  const int columns = 6, rows = 6, wide = 3, deep = 4;
  Ground ground(geometry, Cell::quad4, columns, rows);
  ground.deck.material(1, 1, {kE, kNu}, kWeight);
  for (int g = 1; g <= 1 + deep; ++g) ground.deck.group(g, 1, 2, 1);
  Block all = ground.block;
  all.write_elements(ground.deck, 1);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < wide; ++i) {
      const int layer = rows - 1 - j;  // 0 at the surface
      if (layer >= deep) continue;
      const int n = all.node(i, j);
      DeckWriter card(1);
      card.element(all.element(i, j), 2 + layer, {n, n + 1, n + 1 + all.across(), n + all.across()});
      ground.deck.elements[static_cast<std::size_t>(all.element(i, j) - 1)] = card.elements.front();
    }
  if (initial_stress)
    for (int g = 1; g <= 1 + deep; ++g) ground.deck.initial(g, 1, 0.0, kWeight, 0.7, 0.0);
  ground.deck.stage().gravity_y = -1.0;
  int next = 2;
  for (int portion : portions) {
    StageCards& stage = ground.deck.stage(2);
    for (int k = 0; k < portion; ++k) stage.deaths.push_back(next++);
  }
  return run_text(ground.deck.text());
}

// Elastic: the order of removal can't matter (Ishihara 1970; Brown & Booker 1985).
TEST(Excavation, OneStageEqualsSeveral) {
  for (int geometry : {1, 2})
    for (bool initial_stress : {false, true}) {
      const WholeRun once = dig(geometry, {4}, initial_stress);
      const WholeRun thrice = dig(geometry, {1, 2, 1}, initial_stress);
      ASSERT_TRUE(once.completed() && thrice.completed()) << once.failure << thrice.failure;
      EXPECT_LT(once.out_of_balance, 1e-9);
      // Nodes of the ground that is left; those inside the pit stop where they were when they went.
      double difference = 0.0, size = 0.0;
      const Group& left = once.model->groups[0];
      for (int node : left.nodes) {
        const Vector2 a = once.last().u.segment<2>(2 * node), b = thrice.last().u.segment<2>(2 * node);
        difference = std::max(difference, (a - b).norm());
        size = std::max(size, a.norm());
      }
      EXPECT_LT(difference, 1e-10 * size);
      EXPECT_GT(size, 1e-3);
      EXPECT_LT((once.stress[0] - thrice.stress[0]).cwiseAbs().maxCoeff(), 1e-9);
      // The floor of the pit rises: the sign of the removal forces.
      const int floor = once.index(2 * 7 + 1);  // on the left side, two rows above the base
      EXPECT_GT(once.last().u[2 * floor + 1], once.increments[0].u[2 * floor + 1]);
    }
}

std::string shipped(const std::string& name) {
  std::ifstream file(SAGE_SOURCE_DIR "/legacy_inputs/stages/" + name + "/deck.dat");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The same over decks that are shipped, with a wall and its interfaces; and the base carries the weight that is
// left.
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
          up += lifts.reaction(lifts.increments[stage], lifts.model->mesh.number[static_cast<std::size_t>(i)])
                    .y();
      const double left = name == "cut" ? 16.5 * 10.0 - 4.0 * dug : M_PI * (16.5 * 16.5 * 10.0 - 16.0 * dug);
      EXPECT_NEAR(up, 18.0 * left, 1e-9 * 18.0 * left) << "stage " << stage + 1;
    }
  }
}

// A free standing excavation carries no traction on its new surface: reactions equal the weight that is left.
TEST(Excavation, SupportsCarryWhatIsLeft) {
  const WholeRun run = dig(1, {2, 2}, true);
  double up = 0.0;
  for (int i = 0; i < run.model->mesh.nodes(); ++i)
    up += run.reaction(run.last(), run.model->mesh.number[static_cast<std::size_t>(i)]).y();
  EXPECT_NEAR(up, kWeight * (36.0 - 12.0), 1e-8);
}

// A column of three lifts that can't widen, each placed stress-free and then heavy.  Settlement of the top of
// the first lift: its own weight, then two lifts above it; the top lift starts at zero.  Closed form.
TEST(Fill, LiftsOnAColumn) {
  Ground ground(1, Cell::quad4, 1, 3);
  ground.deck.material(1, 1, {kE, kNu}, kWeight);
  Block& block = ground.block;
  for (int g = 1; g <= 3; ++g) ground.deck.group(g, 1, 1, 1);
  for (int j = 0; j < 3; ++j)
    ground.deck.element(j + 1, j + 1,
                        {block.node(0, j), block.node(1, j), block.node(1, j + 1), block.node(0, j + 1)});
  ground.deck.stage().gravity_y = -1.0;
  ground.deck.stages[0].births = {1};
  ground.deck.stage().births = {2};
  ground.deck.stage().births = {3};
  const WholeRun run = run_text(ground.deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double M = kE * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu)),
               one = kWeight / M;  // a lift's own pressure / M
  EXPECT_NEAR(run.u(block.node(0, 1)).y(), -(0.5 + 1 + 1) * one, 1e-12);
  EXPECT_NEAR(run.u(block.node(0, 2)).y(), -(1 + 1) * one - (0.5 + 1) * one, 1e-12);
  EXPECT_NEAR(run.u(block.node(0, 3)).y(), -1.0 * one - 1.0 * one - 0.5 * one, 1e-12);
  for (int lift = 0; lift < 3; ++lift)
    EXPECT_NEAR(run.stress[static_cast<std::size_t>(lift)].row(1).mean(), -kWeight * (2.5 - lift), 1e-9);
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
