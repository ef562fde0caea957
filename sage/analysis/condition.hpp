// How many digits the solution of the equations can have: the condition of a factorised matrix.
#pragma once

#include <string>

#include "sage/core/linear_solver.hpp"

namespace sage {

// 1 / (||K||_1 ||K^-1||_1), with the norm of the inverse estimated from below by Hager (1984) and
// Higham (1988), as LAPACK's xGECON does: a few solutions with K and K^T.  1 for no equations; 0 where
// the estimate overflows.  About -log10 of it digits are lost.  Needs a factorised solver; 0
// where it keeps no matrix.
double reciprocal_condition(const LinearSolver& solver, int equations);

// What a reader should know about lost digits; empty if nothing is wrong.  The condition is estimated where a small pivot or
// growth is suspicious, or where it is requested (then the report is never empty).  smallest_pivot: of all factorisations, over the largest term of its row; that of equations condensed
// before shows in no other number.  Needs a factorised solver.
struct DigitsReport {
  std::string words;
  bool poor = false;  // nine digits or more are lost
};
DigitsReport report_digits(const LinearSolver& solver, int equations, double smallest_pivot, bool asked);

}  // namespace sage
