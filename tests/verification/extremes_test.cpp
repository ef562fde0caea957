// Decks at the edge of what makes sense: no strength at all, one huge step, tiny steps, nothing to do, methods
// beside each other.  Whatever happens, numbers stay finite and a run that is not complete says so.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

void expect_clean_end(const WholeRun& run) {
  EXPECT_EQ(run.completed(), run.failure.empty());
  EXPECT_EQ(run.completed(), run.result.reason.empty());
  for (const Snapshot& s : run.increments) {
    EXPECT_TRUE(s.u.allFinite());
    EXPECT_TRUE(s.internal.allFinite());
  }
  for (const PointStresses& stress : run.stress) EXPECT_TRUE(stress.allFinite());
  if (run.completed()) {
    EXPECT_LT(run.out_of_balance, 1e-6);
  }
}

// A specimen of one law on a rough base, cell pressure p, compressed by `strain`.
WholeRun compress(int law, const std::vector<double>& parameters, double p, double strain, int increments,
                  int method = 0) {
  TriaxialDeck deck;
  deck.law = law;
  deck.parameters = parameters;
  deck.cell = p;
  deck.strains = {strain};
  deck.increments = increments;
  deck.method = method;
  if (method == 1 || method == 2) deck.max_iterations = 2000;  // they converge linearly
  deck.rough_base = true;                                      // so that stress is not uniform
  deck.columns = 3;
  deck.rows = 6;
  return run_text(deck.text());
}

class PlasticLaw : public testing::TestWithParam<int> {};

// No cohesion, no friction: a fluid.  Under an all-round pressure it stays in equilibrium; sheared it has no
// stiffness, and the program may say so, but not invent numbers.
TEST_P(PlasticLaw, WithoutStrength) {
  for (double strain : {0.0, 0.01}) {
    const WholeRun run = compress(GetParam(), {1000.0, 0.3, 0.0, 0.0, 0.0}, 50.0, strain, 4);
    expect_clean_end(run);
    std::printf("    law %d, strain %.2f: %s, %d increments\n", GetParam(), strain,
                run.completed() ? "completed" : "stopped", run.result.increments_done);
    if (strain == 0.0) {
      EXPECT_TRUE(run.completed()) << run.failure;
      EXPECT_LT(run.largest_u(), 1e-10);
    }
  }
}

// A hundred per cent in one increment: small-strain theory has an answer, the limit state.
TEST_P(PlasticLaw, OneHugeStep) {
  const WholeRun run = compress(GetParam(), {3000.0, 0.3, 10.0, 30.0, 0.0}, 50.0, 1.0, 1);
  expect_clean_end(run);
  std::printf("    law %d: %s, %d iterations, %d cuts\n", GetParam(), run.completed() ? "completed" : "stopped",
              run.last().iterations, run.last().cuts);
  EXPECT_TRUE(run.completed()) << run.failure;
}

// Increments of 1e-13 of strain: elastic, and the same stiffness as with one increment of the sum.
TEST_P(PlasticLaw, TinySteps) {
  const double strain = 2e-12;
  const WholeRun many = compress(GetParam(), {3000.0, 0.3, 10.0, 30.0, 0.0}, 0.0, strain, 20);
  const WholeRun one = compress(GetParam(), {3000.0, 0.3, 10.0, 30.0, 0.0}, 0.0, strain, 1);
  expect_clean_end(many);
  ASSERT_TRUE(many.completed() && one.completed()) << many.failure << one.failure;
  const double size = one.last().internal.cwiseAbs().maxCoeff();
  EXPECT_GT(size, 0.0);
  EXPECT_LT((many.last().internal - one.last().internal).cwiseAbs().maxCoeff(), 1e-9 * size);
}

// Nothing is loaded: a stage without anything to do is complete, and nothing moves.
TEST_P(PlasticLaw, NothingToDo) {
  const WholeRun run = compress(GetParam(), {3000.0, 0.3, 10.0, 30.0, 0.0}, 0.0, 0.0, 3);
  expect_clean_end(run);
  EXPECT_TRUE(run.completed()) << run.failure;
  EXPECT_EQ(run.largest_u(), 0.0);
}

