#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/app/commands.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::app {

Catalogue full_catalogue() {
  Catalogue catalogue;
  register_elements(catalogue);
  register_materials(catalogue);
  register_solvers(catalogue);
  return catalogue;
}

}  // namespace sage::app
