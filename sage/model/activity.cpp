#include "sage/model/activity.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sage/math/dense.hpp"
#include "sage/model/joined.hpp"

namespace sage {

namespace {

// dof: -1 where a node that was made along a held edge lacks the field.
void apply(FixityCode code, int dof, std::vector<char>& held) {
  if (dof < 0) return;
  if (code == FixityCode::fixed) held[dof] = 1;
  if (code == FixityCode::released) held[dof] = 0;
}

void apply(const std::vector<Fixity>& fixities, const std::vector<FieldFixity>& others, const DofMap& dof_map,
           std::vector<char>& held) {
  for (const Fixity& f : fixities)
    for (std::size_t c = 0; c < 2; ++c)
      apply(f.code[c], DofMap::displacement(f.node, static_cast<int>(c)), held);
  for (const FieldFixity& f : others) apply(f.code, dof_map.of(f.node, f.field), held);
}

std::string mode_name(const Eigen::Vector3d& mode) {
  Eigen::Index largest = 0;
  mode.cwiseAbs().maxCoeff(&largest);
  if (largest == 0) return "a rigid translation in x";
  if (largest == 1) return "a rigid translation in y";
  return "a rigid rotation";
}

}  // namespace

std::vector<Vector2> TurnedNode::held_directions() const {
  std::vector<Vector2> list;
  if (by_xy[0]) list.emplace_back(1.0, 0.0);
  if (by_xy[1]) list.emplace_back(0.0, 1.0);
  for (const Axis& axis : axes)
    if (axis.held) list.emplace_back(axis.direction[0], axis.direction[1]);
  return list;
}

Activity::Activity(const Model& model)
    : dof_map(model), group(model.groups.size(), 1), held(static_cast<std::size_t>(dof_map.dofs()), 0) {
  for (const Stage& stage : model.stages)
    for (int g : stage.births) group[g] = 0;
  apply(model.fixities, model.field_fixities, dof_map, held);
  for (int dof = dof_map.displacements(); dof < dof_map.dofs(); ++dof)
    if (model.unknowns[dof_map.at(dof).field].of_pores) pores.emplace_back(dof, held[dof]);
  collect_turned(model);
  collect_tied(model);
  apply_turned(model.turned_fixities);
  settle_turned();
  settle_tied();
}

void Activity::enter(const Stage& stage) {
  for (int g : stage.births) group[g] = 1;
  for (int g : stage.deaths) group[g] = 0;
  for (const auto& [dof, supported] : pores) held[dof] = supported;
  for (const std::vector<TiedDof>& set : tied)
    for (const TiedDof& one : set) held[one.dof] = one.held ? 1 : 0;
  for (const TurnedNode& node : turned)
    for (int c = 0; c < 2; ++c)
      held[DofMap::displacement(node.node, c)] = node.by_xy[static_cast<std::size_t>(c)];
  apply(stage.fixities, stage.field_fixities, dof_map, held);
  for (const Exit& exit : stage.exits)
    if (exit.field >= 0) apply(FixityCode::released, dof_map.of(exit.node, exit.field), held);
  for (auto& [dof, supported] : pores) {
    char& now = held[dof];
    supported = now;
    if (stage.pores != PoreWater::flows) now = stage.pores == PoreWater::kept;
  }
  apply_turned(stage.turned_fixities);
  settle_turned();
  settle_tied();
}

void Activity::collect_turned(const Model& model) {
  const auto add = [&](const std::vector<TurnedFixity>& list) {
    for (const TurnedFixity& f : list) {
      auto at = std::ranges::lower_bound(turned, f.node, {}, &TurnedNode::node);
      if (at == turned.end() || at->node != f.node) {
        at = turned.insert(at, TurnedNode());
        at->node = f.node;
      }
      for (std::size_t c = 0; c < 2; ++c) {
        const auto same = [&](const TurnedNode::Axis& axis) {
          return axis.angle == f.angle && axis.component == c;
        };
        if (f.code[c] == FixityCode::unchanged || std::ranges::any_of(at->axes, same)) continue;
        const Vector2 direction = turned_axis(f.angle, c);
        at->axes.push_back({f.angle, c, {direction.x(), direction.y()}});
      }
    }
  };
  add(model.turned_fixities);
  for (const Stage& stage : model.stages) add(stage.turned_fixities);
}

void Activity::apply_turned(const std::vector<TurnedFixity>& fixities) {
  for (const TurnedFixity& f : fixities) {
    const auto at = std::ranges::lower_bound(turned, f.node, {}, &TurnedNode::node);
    for (TurnedNode::Axis& axis : at->axes) {
      if (axis.angle != f.angle || f.code[axis.component] == FixityCode::unchanged) continue;
      axis.held = f.code[axis.component] == FixityCode::fixed;
    }
  }
}

// One direction that is held leaves a line to slide along; two that differ hold the node.
void Activity::settle_turned() {
  for (TurnedNode& node : turned) {
    for (std::size_t c = 0; c < 2; ++c)
      node.by_xy[c] = held[DofMap::displacement(node.node, static_cast<int>(c))];
    node.slides = false;
    const std::vector<Vector2> directions = node.held_directions();
    if (std::ranges::none_of(node.axes, &TurnedNode::Axis::held)) continue;
    node.slides = directions.size() == 1;
    if (node.slides) node.slide = {directions[0].y(), -directions[0].x()};
    for (int c = 0; c < 2; ++c) held[DofMap::displacement(node.node, c)] = node.slides ? 0 : 1;
  }
}

void Activity::collect_tied(const Model& model) {
  if (model.ties.empty()) return;
  Joined joined(static_cast<std::size_t>(dof_map.displacements()));
  for (const Tie& tie : model.ties)
    for (int c = 0; c < 2; ++c)
      if (tie.component[static_cast<std::size_t>(c)])
        joined.join(DofMap::displacement(tie.node, c), DofMap::displacement(tie.to, c));
  std::map<int, std::vector<TiedDof>> sets;
  for (int dof = 0; dof < dof_map.displacements(); ++dof)
    sets[joined.set_of(dof)].push_back({dof, {}, false, false});
  in_tie_.assign(held.size(), 0);
  std::map<int, std::pair<std::size_t, std::size_t>> place;  // of a dof: its set, and where in it
  for (auto& [first, dofs] : sets) {
    if (dofs.size() < 2) continue;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      in_tie_[dofs[i].dof] = 1;
      place[dofs[i].dof] = {tied.size(), i};
    }
    tied.push_back(std::move(dofs));
  }
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    for (const int node : model.groups[g].nodes)
      for (int c = 0; c < 2; ++c)
        if (const auto at = place.find(DofMap::displacement(node, c)); at != place.end())
          tied[at->second.first][at->second.second].groups.push_back(static_cast<int>(g));
}

