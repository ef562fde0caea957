#include "own_pieces.hpp"

#include "bar.hpp"
#include "consolidation.hpp"
#include "creep.hpp"
#include "diffusion.hpp"
#include "layered.hpp"
#include "own_field.hpp"
#include "sparse_lu.hpp"
#include "tri10.hpp"
#include "truss.hpp"

void own::add_pieces(sage::Catalogue& catalogue) {
  catalogue.materials.add(90, layered());
  catalogue.materials.add(80, rod());
  catalogue.materials.add(91, maxwell());
  catalogue.materials.add(92, swelling_soil());
  catalogue.elements.add(40, tri10());
  catalogue.elements.add(50, bar2());
  catalogue.elements.add(1041, diffusion_quad());
  catalogue.elements.add(1060, truss2());
  catalogue.elements.add(1061, consolidation2());
  catalogue.solvers.add(90, sparse_lu());
  catalogue.fields.add(stress_ratio());
}
