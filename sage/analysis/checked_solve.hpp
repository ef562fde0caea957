// Solutions of the equations, or an error where the solver reports that one can not be used.
#pragma once

#include <span>

#include "sage/core/linear_solver.hpp"

namespace sage {

// x = K^-1 b, as LinearSolver::solve.  Throws AnalysisError.
void checked_solve(const LinearSolver& solver, std::span<const double> b, std::span<double> x);

}  // namespace sage
