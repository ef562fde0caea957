#include "sage/exchange/boundary_edges.hpp"

#include <algorithm>
#include <map>

namespace sage {

std::vector<BoundaryEdge> boundary_edges(const Model& model) {
  std::map<std::pair<int, int>, int> uses;
  std::vector<BoundaryEdge> all;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.solid() || group.overlay) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const auto& edges = group.element->edges();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        BoundaryEdge edge{static_cast<int>(g), e, static_cast<int>(i), {}};
        for (int local : edges[i]) edge.nodes.push_back(group.nodes_of(e)[local]);
        ++uses[std::minmax(edge.nodes[0], edge.nodes[1])];
        all.push_back(std::move(edge));
      }
    }
  }
  std::erase_if(
      all, [&](const BoundaryEdge& edge) { return uses.at(std::minmax(edge.nodes[0], edge.nodes[1])) > 1; });
  return all;
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
