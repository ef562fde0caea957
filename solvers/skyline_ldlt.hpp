// Skyline L D L^T for symmetric matrices, definite or not: no pivoting, but every pivot is checked and counted.
#pragma once

#include <memory>

#include "sage/core/linear_solver.hpp"

namespace sage {

std::unique_ptr<LinearSolver> make_skyline_ldlt();

}  // namespace sage
