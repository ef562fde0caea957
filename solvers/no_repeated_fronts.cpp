// In place of repeated_fronts.cpp, where the program is built without skips.
#include "solvers/repeated_fronts.hpp"

namespace sage {

SolverFactory frontal_with_repeats(bool /*symmetric*/) {
  return {};
}

}  // namespace sage
