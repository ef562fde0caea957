// Newton's iterations after the first take no memory.  Two runs of the same deck to different tolerances differ
// only in iterations.
#include <gtest/gtest.h>

#include <ostream>

#include "sage/analysis/run.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/conformance/allocations.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/support/run_text.hpp"

namespace sage {
namespace {

struct Count {
  std::size_t allocations = 0;
  int iterations = 0;
  RunStatus status = RunStatus::not_converged;
};

struct Watch final : Observer {
  int iterations = 0;
  void on_increment(const Model&, const StepReport& report, const Solution&) override {
    iterations += report.total_iterations;
  }
};

// Tresca under a punch: a block of 6 x 6 elements in one increment well beyond first yield.
std::string punch(int element, int formulation, int method, double tolerance, int law, int increments) {
  test::DeckWriter deck(1);
  test::Block block;
  block.cell = element == 2 ? test::Cell::quad8 : test::Cell::quad4;
  block.columns = block.rows = 6;
  block.place = test::rectangle(0.0, 2.0, 0.0, 2.0);
  block.write_nodes(deck);
  block.write_elements(deck, 1);
  if (law == 4)
    deck.material(1, 4, {1000.0, 0.3, 10.0, 0.0, 0.0});
  else
    deck.material(1, 3, {1000.0, 0.3, 10.0, 0.0, 0.0, 1.0, 1.0});
  deck.group(1, element, formulation, 1);
  for (int node : block.bottom()) deck.fix(node, 1, 1);
  for (int node : block.left()) deck.fix(node, 1, 0);
  for (int node : block.right()) deck.fix(node, 1, 0);
  test::StageCards& stage = deck.stage(increments);
  stage.method = method;
  stage.max_iterations = 400;
  stage.tolerance = tolerance;
  for (int i = 0; i < 2; ++i) stage.pressure(block.element(i, 5), 3, 42.0, 42.0);
  return deck.text();
}

Count count(const std::string& text, int solver) {
  static const Catalogue catalogue = app::full_catalogue();
  const Model model = build_model(read_deck_text(text, "punch.dat", load_layout("sage1")), catalogue);
  RunSettings settings;
  settings.choose_solver = choose_solver;
  settings.solver = solver;
  settings.threads = 1;
  Count result;
  Watch watch;
  Observer* observers[] = {&watch};
  const std::size_t before = conformance::allocations();
  const RunResult run_result = run(model, catalogue, settings, observers);
  result.allocations = conformance::allocations() - before;
  result.iterations = watch.iterations;
  result.status = run_result.status;
  return result;
}

struct Case {
  const char* name;
  int element, formulation, method, law, solver;
};

// By its name: its bytes, which GoogleTest would print, are not all set.
void PrintTo(const Case& one, std::ostream* out) {
  *out << one.name;
}

class NewtonAllocations : public testing::TestWithParam<Case> {};

TEST_P(NewtonAllocations, NoneAfterTheFirstIteration) {
  const Case& c = GetParam();
  const Count few = count(punch(c.element, c.formulation, c.method, 1e-6, c.law, 1), c.solver);
  const Count many = count(punch(c.element, c.formulation, c.method, 1e-11, c.law, 1), c.solver);
  ASSERT_EQ(few.status, RunStatus::completed);
  ASSERT_EQ(many.status, RunStatus::completed);
  ASSERT_GT(many.iterations, few.iterations) << "the runs must differ in iterations";
  EXPECT_EQ(many.allocations, few.allocations) << few.iterations << " iterations against " << many.iterations;
}

INSTANTIATE_TEST_SUITE_P(
    Methods, NewtonAllocations,
    testing::Values(Case{"newton_quad4", 1, 2, 0, 4, 1}, Case{"newton_quad8", 2, 1, 0, 4, 1},
                    Case{"newton_ldlt", 1, 2, 0, 4, 2}, Case{"newton_frontal", 1, 2, 0, 4, 5},
                    Case{"newton_drucker_prager", 1, 2, 0, 3, 1}, Case{"modified", 1, 2, 1, 4, 1},
                    Case{"initial", 1, 2, 2, 4, 1}, Case{"dogleg", 1, 2, 3, 4, 1}),
    [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace sage
