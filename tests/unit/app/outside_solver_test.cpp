// A solver that the program does not know, Eigen's SparseLU: the example of solvers/README.md.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "tests/install/consumer/sparse_lu.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

scenes::Workbench with_sparse_lu() {
  Catalogue catalogue = app::full_catalogue();
  catalogue.solvers.add(90, own::sparse_lu());
  return {catalogue, [](const SystemSize&) { return 90; }};
}

// Drucker-Prager soil without dilation on a rough base, c = 10, phi = 30: an unsymmetric tangent.  Both stop at
// forces out of balance of 1e-8, so the displacements agree to some 1e-6.
TEST(OutsideSolver, GivesTheSameAsABuiltInOne) {
  const scenes::TriaxialDeck deck{.law = 3,
                                  .parameters = {3000.0, 0.3, 10.0, 30.0, 0.0},
                                  .cell = 50.0,
                                  .strains = {0.1},
                                  .increments = 10,
                                  .rough_base = true,
                                  .columns = 3,
                                  .rows = 3};
  const scenes::WholeRun own = with_sparse_lu().run(deck.text());
  const scenes::WholeRun built_in = app::make_workbench().run(deck.text());
  ASSERT_TRUE(own.completed() && built_in.completed());
  EXPECT_GT(built_in.iterations(), 20) << "it yields";
  const Eigen::VectorXd difference = own.last().u - built_in.last().u;
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-6 * built_in.largest_u());
}

// It can't name the equation: the run ends as singular all the same, and says who can.
TEST(OutsideSolver, ASingularMatrixWithoutAnEquationIsNoMissingEquilibrium) {
  scenes::DeckWriter deck(1);  // two elements and a joint without shear stiffness between them
  const double y[] = {0.0, 1.0, 1.0, 2.0};
  for (int i = 0; i < 8; ++i) deck.node(i + 1, i % 2, y[i / 2]);
  deck.material(1, 1, {10000.0, 0.3});
  deck.material(2, 21, {0.0, 1e6});
  deck.group(1, 1, 0, 1);
  deck.group(2, 11, 0, 2);
  deck.group(3, 1, 0, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 2, {3, 4, 6, 5});
  deck.element(3, 3, {5, 6, 8, 7});
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  deck.stage().pressure(3, 3, 1.0, 1.0);
  const scenes::WholeRun run = with_sparse_lu().run(deck.text());
  EXPECT_EQ(run.result.status, RunStatus::singular);
  EXPECT_NE(run.failure.find("the stiffness matrix is singular (no digit of K is left in its inverse)"),
            std::string::npos)
      << run.failure;
  EXPECT_NE(run.failure.find("--solver frontal"), std::string::npos) << run.failure;
  EXPECT_EQ(app::make_workbench().run(deck.text()).result.status, RunStatus::singular);
}

// A solver that gives up ends the command as ever: with its words, and outputs that say where they end.
TEST(OutsideSolver, OneThatGivesUpEndsTheCommandWithItsWords) {
  class GivesUp final : public LinearSolver {
   public:
    const SolverTraits& traits() const override { return traits_; }
    void analyse(int, ElementEquations) override {}
    void clear() override {}
    void add(int, const double*) override {}
    void factorise() override { throw AnalysisError("out of digits"); }
    SolveStatus solve(std::span<const double>, std::span<double>) const override { return SolveStatus::ok; }

   private:
    SolverTraits traits_{.name = "gives_up"};
  };
  Catalogue catalogue = app::full_catalogue();
  catalogue.solvers.add(91, {"gives_up", "throws", false, [] { return std::make_unique<GivesUp>(); }});
  app::RunRequest request;
  request.deck = SAGE_SOURCE_DIR "/legacy_inputs/chapter7/pinned_ld2_nu025/deck.dat";
  request.output.folder = test::scratch_folder("gives_up");
  request.solver = "gives_up";
  request.quiet = true;
  try {
    app::run_deck(request, catalogue);
    ADD_FAILURE() << "it went on";
  } catch (const AnalysisError& error) {
    EXPECT_STREQ(error.what(), "out of digits [S510]");
  }
  std::ifstream in(request.output.folder / (app::stem_of(request) + ".increments.csv"));
  const std::string rows{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(rows.find("# RUN STOPPED, NOT COMPLETE: out of digits"), std::string::npos) << rows;
}

}  // namespace
}  // namespace sage
