#include "sage/analysis/free_surface.hpp"

#include <algorithm>
#include <set>

namespace sage {

bool has_free_surface(const GroupData& data) {
  return data.wants_context && data.group->flow();
}

namespace {

// Of the law's history; -1: it has none.
int place_of_permeability(const LawRef& law) {
  const std::span<const Quantity> history = history_of(law);
  for (std::size_t i = 0; i < history.size(); ++i)
    if (history[i].name == "relative_permeability") return static_cast<int>(i);
  return -1;
}

// Nodes of an edge in order.
std::vector<int> along(const int* nodes, const std::vector<int>& edge) {
  std::vector<int> list{nodes[edge[0]]};
  for (std::size_t i = 2; i < edge.size(); ++i) list.push_back(nodes[edge[i]]);
  list.push_back(nodes[edge[1]]);
  return list;
}

}  // namespace

std::vector<Vector2> free_surface(const Model& model, const std::vector<char>& active,
                                  std::span<const GroupData> groups, const DofMap& dof_map,
                                  const Eigen::VectorXd& u) {
  const int field = find_unknown(model.unknowns, "head");
  std::set<std::pair<int, int>> seen;
  std::vector<Vector2> list;
  const auto pressure = [&](int node) { return u[dof_map.of(node, field)] - model.mesh.x(1, node); };
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (active[g] == 0 || !has_free_surface(groups[g])) continue;
    const Group& group = *groups[g].group;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const std::vector<int> nodes = along(group.nodes_of(e), edge);
        for (std::size_t i = 1; i < nodes.size(); ++i) {
          const auto [a, b] = std::minmax(nodes[i - 1], nodes[i]);
          const double p = pressure(a), q = pressure(b);
          if ((p >= 0.0) == (q >= 0.0) || !seen.insert({a, b}).second) continue;
          list.push_back(model.mesh.x.col(a) + p / (p - q) * (model.mesh.x.col(b) - model.mesh.x.col(a)));
        }
      }
  }
  std::ranges::sort(
      list, [](const Vector2& a, const Vector2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  return list;
}

FreeSurfaceBlur free_surface_blur(const Model& model, std::span<const GroupData> groups) {
  constexpr double kWet = 0.99, kDry = 0.15;  // a law keeps 0.1 at most
  double wet = 0.0, between = 0.0, flow = 0.0, dry_flow = 0.0;
  for (const GroupData& data : groups) {
    const int at = data.active && has_free_surface(data) ? place_of_permeability(data.law) : -1;
    if (at < 0) continue;
    const ElementTraits& traits = data.group->element->traits();
    const auto history = static_cast<std::size_t>(data.state.history_size());
    std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
    Eigen::Matrix2Xd x;
    for (int e = 0; e < data.group->elements(); ++e) {
      element_coordinates(model.mesh, *data.group, e, x);
      data.group->element->geometry(x, geometry);
      for (int p = 0; p < traits.points; ++p) {
        const auto point = static_cast<std::size_t>(e * traits.points + p);
        const double w = geometry[p * (1 + 3 * traits.dofs)];
        const double k_r = data.state.committed.h[point * history + static_cast<std::size_t>(at)];
        const double* const v = data.state.committed.sigma.data() + 3 * point;
        const double moved = w * Vector2(v[0], v[1]).norm();
        flow += moved;
        if (k_r >= kWet) wet += w;
        if (k_r < kWet && k_r > kDry) between += w;
        if (k_r <= kDry) dry_flow += moved;
      }
    }
  }
  return {wet > 0.0 ? between / wet : 0.0, flow > 0.0 ? dry_flow / flow : 0.0};
}

}  // namespace sage
