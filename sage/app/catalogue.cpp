#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/app/commands.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::app {

Catalogue full_catalogue() {
  Catalogue catalogue;
  register_elements(catalogue);
  register_materials(catalogue);
  register_solvers(catalogue);
  return catalogue;
}

study::Workbench make_workbench() {
  return {full_catalogue(), choose_solver};
}

}  // namespace sage::app
