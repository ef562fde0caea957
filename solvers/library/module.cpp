// The two functions that the program looks up after loading this module.
#include <string_view>

#include "solvers/library/library_solvers.hpp"
#include "solvers/library_module.hpp"

extern "C" {

const char* sage_solver_module_version() {
  return sage::kSolverModuleVersion;
}

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
