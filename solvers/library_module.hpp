// Loads the module of library solvers on first use: most runs never pay for starting SuiteSparse and OpenBLAS.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/linear_solver.hpp"

namespace sage {

// Changes with LinearSolver and with what the module shares with the program; other modules are not accepted.
inline constexpr char kSolverModuleVersion[] = "sage-solvers-2";

// Looks for the module where SAGE_SOLVER_MODULE says, beside the executable (../<lib>/sagefe), where it was
// built and where it was installed.  Throws AnalysisError that lists these places.
std::unique_ptr<LinearSolver> make_library_solver(std::string_view name);

// The two halves of it: the places in that order, and the module's function from the first of them that holds a
// module of this version.
using MakeLibrarySolver = LinearSolver* (*)(const char* name);
std::vector<std::string> solver_module_places();
MakeLibrarySolver load_solver_module(const std::vector<std::string>& places);

}  // namespace sage
