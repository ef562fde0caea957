#include "sage/model/arc_sides.hpp"

#include <algorithm>
#include <cmath>

#include "sage/model/model.hpp"
#include "sage/model/solid_edges.hpp"

namespace sage {

ArcSides::ArcSides(const Mesh& mesh) {
  for (const Arc& arc : mesh.arcs)
    for (const auto& [a, z] : arc.ends) centres_.try_emplace(std::minmax(a, z), arc.centre);
}

std::optional<Vector2> ArcSides::centre(int a, int z) const {
  if (centres_.empty()) return {};
  const auto found = centres_.find(std::minmax(a, z));
  return found == centres_.end() ? std::nullopt : std::optional(found->second);
}

namespace {

bool is_curved(const Model& model, const SolidEdge& side) {
  constexpr double kStraight = 1e-9;  // of its length
  const Group& group = model.groups[side.group];
  const std::vector<int>& edge = group.element->edges()[side.local];
  if (edge.size() != 3) return false;
  const int* nodes = group.nodes_of(side.element);
  const Vector2 a = model.mesh.x.col(nodes[edge[0]]), along = model.mesh.x.col(nodes[edge[1]]) - a,
                off = model.mesh.x.col(nodes[edge[2]]) - a;
  return std::abs(along.x() * off.y() - along.y() * off.x()) > kStraight * along.squaredNorm();
}

// counts(node, node): of sides by their ends.
template <class Counts>
bool any_curved_side(const Model& model, const Counts& counts) {
  const SolidEdges edges(model);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const std::span<const SolidEdge> at = edges.at(node);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const bool inside = std::ranges::any_of(at, [&](const SolidEdge& other) {
        return &other != &at[i] && other.other == at[i].other && other.group == at[i].group;
      });
      if (!inside && counts(node, at[i].other) && is_curved(model, at[i])) return true;
    }
  }
  return false;
}

}  // namespace

bool has_curved_sides(const Model& model) {
  return any_curved_side(model, [](int, int) { return true; });
}

bool has_parabolic_sides(const Model& model) {
  const ArcSides arcs(model.mesh);
  return any_curved_side(model, [&](int a, int z) { return !arcs.centre(a, z); });
}

}  // namespace sage
