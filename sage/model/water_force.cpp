#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "sage/model/water_parts.hpp"

namespace sage {

using namespace water;

namespace {

Vector2 parent_corner(bool triangle, int corner) {
  static const Vector2 kSquare[] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
  static const Vector2 kTriangle[] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  return triangle ? kTriangle[corner] : kSquare[corner];
}

// Pairs of nodes that an active bar or beam goes along, whole elements and their halves.
std::set<std::pair<int, int>> lines_of_structures(const Model& model, const std::vector<char>& groups) {
  std::set<std::pair<int, int>> lines;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.structure() || group.element->edges().empty()) continue;
    const std::vector<int>& edge = group.element->edges().front();
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < edge.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) lines.insert(edge_key(nodes[edge[i]], nodes[edge[k]]));
    }
  }
  return lines;
}

// An element of a structure lies along the whole edge, or one along each part of it.
bool carries_structure(const std::set<std::pair<int, int>>& lines, const int* nodes,
                       const std::vector<int>& edge) {
  if (lines.empty()) return false;
  if (lines.contains(edge_key(nodes[edge[0]], nodes[edge[1]]))) return true;
  int last = nodes[edge[0]];
  const auto goes_on = [&](int next) { return lines.contains(edge_key(std::exchange(last, next), next)); };
  for (std::size_t i = 2; i < edge.size(); ++i)
    if (!goes_on(nodes[edge[i]])) return false;
  return edge.size() > 2 && goes_on(nodes[edge[1]]);
}

}  // namespace

std::vector<FreeEdge> free_edges(const Model& model, const std::vector<char>& groups) {
  const std::set<std::pair<int, int>> lines = lines_of_structures(model, groups);
  std::vector<FreeEdge> free;
  edges_of_active(model, groups).for_single([&](int, const SolidEdge& edge) {
    const Group& group = model.groups[edge.group];
    const std::vector<int>& local = group.element->edges()[edge.local];
    free.push_back(
        {edge.group, edge.element, edge.local, carries_structure(lines, group.nodes_of(edge.element), local)});
  });
  return free;
}

namespace {

// The force of water, put together.
class WaterForce {
 public:
  WaterForce(const Model& model, const Activity& activity, const PorePressure& water)
      : model_(model), activity_(activity), water_(water) {
    force_.setZero(activity.dof_map.dofs());
  }

  Eigen::VectorXd sum() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (water_.card(g) != nullptr) add_group(g);
    add_edges();
    add_structures();
    return std::move(force_);
  }

