// Profile L U and L D L^T in tiles: no pivoting, but every pivot and the growth of terms are checked.
#pragma once

#include <memory>

#include "sage/core/linear_solver.hpp"

namespace sage {

// L U for unsymmetric matrices.
std::unique_ptr<LinearSolver> make_skyline_lu();
// L D L^T for symmetric matrices, definite or not.
std::unique_ptr<LinearSolver> make_skyline_ldlt();

}  // namespace sage
