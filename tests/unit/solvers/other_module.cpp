// Stands for a module of library solvers that does not belong to this program.
#include <cstdlib>

#include "solvers/library_module.hpp"

#ifndef WITHOUT_VERSION
#ifdef WITHOUT_MAKER
#define VERSION SAGE_SOLVER_MODULE_VERSION
#else
#define VERSION "sage-solvers-0"
#endif
extern "C" {
extern const char sage_solver_module_version[];
[[gnu::section(SAGE_SOLVER_MODULE_SECTION), gnu::used]] const char sage_solver_module_version[] = VERSION;
}
#endif

#ifndef WITHOUT_MAKER
extern "C" void* sage_make_library_solver(const char*) {
  return nullptr;
}

// Runs when the library is opened.
[[gnu::constructor]] static void opened() {
  setenv("SAGE_FOREIGN_MODULE_RAN", "yes", 1);
}
#endif
