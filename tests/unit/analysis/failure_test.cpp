// What keeps a run from going on ends in RunResult, not in an exception; what belongs to the caller passes through.
#include <gtest/gtest.h>

#include "sage/app/commands.hpp"
#include "tests/install/consumer/sparse_lu.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

RunSettings by_skyline() {
  RunSettings settings;
  settings.solver = 1;
  return settings;
}

// The frontal solver's place, taken by one that fails in a factorisation of this number (from 1).
struct Fault {
  int at = 1;
  std::function<void()> act;
};

class FaultySolver final : public LinearSolver {
 public:
  explicit FaultySolver(Fault fault) : fault_(std::move(fault)) {}
  const SolverTraits& traits() const override { return solver_.traits(); }
  void analyse(int equations, ElementEquations elements) override {
    solver_.analyse(equations, std::move(elements));
  }
  void clear() override { solver_.clear(); }
  void add(int element, const double* K) override { solver_.add(element, K); }
  void factorise() override {
    if (++count_ >= fault_.at) fault_.act();
    solver_.factorise();
  }
  SolveStatus solve(std::span<const double> b, std::span<double> x) const override {
    return solver_.solve(b, x);
  }

 private:
  own::SparseLu solver_;
  Fault fault_;
  int count_ = 0;
};

// No answer at all, or none for a first look at the state it is given.
class NoAnswer final : public SolidLaw {
 public:
  Outcome update(const PointIn<4>&, PointOut<4>&) const override { return Outcome::cut_step; }
};

WholeRun run_with(const Fault& fault, const std::string& deck, int solver = 90) {
  Catalogue catalogue = app::full_catalogue();
  catalogue.solvers.add(90,
                        {"faulty", "fails", false, [fault] { return std::make_unique<FaultySolver>(fault); }});
  catalogue.solvers.add(91, {"missing", "has no module", false,
                             []() -> std::unique_ptr<LinearSolver> { throw AnalysisError("no module"); }});
  catalogue.materials.add(
      90, {"no_answer", "refuses everything", 4, {}, [](std::span<const double>, const UnitSystem&) -> LawPtr {
             return std::make_unique<NoAnswer>();
           }});
  RunSettings settings;
  settings.solver = solver;
  return Workbench(catalogue, {}).run(deck, {}, settings);
}

std::string specimen(int law = 3) {
  SpecimenDeck deck;
  deck.columns = 2;
  deck.rows = 3;
  deck.increments = 4;
  deck.axial_strain = 0.06;
  deck.drucker_prager = law == 3;
  return deck.text();
}

void expect_failed(const WholeRun& run, const std::string& words) {
  EXPECT_EQ(run.result.status, RunStatus::failed);
  EXPECT_NE(run.result.reason.find(words), std::string::npos) << run.result.reason;
  EXPECT_EQ(run.failure, run.result.reason);
}

TEST(Failure, SolversThatCannotServe) {
  const Fault none{1, [] {}};
  expect_failed(run_with(none, specimen(), 77), "solver 77 is unknown");
  expect_failed(run_with(none, specimen(), 2), "for symmetric matrices only");
  expect_failed(run_with(none, specimen(), 91), "no module");
}

TEST(Failure, ASolverThatGivesUpLeavesTheIncrementsBefore) {
  const Fault fault{6, [] { throw AnalysisError("out of digits"); }};
  const WholeRun run = run_with(fault, specimen());
  expect_failed(run, "out of digits");
  const WholeRun whole = run_with({1, [] {}}, specimen());
  ASSERT_TRUE(whole.completed());
  ASSERT_EQ(run.increments.size(), static_cast<std::size_t>(run.result.increments_done));
  EXPECT_LT(run.increments.size(), whole.increments.size());
  for (std::size_t i = 0; i < run.increments.size(); ++i)
    EXPECT_TRUE(run.increments[i].u == whole.increments[i].u);
}

// Also one that throws what no solver should: a host program goes on.
TEST(Failure, AnyRuntimeErrorOfASolver) {
  expect_failed(run_with({1, [] { throw std::runtime_error("lost"); }}, specimen()), "lost");
}

TEST(Failure, ALawThatCannotStart) {
  DeckWriter deck(1);
  const Block block{.place = rectangle(0.0, 1.0, 0.0, 1.0)};
  block.write_nodes(deck);
  deck.material(1, 90, {});
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  deck.stage().load(3, 0.0, -1.0);
  expect_failed(run_with({1, [] {}}, deck.text()), "stage 1: a law cannot start from the state it is given");
}

TEST(Failure, MemoryAndMistakesOfPiecesAreExceptions) {
  EXPECT_THROW(run_with({1, [] { throw std::bad_alloc(); }}, specimen()), std::bad_alloc);
  EXPECT_THROW(run_with({1, [] { throw std::logic_error("a mistake"); }}, specimen()), std::logic_error);
}

struct Thrower final : Observer {
  void on_increment(const Model&, const StepReport&, const Solution&) override {
    throw AnalysisError("a result that is no number");
  }
};

TEST(Failure, WhatAnObserverThrowsIsItsCallers) {
  const Workbench bench = app::make_workbench();
  const Model model = bench.build(specimen());
  Thrower thrower;
  Observer* observers[] = {&thrower};
  EXPECT_THROW(sage::run(model, bench.catalogue(), by_skyline(), observers), AnalysisError);
  RunSettings settings = by_skyline();
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [](const std::string&) { throw OutputError("S601", "a full disk"); };
  EXPECT_THROW(sage::run(model, bench.catalogue(), settings, {}), OutputError);
}

// A solver that can't name the equation, or names one that there is not: the run ends as singular and says what the
// states show.  Without a mend an equation beyond the last would index the list of dofs.
TEST(Failure, ASingularMatrixWithoutAnEquationIsExplained) {
  for (const int equation : {-1, 1 << 20}) {
    SCOPED_TRACE(equation);
    const Fault fault{1, [=] { throw SingularMatrix(equation, 0.0, "no digit left"); }};
    const WholeRun run = run_with(fault, specimen());
    EXPECT_EQ(run.result.status, RunStatus::singular);
    for (const char* words :
         {"the stiffness matrix is singular (no digit left)", "this solver can't tell where",
          "  likely: ", "points at the last attempt", "--solver frontal"})
      EXPECT_NE(run.failure.find(words), std::string::npos) << words << "\n" << run.failure;
  }
}

}  // namespace
}  // namespace sage::test
