// What the program looks for in this module: its version, which it reads in the file before it loads it, and
// one function.
#include <string_view>

#include "solvers/library/library_solvers.hpp"
#include "solvers/library_module.hpp"

extern "C" {

extern const char sage_solver_module_version[];
[[gnu::section(SAGE_SOLVER_MODULE_SECTION), gnu::used]] const char sage_solver_module_version[] =
    SAGE_SOLVER_MODULE_VERSION;

// The caller owns the solver.  nullptr: the module was built without it.
sage::LinearSolver* sage_make_library_solver(const char* name) {
  const std::string_view wanted = name;
  if (wanted == "cholmod") return sage::make_cholmod().release();
  if (wanted == "umfpack") return sage::make_umfpack().release();
#ifdef SAGE_HAVE_MUMPS
  if (wanted == "mumps") return sage::make_mumps().release();
#endif
  return nullptr;
}

}  // extern "C"
