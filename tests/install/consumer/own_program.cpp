// `sagefe` with pieces of one's own: a law, soil that is stiffer along its layers than across them, an element,
// the ten-node triangle, a bar with its law, a truss that moves, a law that depends on time, elements with a third
// unknown, a solver and a field.  This is the example of docs/manual/own_program.md.
#include "bar.hpp"
#include "consolidation.hpp"
#include "creep.hpp"
#include "diffusion.hpp"
#include "layered.hpp"
#include "own_field.hpp"
#include "sage/app/program.hpp"
#include "sparse_lu.hpp"
#include "tri10.hpp"
#include "truss.hpp"

int main(int argc, char** argv) {
  return sage::sagefe(argc, argv, [](sage::Catalogue& catalogue) {
    catalogue.materials.add(90, own::layered());
    catalogue.materials.add(80, own::rod());
    catalogue.materials.add(91, own::maxwell());
    catalogue.materials.add(92, own::swelling_soil());
    catalogue.elements.add(40, own::tri10());
    catalogue.elements.add(50, own::bar2());
    catalogue.elements.add(1041, own::diffusion_quad());
    catalogue.elements.add(1060, own::truss2());
    catalogue.elements.add(1061, own::consolidation2());
    catalogue.solvers.add(90, own::sparse_lu());
    catalogue.fields.add(own::stress_ratio());
  });
}
