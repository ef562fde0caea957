#include "sage/exchange/boundary_edges.hpp"

#include <algorithm>

#include "sage/model/solid_edges.hpp"

namespace sage {

std::vector<BoundaryEdge> boundary_edges(const Model& model) {
  const auto counts = [&](std::size_t g) { return model.groups[g].solid() && !model.groups[g].overlay; };
  const SolidEdges solid_edges(model, counts);
  const auto solids_at = [&](int a, int z) {
    const auto [first, last] = std::minmax(a, z);
    return std::ranges::count(solid_edges.at(first), last, &SolidEdge::other);
  };
  std::vector<BoundaryEdge> outline;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!counts(g)) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const auto& edges = group.element->edges();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const int* const nodes = group.nodes_of(e);
        if (solids_at(nodes[edges[i][0]], nodes[edges[i][1]]) > 1) continue;
        outline.push_back({static_cast<int>(g), e, static_cast<int>(i)});
        for (int local : edges[i]) outline.back().nodes.push_back(nodes[local]);
      }
    }
  }
  return outline;
}

std::string support_name(const Activity& activity, const BoundaryEdge& edge) {
  bool x = true, y = true;
  for (int node : edge.nodes) {
    x = x && activity.holds(node, 0);
    y = y && activity.holds(node, 1);
  }
  if (!x && !y) return {};
  return x && y ? "fix_xy" : x ? "fix_x" : "fix_y";
}

}  // namespace sage
