#include "tests/studies/workbench.hpp"

#include "solvers/choose_solver.hpp"

namespace sage::app {

scenes::Workbench make_workbench(const Catalogue& catalogue) {
  return {catalogue, choose_solver};
}

}  // namespace sage::app