// A support of one of them holds all whose nodes are in active groups.
void Activity::settle_tied() {
  const auto active = [&](const TiedDof& one) {
    return std::ranges::any_of(one.groups, [&](int g) { return group[g] != 0; });
  };
  for (std::vector<TiedDof>& set : tied) {
    for (TiedDof& one : set) {
      one.held = held[one.dof] != 0;
      one.supported = one.held && active(one);
    }
    const bool any = std::ranges::any_of(set, &TiedDof::supported);
    for (const TiedDof& one : set)
      if (active(one)) held[one.dof] = any ? 1 : 0;
  }
}

const TurnedNode* Activity::turned_at(int node) const {
  const auto at = std::ranges::lower_bound(turned, node, {}, &TurnedNode::node);
  return at == turned.end() || at->node != node ? nullptr : &*at;
}

bool Activity::has_reaction(int dof) const {
  if (held[dof] != 0) return true;
  if (turned.empty() || dof >= dof_map.displacements()) return false;
  const TurnedNode* const node = turned_at(dof / 2);
  return node != nullptr && node->slides;
}

Vector2 held_motion(const Stage& stage, const TurnedNode& node, const Vector2& by_xy, double* contradiction) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  Vector2 moved = Vector2::Zero();
  std::vector<std::pair<Vector2, double>> held;
  const auto add = [&](const Vector2& direction, double value) {
    held.emplace_back(direction, value);
    sum += direction * direction.transpose();
    moved += value * direction;
  };
  if (node.by_xy[0]) add({1.0, 0.0}, by_xy.x());
  if (node.by_xy[1]) add({0.0, 1.0}, by_xy.y());
  for (const TurnedNode::Axis& axis : node.axes) {
    if (!axis.held) continue;
    double value = 0.0;
    for (const TurnedFixity& f : stage.turned_fixities)
      if (f.node == node.node && f.angle == axis.angle && f.code[axis.component] == FixityCode::fixed)
        value = f.value[axis.component];
    add({axis.direction[0], axis.direction[1]}, value);
  }
  if (!node.slides) {
    const double size = sum(0, 0) * sum(1, 1) - sum(0, 1) * sum(1, 0);
    moved =
        Vector2(sum(1, 1) * moved.x() - sum(0, 1) * moved.y(), sum(0, 0) * moved.y() - sum(1, 0) * moved.x()) /
        size;
  }
  if (contradiction != nullptr)
    for (const auto& [direction, value] : held)
      *contradiction = std::max(*contradiction, std::abs(direction.dot(moved) - value));
  return moved;
}

