#include "sage/model/activity.hpp"

#include <algorithm>

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

Activity::Activity(const Model& model)
    : dof_map(model), group(model.groups.size(), 1), held(static_cast<std::size_t>(dof_map.dofs()), 0) {
  for (const Stage& stage : model.stages)
    for (int g : stage.births) group[g] = 0;
  apply(model.fixities, model.field_fixities, dof_map, held);
  for (int dof = dof_map.displacements(); dof < dof_map.dofs(); ++dof)
    if (model.unknowns[dof_map.at(dof).field].of_pores) pores.emplace_back(dof, held[dof]);
}

void Activity::enter(const Stage& stage) {
  for (int g : stage.births) group[g] = 1;
  for (int g : stage.deaths) group[g] = 0;
  for (const auto& [dof, supported] : pores) held[dof] = supported;
  apply(stage.fixities, stage.field_fixities, dof_map, held);
  for (const Exit& exit : stage.exits)
    if (exit.field >= 0) apply(FixityCode::released, dof_map.of(exit.node, exit.field), held);
  for (auto& [dof, supported] : pores) {
    char& now = held[dof];
    supported = now;
    if (stage.pores != PoreWater::flows) now = stage.pores == PoreWater::kept;
  }
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
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const int p = part[node];
    if (p < 0) continue;
    const auto pu = static_cast<std::size_t>(p);
    const Vector2 d = (Vector2(model.mesh.x.col(node)) - centre[pu]) / reach;
    const Eigen::Vector3d row_x(1.0, 0.0, -d.y()), row_y(0.0, 1.0, d.x());
    if (activity.holds(node, 0)) gram[pu] += row_x * row_x.transpose();
    if (activity.holds(node, 1)) gram[pu] += row_y * row_y.transpose();
    for (std::size_t field = 1; field < model.unknowns.size(); ++field) {
      const int dof = activity.dof_map.of(node, static_cast<int>(field));
      if (model.unknowns[field].turns && dof >= 0 && activity.held[dof]) gram[pu](2, 2) += 1.0;
    }
  }
  std::vector<LoosePart> loose;
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
