// `sagefe` with pieces of one's own: a law, soil that is stiffer along its layers than across them, an element,
// the ten-node triangle, a solver and a field.  This is the example of docs/manual/own_program.md.
#include "layered.hpp"
#include "own_field.hpp"
#include "sage/app/program.hpp"
#include "sparse_lu.hpp"
#include "tri10.hpp"

int main(int argc, char** argv) {
  return sage::sagefe(argc, argv, [](sage::Catalogue& catalogue) {
    catalogue.materials.add(90, own::layered());
    catalogue.elements.add(40, own::tri10());
    catalogue.solvers.add(90, own::sparse_lu());
    catalogue.fields.add(own::stress_ratio());
  });
}