std::vector<char> active_nodes(const Model& model, const Activity& activity) {
  std::vector<char> active(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (activity.group[g])
      for (int node : model.groups[g].nodes) active[node] = 1;
  return active;
}

std::vector<int> connected_parts(const Model& model, const Activity& activity) {
  return connected_parts(
      model, [&](std::size_t g, int) { return activity.group[g] != 0 && model.groups[g].entry->moves(); });
}

std::vector<int> connected_parts(const Model& model, const Carries& carries) {
  const auto count = static_cast<std::size_t>(model.mesh.nodes());
  Joined nodes_joined(count);
  std::vector<char> used(count, 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    for (int e = 0; e < group.elements(); ++e) {
      if (!carries(g, e)) continue;
      const int* nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        used[nodes[i]] = 1;
        nodes_joined.join(nodes[i], nodes[0]);
      }
    }
  }
  std::vector<int> part(count, -1), number(count, -1);
  int parts = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!used[i]) continue;
    int& n = number[nodes_joined.set_of(static_cast<int>(i))];
    if (n < 0) n = parts++;
    part[i] = n;
  }
  return part;
}

namespace {

// Ties of one part hold the difference of two displacements.  Parts that are tied to others count as held by these.
template <class Row>
void add_ties(const Model& model, const std::vector<int>& part, const Row& row_of,
              std::vector<Eigen::Matrix3d>& gram) {
  for (const Tie& tie : model.ties) {
    const int one = part[tie.node], other = part[tie.to];
    if (one < 0 || other < 0) continue;
    for (int c = 0; c < 2; ++c) {
      if (!tie.component[static_cast<std::size_t>(c)]) continue;
      const Eigen::Vector3d row = row_of(tie.node, c) - row_of(tie.to, c);
      if (one == other) gram[one] += row * row.transpose();
    }
    if (one != other) gram[one] += Eigen::Matrix3d::Identity(), gram[other] += Eigen::Matrix3d::Identity();
  }
}

}  // namespace

std::vector<LoosePart> loose_parts(const Model& model, const Activity& activity, const std::vector<int>& part) {
  const int parts = part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
  std::vector<Eigen::Matrix3d> gram(static_cast<std::size_t>(parts), Eigen::Matrix3d::Zero());
  const double reach =
      std::max(1e-300, (model.mesh.x.rowwise().maxCoeff() - model.mesh.x.rowwise().minCoeff()).maxCoeff());
  std::vector<Vector2> centre(static_cast<std::size_t>(parts), Vector2::Zero());
  std::vector<int> count(static_cast<std::size_t>(parts), 0);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const int p = part[node];
    if (p < 0) continue;
    centre[p] += model.mesh.x.col(node);
    ++count[p];
  }
  for (std::size_t p = 0; p < centre.size(); ++p) centre[p] /= std::max(1, count[p]);
  // What the rigid modes of its part do to a displacement of the node.
  const auto row_of = [&](int node, int component) {
    const Vector2 d = (Vector2(model.mesh.x.col(node)) - centre[part[node]]) / reach;
    return component == 0 ? Eigen::Vector3d(1.0, 0.0, -d.y()) : Eigen::Vector3d(0.0, 1.0, d.x());
  };
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const int p = part[node];
    if (p < 0) continue;
    const auto pu = static_cast<std::size_t>(p);
    const Eigen::Vector3d row_x = row_of(node, 0), row_y = row_of(node, 1);
    if (activity.holds(node, 0)) gram[pu] += row_x * row_x.transpose();
    if (activity.holds(node, 1)) gram[pu] += row_y * row_y.transpose();
    if (const TurnedNode* const turned = activity.turned_at(node); turned != nullptr && turned->slides) {
      const Eigen::Vector3d row = turned->slide[1] * row_x - turned->slide[0] * row_y;
      gram[pu] += row * row.transpose();
    }
    for (std::size_t field = 1; field < model.unknowns.size(); ++field) {
      const int dof = activity.dof_map.of(node, static_cast<int>(field));
      if (model.unknowns[field].turns && dof >= 0 && activity.held[dof]) gram[pu](2, 2) += 1.0;
    }
  }
  std::vector<LoosePart> loose;
  add_ties(model, part, row_of, gram);
  for (std::size_t p = 0; p < gram.size(); ++p) {
    std::string motion;
    if (model.geometry == Geometry::axisymmetric) {
      if (gram[p](1, 1) == 0.0) motion = "a rigid translation along the axis";
    } else {
      const dense_matrix::EigensystemOf<3> modes = dense_matrix::symmetric_eigensystem_3(gram[p]);
      if (modes.values[0] < 1e-10) motion = mode_name(modes.vectors.col(0));
    }
    if (!motion.empty()) loose.push_back({static_cast<int>(p), motion});
  }
  return loose;
}

std::string part_name(const Model& model, const std::vector<int>& part, int p) {
  constexpr int kShown = 8;
  std::string first, list;
  int count = 0;
  for (std::size_t node = 0; node < part.size(); ++node) {
    if (part[node] != p) continue;
    const std::string number = std::to_string(model.mesh.number[node]);
    if (++count == 1) first = number;
    if (count <= kShown) list += (count > 1 ? ", " : "") + number;
  }
  return "part that contains node " + first + " (" + std::to_string(count) + " nodes: " + list +
         (count > kShown ? ", ..." : "") + ")";
}

}  // namespace sage
