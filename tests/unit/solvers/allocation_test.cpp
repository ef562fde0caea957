// After the first factorisation and solution with a pattern, own solvers take no memory.
#include <gtest/gtest.h>

#include <ostream>

#include "sage/conformance/allocations.hpp"
#include "sage/conformance/solver_systems.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::test {

using namespace conformance;

namespace {

struct Case {
  const char* solver;
  int threads, refinement;
};

// By its name: its bytes, which GoogleTest would print, are not all set.
void PrintTo(const Case& one, std::ostream* out) {
  *out << one.solver;
}

class SolverAllocations : public testing::TestWithParam<Case> {};

TEST_P(SolverAllocations, NoneAfterTheFirstFactorisationAndSolution) {
  Catalogue catalogue;
  register_solvers(catalogue);
  std::unique_ptr<LinearSolver> solver;
  for (const auto& [code, entry] : catalogue.solvers.entries())
    if (entry.name == GetParam().solver) solver = entry.make();
  ASSERT_NE(solver, nullptr);
  const System system = q4_mesh({.columns = 60, .rows = 70});  // large enough for several subtrees
  solver->configure({.threads = GetParam().threads, .refinement_steps = GetParam().refinement});
  load(*solver, system);
  const auto n = static_cast<std::size_t>(system.equations);
  const std::vector<double> b(n, 1.0);
  std::vector<double> x(n);
  const auto iterate = [&] {
    solver->clear();
    for (int e = 0; e < system.elements.count(); ++e) solver->add(e, system.K[e].data());
    solver->factorise();
    EXPECT_EQ(solver->solve(b, x), SolveStatus::ok);
  };
  const std::size_t start = allocations();
  iterate();
  EXPECT_GT(allocations(), start);  // the counter sees the solver
  const std::size_t before = allocations();
  for (int i = 0; i < 3; ++i) iterate();
  EXPECT_EQ(allocations() - before, 0u);
}

INSTANTIATE_TEST_SUITE_P(Own, SolverAllocations,
                         testing::Values(Case{"skyline_lu", 1, 0}, Case{"skyline_ldlt", 1, 0},
                                         Case{"frontal", 1, 0}, Case{"frontal", 2, 0},
                                         Case{"frontal_ldlt", 1, 0}, Case{"frontal_ldlt", 2, 0},
                                         Case{"frontal", 1, 3}));

}  // namespace
}  // namespace sage::test
