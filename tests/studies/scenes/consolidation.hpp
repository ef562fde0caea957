// Soil whose pore water flows, as input of a model.
#pragma once

#include <string>
#include <vector>

#include "sage/builder/lattice_mesh.hpp"

namespace sage::scenes {

// Elastic soil of modulus E' and ratio nu', permeability k over a unit weight of water of 1.
ModelInput pore_input(const LatticeMesh& mesh, double E, double nu, double k,
                      Geometry geometry = Geometry::plane_strain);

SupportInput held(std::vector<int> nodes, bool x, bool y);
// Excess pressure held at its value, 0 at first.
SupportInput drained(std::vector<int> nodes, double value = 0.0);

// Stages without supports or loads.
StageInput shut_in();
StageInput consolidation(double duration, int increments, double grading = 1.0, double theta = 1.0);

}  // namespace sage::scenes
