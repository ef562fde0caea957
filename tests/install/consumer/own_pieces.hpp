// Pieces of one's own: a law, soil that is stiffer along its layers than across them, an element, the ten-node
// triangle, a bar with its law, a truss that moves, a law that depends on time, elements with a third unknown, a solver
// and a field.
#pragma once

#include "sage/core/catalogue.hpp"

namespace own {

void add_pieces(sage::Catalogue& catalogue);

}  // namespace own
