// Edges on the outline of the solids, for formats that know sets of edges.
#pragma once

#include <vector>

#include "sage/model/activity.hpp"

namespace sage {

struct BoundaryEdge {
  int group = 0, element = 0, edge = 0;  // local
  std::vector<int> nodes{};              // both corners, then mid-side nodes in order
};

// Edges that belong to one solid element only.
std::vector<BoundaryEdge> boundary_edges(const Model& model);

// "fix_x", "fix_y", "fix_xy" where the supports hold all nodes of the edge; empty if they don't.
std::string support_name(const Activity& activity, const BoundaryEdge& edge);

}  // namespace sage
