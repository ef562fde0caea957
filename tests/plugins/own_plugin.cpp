// A plug-in with a piece of every kind: the ones that the tests of the installed package have.
#include "sage/core/plugin.hpp"
#include "tests/install/consumer/layered.hpp"
#include "tests/install/consumer/own_field.hpp"
#include "tests/install/consumer/sparse_lu.hpp"
#include "tests/install/consumer/tri10.hpp"

namespace {

sage::MaterialEntry layered() {
  sage::MaterialEntry entry = own::layered();
  entry.trials = {{.values = {2e4, 1e4, 0.2, 0.3, 4e3}, .knows_directions = true}};
  return entry;
}

}  // namespace

SAGE_PLUGIN("own", "1.0", "the tests", [](sage::Catalogue& catalogue) {
  catalogue.materials.add(1000, layered());
  catalogue.elements.add(1040, own::tri10());
  catalogue.solvers.add(1090, own::sparse_lu());
  catalogue.fields.add(own::stress_ratio());
})