// Newton, modified Newton, initial stiffness and dogleg are ways to the same answer.  Modified Newton has the
// tangent of a yielding specimen, and must need far fewer iterations than the elastic one.
TEST_P(PlasticLaw, MethodsAgree) {
  const std::vector<double> parameters{3000.0, 0.3, 10.0, 30.0, 0.0};
  const WholeRun newton = compress(GetParam(), parameters, 50.0, 0.06, 30);
  ASSERT_TRUE(newton.completed()) << newton.failure;
  const double size = newton.last().internal.cwiseAbs().maxCoeff();
  EXPECT_GT(newton.last().points[static_cast<std::size_t>(PointStatus::yielded)], 0);
  int iterations[4] = {};
  for (int method : {1, 2, 3}) {
    if (method == 2 && GetParam() == 4) continue;  // thousands of iterations: too long for a test
    const WholeRun other = compress(GetParam(), parameters, 50.0, 0.06, 30, method);
    expect_clean_end(other);
    std::printf("    law %d, method %d: %s, %d iterations (Newton %d)\n", GetParam(), method,
                other.completed() ? "completed" : "stopped", other.iterations(), newton.iterations());
    ASSERT_TRUE(other.completed()) << other.failure;
    iterations[method] = other.iterations();
    EXPECT_LT((other.last().internal - newton.last().internal).cwiseAbs().maxCoeff(), 1e-5 * size) << method;
  }
  if (GetParam() == 3) {
    EXPECT_LT(2 * iterations[1], iterations[2]);
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, PlasticLaw, testing::Values(3, 4),
                         [](const auto& one) { return one.param == 3 ? "DruckerPrager" : "MohrCoulomb"; });

// The chapter's kind of specimen on its interface, in one increment of 100 % and in tiny ones.
TEST(Specimen, HugeAndTinySteps) {
  for (double strain : {1.0, 1e-9})
    for (bool drucker_prager : {false, true}) {
      SpecimenDeck deck;
      deck.drucker_prager = drucker_prager;
      deck.increments = strain < 1.0 ? 50 : 1;
      deck.axial_strain = strain;
      const WholeRun run = run_text(deck.text());
      expect_clean_end(run);
      std::printf("    %s, strain %.0e: %s, %d iterations\n", drucker_prager ? "Drucker-Prager" : "elastic",
                  strain, run.completed() ? "completed" : "stopped", run.iterations());
      EXPECT_TRUE(run.completed()) << run.failure;
    }
}

// Two bodies with a slanting joint between them, moved as one: the joint carries nothing, and
// the sign of its opening is rounding.  Moved apart by 1e-9 a step it is open.
TEST(ZeroContact, RoundingIsNoOpening) {
  for (const int law : {21, 22})
    for (const double apart : {0.0, 1e-9}) {
      SCOPED_TRACE(std::to_string(law) + (apart > 0.0 ? " apart" : " together"));
      std::vector<double> joint{1e6, 1e6};
      if (law == 22) {
        joint = coulomb(0.0, 30.0, 1e6, 1e6);
        joint[7] = 0.0;  // no tension
      }
      DeckWriter deck(1);
      deck.water_unit_weight = 1.0;
      const double y[] = {0.0, 0.7, 0.7, 1.3};
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 3; ++i)
          deck.node(3 * j + i + 1, 0.8 * 0.37 * i - 0.6 * y[j], 0.6 * 0.37 * i + 0.8 * y[j]);
      deck.material(1, 1, {1000.0, 0.3});
      deck.material(2, law, joint);
      deck.group(1, 1, 1, 1);
      deck.group(2, 11, 0, 2);
      for (int i = 1; i <= 2; ++i) {
        deck.element(i, 1, {i, i + 1, i + 4, i + 3});
        deck.element(i + 2, 1, {i + 6, i + 7, i + 10, i + 9});
      }
      join(deck, 11, 2, {4, 5, 6}, {7, 8, 9}, 1);
      const int held[] = {1, 2, 3, 10, 11, 12};  // the far ends; what is at the joint follows
      for (int n : held) deck.fix(n, 1, 1);
      StageCards& stage = deck.stage(7);
      for (int n : held) {
        const double more = n > 6 ? 7.0 * apart : 0.0;
        stage.fix(n, 1, 1, 0.1 - 0.6 * more, 0.3 + 0.8 * more);
      }
      const WholeRun run = run_text(deck.text());
      ASSERT_TRUE(run.completed()) << run.failure;
      const long points = apart > 0.0 ? 4 : 0;
      for (const Snapshot& at : run.increments)
        EXPECT_EQ(at.points[static_cast<std::size_t>(PointStatus::open)], points);
    }
}

// Near nu = 1/2 internal forces carry K/G times the rounding of the displacements.  An elastic run that can't
// reach its tolerance for that ends with the answer and says to what its forces balance.
TEST(NearlyIncompressible, AnElasticRunEndsAtRoundingAndSaysSo) {
  DeckWriter deck = LameDeck{LameBody::sector, Cell::quad8, 1, 8}.deck();
  deck.materials.clear();
  deck.material(1, 2, {1e8, 0.5});  // K/G = 2e8
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double u = 4.0 / 3.0;  // p a b^2/(2 G (b^2 - a^2)), nu = 1/2
  EXPECT_NEAR(run.u(1).x(), u, 1e-3 * u);
  EXPECT_TRUE(run.warns("rounding"));
}

}  // namespace
}  // namespace sage::test
