// Loads that are spread along bars and beams: pressures on their edges, weight, free water on their sides.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// Weight of a group under its material's unit weight: of solids a force per volume.  Of lines a force per length and
// unit of width: of a plate the unit weight times its thickness, of bars that stand apart that of one over the spacing.
double weight_density(const Model& model, const Group& group);

// Distance from one bar of a law to the next; 1 where they do not stand apart.
double spacing_of(const LawRef& law);

// Those that act on a group of structures at the end of a stage (0-based; -1: none yet): a force a dof, element after
// element.  Empty: there are none.
std::vector<double> spread_loads(const Model& model, int stage, std::size_t group);

}  // namespace sage
