// Loads the module of library solvers on first use: most runs never pay for starting SuiteSparse and OpenBLAS.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/linear_solver.hpp"
#include "sage/platform/module.hpp"

namespace sage {

// Changes with LinearSolver and with what the module shares with the program; other modules are not accepted.
// The module holds it in a section of its own, where it can be read before anything of the module runs.
#define SAGE_SOLVER_MODULE_VERSION "sage-solvers-4"
#define SAGE_SOLVER_MODULE_SECTION SAGE_MODULE_SECTION

// Looks for the module where SAGE_SOLVER_MODULE says, beside the executable (../<lib>/sagefe), and on the
// search path that the linker wrote into the executable, which programs of the build tree have and installed
// ones have not.  Throws AnalysisError that lists these places.
std::unique_ptr<LinearSolver> make_library_solver(std::string_view name);

// The two halves of it: the places in that order, and the module's function from the first of them that holds a
// module of this version.
using MakeLibrarySolver = LinearSolver* (*)(const char* name);
std::vector<std::string> solver_module_places();
MakeLibrarySolver load_solver_module(const std::vector<std::string>& places);

}  // namespace sage
