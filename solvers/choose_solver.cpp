#include "solvers/choose_solver.hpp"

#include "solvers/solver_codes.hpp"

namespace sage {

int choose_solver(int equations, bool symmetric) {
  if (equations < kProfileEquations) return symmetric ? solver_code::skyline_ldlt : solver_code::skyline_lu;
  return symmetric ? solver_code::frontal_ldlt : solver_code::frontal;
}

}  // namespace sage
