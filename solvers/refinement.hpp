// What can be found out about a factorised matrix, on demand: its condition and a better answer.
#pragma once

#include <span>

#include "sage/core/linear_solver.hpp"

namespace sage {

// 1 / (||K||_1 ||K^-1||_1), with the norm of the inverse estimated from below by Hager (1984) and Higham
// (1988): a few solutions with K and K^T.  1 for no equations; 0 where the estimate overflows.  About -log10 of
// it digits are lost. Needs a factorised solver that multiplies and solves transposed.
double reciprocal_condition(const LinearSolver& solver, int equations);

// Iterative refinement: x += K^-1 (b - K x), until the residual no longer halves or `steps` are done.  Returns
// the largest |b - K x| over the largest |b|.  x holds the answer of solve() on entry.
double refine(const LinearSolver& solver, std::span<const double> b, std::span<double> x, int steps);

}  // namespace sage
