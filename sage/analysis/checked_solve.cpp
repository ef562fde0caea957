#include "sage/analysis/checked_solve.hpp"

#include <cstdio>

#include "sage/messages/error.hpp"

namespace sage {

void checked_solve(const LinearSolver& solver, std::span<const double> b, std::span<double> x) {
  if (solver.solve(b, x) == SolveStatus::ok) return;
  const FactorReport report = solver.report();
  char text[240];
  std::snprintf(
      text, sizeof text,
      "the answer of the equations is wrong by %.1e of the forces after refinement (terms grew by %.1e "
      "in the elimination): choose a solver that pivots (umfpack, mumps)",
      report.backward_error, report.growth);
  throw AnalysisError("S504", text);
}

}  // namespace sage
