#include "solvers/register_solvers.hpp"

#include "solvers/frontal.hpp"
#include "solvers/library_module.hpp"
#include "solvers/repeated_fronts.hpp"
#include "solvers/skyline.hpp"
#include "solvers/solver_codes.hpp"

namespace sage {

namespace {

// The module with the library is loaded when the first such solver is made.
SolverEntry from_library(const char* name, const char* summary, bool symmetric) {
  return {name, summary, symmetric, [name] { return make_library_solver(name); }};
}

}  // namespace

void register_solvers(Catalogue& catalogue) {
  auto& solvers = catalogue.solvers;
  namespace code = solver_code;
  solvers.add(code::skyline_lu,
              {"skyline_lu", "profile L U without pivoting, unsymmetric", false, make_skyline_lu});
  solvers.add(code::skyline_ldlt, {"skyline_ldlt", "profile L D L^T, symmetric", true, make_skyline_ldlt});
  solvers.add(code::cholmod, from_library("cholmod", "CHOLMOD: Cholesky or L D L^T, symmetric", true));
  solvers.add(code::umfpack, from_library("umfpack", "UMFPACK: L U with pivoting, unsymmetric", false));
  solvers.add(code::frontal, {"frontal", "multifrontal L U without pivoting, unsymmetric", false, make_frontal,
                              frontal_with_repeats(false)});
#ifdef SAGE_HAVE_MUMPS
  solvers.add(code::mumps, from_library("mumps", "sequential MUMPS: L U with pivoting, unsymmetric", false));
#endif
  solvers.add(code::frontal_ldlt, {"frontal_ldlt", "multifrontal L D L^T, symmetric", true, make_frontal_ldlt,
                                   frontal_with_repeats(true)});
}

}  // namespace sage
