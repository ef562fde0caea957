// Edges on the outline of the solids, for formats that know sets of edges.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct BoundaryEdge {
  int group = 0, element = 0, edge = 0;  // local
  std::vector<int> nodes;                // both corners, then mid-side nodes in order
};

// Edges that belong to one solid element only.
std::vector<BoundaryEdge> boundary_edges(const Model& model);

// "fix_x", "fix_y", "fix_xy" where the model's supports hold all nodes of the edge; empty if they don't.
std::string support_name(const std::vector<char>& held, const BoundaryEdge& edge);

// What the fixities before the first stage hold: two entries a node.
std::vector<char> held_dofs(const Model& model);

}  // namespace sage
