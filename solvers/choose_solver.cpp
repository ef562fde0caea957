#include "solvers/choose_solver.hpp"

#include "solvers/solver_codes.hpp"

namespace sage {

int choose_solver(const SystemSize& system) {
  if (system.equations < profile_equations(system))
    return system.symmetric ? solver_code::skyline_ldlt : solver_code::skyline_lu;
  return system.symmetric ? solver_code::frontal_ldlt : solver_code::frontal;
}

}  // namespace sage