 private:
  void add_group(std::size_t g) {
    const Group& group = model_.groups[g];
    const bool ring = model_.geometry == Geometry::axisymmetric;
    const bool as_force = water_.card(g)->action == WaterAction::force;
    const std::vector<RulePlace> rule = rule_for(group.entry->triangle(), group.element->traits().degree);
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_.mesh, group, e, x_);
      const int* const nodes = group.nodes_of(e);
      for (const RulePlace& q : rule) {
        mapped_.take(*group.element, x_, q.parent);
        mapped_.take_derivatives();
        const double w = q.weight * mapped_.det() * measure(model_, mapped_.place);
        const double u = water_.at(g, e, mapped_.place, mapped_.N);
        if (!(u > 0.0)) continue;
        const Vector2 slope =
            as_force ? water_.gradient(g, e, mapped_.place, mapped_.N, mapped_.dN) : Vector2(0.0, 0.0);
        for (Eigen::Index i = 0; i < x_.cols(); ++i) {
          const double N = mapped_.N[i];
          Vector2 f = u * mapped_.dN.row(i).transpose();
          if (ring) f.x() += u * N / mapped_.place.x();
          if (as_force) f = -N * slope;
          at(nodes[i]) += w * f;
        }
      }
    }
  }

  // Edges where the water outside, or in a joint, has the pressure of that behind them.
  void add_edges() {
    std::vector<FreeEdge> wet;
    std::set<std::pair<int, int>> keys;
    for (const FreeEdge& edge : free_edges(model_, activity_.group)) {
      const WaterCard* const card = water_.card(static_cast<std::size_t>(edge.group));
      if (card == nullptr || card->kind == WaterKind::ratio) continue;
      // Seepage force and buoyancy have the water at their edges in them.
      if (card->action == WaterAction::force) {
        keys.insert(key_of(edge));
        if (edge.on_structure) in_forces_.emplace(key_of(edge), edge);
      }
      if (card->action != WaterAction::edges || edge.on_structure) continue;
      wet.push_back(edge);
      keys.insert(key_of(edge));
    }
    take_joints();
    for (const FreeEdge& edge : wet) add_edge(edge, keys);
    take_back_shared();
  }

  // Where solids with seepage force meet such with pressures, no water stands between them: what the seepage force has
  // of it goes.
  void take_back_shared() {
    const auto card_of = [&](const SolidEdge& edge) {
      return water_.card(static_cast<std::size_t>(edge.group));
    };
    bool forces = false, pressures = false;
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (const WaterCard* const card = water_.card(g); card != nullptr)
        (card->action == WaterAction::force ? forces : pressures) = true;
    if (!forces || !pressures) return;
    const SolidEdges solids = edges_of_active(model_, activity_.group);
    for (int node = 0; node < model_.mesh.nodes(); ++node)
      for (const SolidEdge& edge : solids.at(node)) {
        if (card_of(edge) == nullptr || card_of(edge)->action != WaterAction::force) continue;
        const bool meets = std::ranges::any_of(solids.at(node), [&](const SolidEdge& one) {
          const WaterCard* const card = card_of(one);
          return one.other == edge.other && card != nullptr && card->action != WaterAction::force;
        });
        if (meets) press_edge({edge.group, edge.element, edge.local, false}, -1.0, nullptr);
      }
  }

  std::pair<int, int> key_of(const FreeEdge& edge) const {
    const Group& group = model_.groups[edge.group];
    const std::vector<int>& local = group.element->edges()[edge.edge];
    const int* const nodes = group.nodes_of(edge.element);
    return edge_key(nodes[local[0]], nodes[local[1]]);
  }

  // Sides of active interfaces: by their end nodes the nodes that lie opposite of each.
  void take_joints() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const Group& group = model_.groups[g];
      if (!activity_.group[g] || !group.interface()) continue;
      for (int e = 0; e < group.elements(); ++e) {
        const int* const n = group.nodes_of(e);
        std::map<int, int> right{{n[0], n[3]}, {n[1], n[2]}};
        for (std::size_t pair = 4; pair + 1 < group.node_count(); pair += 2) right[n[pair]] = n[pair + 1];
        std::map<int, int> left;
        for (const auto& [a, b] : right) left[b] = a;
        joints_[edge_key(n[0], n[1])] = std::move(right);
        joints_[edge_key(n[2], n[3])] = std::move(left);
      }
    }
  }

  // Supports hold both ends of the edge against its normal: the ground goes on behind it.
  bool is_held(const FreeEdge& edge) const {
    const Group& group = model_.groups[edge.group];
    const std::vector<int>& local = group.element->edges()[edge.edge];
    const int* const nodes = group.nodes_of(edge.element);
    const int a = nodes[local[0]], z = nodes[local[1]];
    const Vector2 along = Vector2(model_.mesh.x.col(z) - model_.mesh.x.col(a)).normalized();
    const Vector2 normal(-along.y(), along.x());
    return is_held(a, normal) && is_held(z, normal);
  }

  // Along a unit vector.
  bool is_held(int node, const Vector2& n) const {
    constexpr double kParallel = 1e-3;  // angles of cards have few digits
    const TurnedNode* const turned = activity_.turned_at(node);
    if (turned != nullptr && turned->slides)
      return std::abs(turned->slide[0] * n.x() + turned->slide[1] * n.y()) < kParallel;
    return (std::abs(n.x()) < kParallel || activity_.holds(node, 0)) &&
           (std::abs(n.y()) < kParallel || activity_.holds(node, 1));
  }

  // -u n on the solid; what lies behind a joint gets the opposite unless it is wet itself.
  void add_edge(const FreeEdge& edge, const std::set<std::pair<int, int>>& wet) {
    const Group& group = model_.groups[edge.group];
    const int* const nodes = group.nodes_of(edge.element);
    const std::vector<int>& local = group.element->edges()[edge.edge];
    const auto joint = joints_.find(key_of(edge));
    const std::map<int, int>* behind = joint == joints_.end() ? nullptr : &joint->second;
    if (behind != nullptr) {
      const auto other = [&](int corner) { return behind->at(nodes[local[corner]]); };
      if (wet.contains(edge_key(other(0), other(1)))) behind = nullptr;
    }
    press_edge(edge, 1.0, behind, joint == joints_.end() && !is_held(edge));
  }

  // -u n on the solid, times sense, and the opposite on the nodes behind.  open: u of the water outside.
  void press_edge(const FreeEdge& edge, double sense, const std::map<int, int>* behind, bool open = false) {
    const auto g = static_cast<std::size_t>(edge.group);
    const Group& group = model_.groups[g];
    const bool triangle = group.entry->triangle();
    element_coordinates(model_.mesh, group, edge.element, x_);
    const int* const nodes = group.nodes_of(edge.element);
    const std::vector<int>& local = group.element->edges()[edge.edge];
    const Vector2 from = parent_corner(triangle, local[0]), to = parent_corner(triangle, local[1]);
    const GaussRule line(group.element->traits().degree + 2);
    for (std::size_t q = 0; q < line.x.size(); ++q) {
      mapped_.take(*group.element, x_, from + 0.5 * (1.0 + line.x[q]) * (to - from));
      const Vector2 along = 0.5 * mapped_.J * (to - from);
      const double w = sense * line.w[q] * measure(model_, mapped_.place);
      const double u = open ? water_.outside(g, edge.element, mapped_.place, mapped_.N)
                            : water_.at(g, edge.element, mapped_.place, mapped_.N);
      if (!(u > 0.0)) continue;
      for (const int i : local) {
        const Vector2 f = mapped_.N[i] * w * u * Vector2(-along.y(), along.x());
        at(nodes[i]) += f;
        if (behind == nullptr) continue;
        if (const auto opposite = behind->find(nodes[i]); opposite != behind->end()) at(opposite->second) -= f;
      }
    }
  }

  void add_structures() {
    std::vector<int> dofs;
    const auto add = [&](int g, int element, std::span<const double> f) {
      const Group& group = model_.groups[g];
      activity_.dof_map.list(group, element, dofs);
      for (std::size_t i = 0; i < dofs.size(); ++i) force_[dofs[i]] += f[i];
      take_back_behind(group, element);
    };
    water_on_structures(model_, water_.stage(), activity_.group, -1, add);
  }

  // Seepage force has water at the edge that carries the structure; what the card says of its other side stands in its
  // place.
  void take_back_behind(const Group& group, int element) {
    const std::vector<int>& edge = group.element->edges().front();
    const int* const nodes = group.nodes_of(element);
    const auto behind = in_forces_.find(edge_key(nodes[edge[0]], nodes[edge[1]]));
    if (behind == in_forces_.end()) return;
    press_edge(behind->second, -1.0, nullptr);
    in_forces_.erase(behind);
  }

  Eigen::VectorBlock<Eigen::VectorXd, 2> at(int node) { return force_.segment<2>(DofMap::displacement(node)); }

  const Model& model_;
  const Activity& activity_;
  const PorePressure& water_;
  Eigen::VectorXd force_;
  Eigen::Matrix2Xd x_;
  Mapped mapped_;
  std::map<std::pair<int, int>, std::map<int, int>> joints_;
  std::map<std::pair<int, int>, FreeEdge> in_forces_;  // that carry structures, of solids with seepage force
};

}  // namespace

Eigen::VectorXd water_force(const Model& model, const Activity& activity, const PorePressure& water) {
  return WaterForce(model, activity, water).sum();
}

}  // namespace sage
