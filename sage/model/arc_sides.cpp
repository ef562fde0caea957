#include "sage/model/arc_sides.hpp"

#include <algorithm>
#include <cmath>

#include "sage/model/coarse_shape.hpp"
#include "sage/model/model.hpp"
#include "sage/model/solid_edges.hpp"

namespace sage {

Vector2 along_arc(const Vector2& a, const Vector2& z, const Vector2& centre, double t) {
  const Vector2 from = a - centre, to = z - centre;
  const double sweep = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  const double start = from.norm(), radius = (1.0 - t) * start + t * to.norm();
  const double c = std::cos(t * sweep), s = std::sin(t * sweep);
  return centre + radius / start * Vector2(c * from.x() - s * from.y(), s * from.x() + c * from.y());
}

ArcSides::ArcSides(const Mesh& mesh) {
  for (const Arc& arc : mesh.arcs)
    for (std::size_t i = 0; i + 1 < arc.ends.size(); ++i)
      centres_.try_emplace(std::minmax(arc.ends[i], arc.ends[i + 1]), arc.centre);
}

const Vector2* ArcSides::centre(int a, int z) const {
  if (centres_.empty()) return nullptr;
  const auto found = centres_.find(std::minmax(a, z));
  return found == centres_.end() ? nullptr : &found->second;
}

Vector2 ArcSides::along(int a, int z, const Vector2& x_a, const Vector2& x_z,
                        const std::optional<Vector2>& middle, double t) const {
  const Vector2* const round = centre(a, z);
  return round != nullptr ? along_arc(x_a, x_z, *round, t) : along_edge(x_a, x_z, middle, t);
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
  return any_curved_side(model, [&](int a, int z) { return !arcs.contains(a, z); });
}

}  // namespace sage
