#include "solvers/register_solvers.hpp"

#include "solvers/frontal.hpp"
#include "solvers/library_module.hpp"
#include "solvers/skyline_ldlt.hpp"
#include "solvers/skyline_lu.hpp"

namespace sage {

void register_solvers(Catalogue& catalogue) {
  auto& solvers = catalogue.solvers;
  solvers.add(1, {"skyline_lu", "profile L U without pivoting, unsymmetric", false, make_skyline_lu});
  solvers.add(2, {"skyline_ldlt", "profile L D L^T, symmetric", true, make_skyline_ldlt});
  solvers.add(
      3, {"cholmod", "SuiteSparse CHOLMOD, symmetric", true, [] { return make_library_solver("cholmod"); }});
  solvers.add(
      4, {"umfpack", "SuiteSparse UMFPACK, unsymmetric", false, [] { return make_library_solver("umfpack"); }});
  solvers.add(5, {"frontal", "multifrontal L U without pivoting, unsymmetric", false, make_frontal});
  solvers.add(8, {"frontal_ldlt", "multifrontal L D L^T, symmetric", true, make_frontal_ldlt});
}

}  // namespace sage
