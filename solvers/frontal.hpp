// Multifrontal L U for unsymmetric matrices: nested dissection, dense fronts, no pivoting but every pivot and
// the growth of terms are checked.
#pragma once

#include <memory>

#include "sage/core/linear_solver.hpp"

namespace sage {

// L U for unsymmetric matrices.
std::unique_ptr<LinearSolver> make_frontal();
// L D L^T for symmetric matrices, definite or not.
std::unique_ptr<LinearSolver> make_frontal_ldlt();

}  // namespace sage
