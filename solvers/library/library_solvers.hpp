// Solvers that call libraries.  They form a module that is loaded when the first of them is made.
#pragma once

#include <memory>

#include "sage/core/linear_solver.hpp"

namespace sage {

std::unique_ptr<LinearSolver> make_cholmod();
std::unique_ptr<LinearSolver> make_umfpack();
std::unique_ptr<LinearSolver> make_mumps();  // only where SAGE_HAVE_MUMPS

}  // namespace sage
