// Refinement and grading that BuildOptions ask for, and what they mean for the rest of the model.
#include <algorithm>

#include "sage/core/contact.hpp"
#include "sage/mesh/subdivide.hpp"
#include "sage/model/activity.hpp"

namespace sage::mesh {

namespace {

std::vector<char> used_nodes(const Model& model) {
  std::vector<char> used(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    for (int node : group.nodes)
      if (node >= 0) used[node] = 1;
  return used;
}

// Middle nodes that cards give, with the ends of their edges.
std::map<int, EdgeKey> given_middles(const Model& model) {
  std::map<int, EdgeKey> middles;
  for (const Group& group : model.groups)
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int* nodes = group.nodes_of(e);
        const int middle = middle_of(edge) < 0 ? -1 : nodes[middle_of(edge)];
        if (middle >= 0) middles.emplace(middle, edge_key(nodes[edge[0]], nodes[edge[1]]));
      }
  return middles;
}

// Supports of middle nodes that grading cut off: new nodes beside them have them only where the ends of the
// edge are held too.
void refuse_lost_supports(Work& b, const std::map<int, EdgeKey>& middles, const std::vector<char>& used) {
  if (middles.empty()) return;
  const auto check = [&](const Activity& activity, const std::vector<Fixity>& cards) {
    for (const Fixity& f : cards) {
      const auto it = middles.find(f.node);
      if (it == middles.end() || used[f.node]) continue;
      for (std::size_t c = 0; c < 2; ++c) {
        const auto is_held = [&](int node) { return activity.holds(node, static_cast<int>(c)); };
        if (f.code[c] != FixityCode::fixed || (is_held(it->second.first) && is_held(it->second.second)))
          continue;
        b.error("S404", {b.deck.file, f.line, 0, 0},
                "node " + std::to_string(b.model.mesh.number[f.node]) + " is held along " +
                    (c == 0 ? "x" : "y") +
                    " but is no node of the graded mesh, and the ends of its edge are not both held; --refine "
                    "keeps "
                    "it");
      }
    }
  };
  Activity activity(b.model);
  check(activity, b.model.fixities);
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    check(activity, stage.fixities);
  }
}

// Mid-side nodes that grading left without an element.
void drop_lost_nodes(Work& b, std::vector<char> lost) {
  Model& model = b.model;
  const std::vector<char> used = used_nodes(model);
  lost.resize(used.size(), 1);  // also those that one layer made and the next one cut off
  const auto is_lost = [&](int node) { return lost[node] && !used[node]; };
  const auto holds_lost = [&](const auto& fixity) { return is_lost(fixity.node); };
  const auto refuse_lost = [&](const auto& loads) {
    for (const auto& load : loads)
      if (is_lost(load.node))
        b.error("S404", {b.deck.file, load.line, 0, 0},
                "node " + std::to_string(model.mesh.number[load.node]) +
                    " is loaded but is no node of the graded mesh; load its edge by a pressure card");
  };
  std::erase_if(model.fixities, holds_lost);
  std::erase_if(model.turned_fixities, holds_lost);
  std::erase_if(model.ties, [&](const Tie& tie) { return is_lost(tie.node) || is_lost(tie.to); });
  std::erase_if(model.field_fixities, holds_lost);
  for (Stage& stage : model.stages) {
    std::erase_if(stage.fixities, holds_lost);
    std::erase_if(stage.turned_fixities, holds_lost);
    std::erase_if(stage.field_fixities, holds_lost);
    std::erase_if(stage.exits, holds_lost);
    refuse_lost(stage.loads);
    refuse_lost(stage.field_loads);
    for (const int node : {stage.control.node, stage.control.other})
      if (node >= 0 && is_lost(node))
        b.error(
            "S404", stage.where,
            "node " + std::to_string(model.mesh.number[node]) +
                " controls the load but is no node of the graded mesh; control it by a corner of an element");
  }
  for (Report& report : model.reports) {
    const auto of_deck = std::count_if(report.nodes.begin(), report.nodes.end(),
                                       [&](int node) { return node < model.mesh.deck_nodes && is_lost(node); });
    if (of_deck > 0)
      b.note("S405", report.where,
             std::to_string(of_deck) +
                 " node(s) of this report are no nodes of the graded mesh: they don't count in its mean "
                 "displacement");
    std::erase_if(report.nodes, is_lost);
  }
}

void warn_point_loads(Work& b) {
  for (const Stage& stage : b.model.stages)
    if (!stage.loads.empty() || !stage.field_loads.empty()) {
      b.warning(
          "S406",
          {b.deck.file, stage.loads.empty() ? stage.field_loads.front().line : stage.loads.front().line, 0, 0},
          "loads on nodes stay point loads in a refined mesh: the displacement under them does not converge");
      return;
    }
}

std::vector<int> nodes_of(Work& b, const Grading& grading) {
  if (grading.node == 0) {
    const std::vector<int> found = singular_corners(b.model);
    if (found.empty()) b.note("S403", b.at_line(0), "no singular corner found: the mesh is not graded");
    return found;
  }
  if (const int* node = b.node_index.find(grading.node)) return {*node};
  b.error("S403", b.deck.one("control").where(),
          "the mesh can't be graded towards node " + std::to_string(grading.node) +
              ": the deck has none of that number");
  return {};
}

// Elements that the checks behind refuse by their shape are left as the deck has them: their parts would be no
// better, and each corner of a mesh that folds looks like a singular one to grade towards.
bool has_unusable_shapes(const Model& model) {
  Eigen::Matrix2Xd x;
  std::vector<double> geometry;
  for (const Group& group : model.groups) {
    geometry.resize(group.element->traits().geometry_size());
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      if (std::any_of(nodes, nodes + group.node_count(), [](int node) { return node < 0; })) continue;
      element_coordinates(model.mesh, group, e, x);
      try {
        group.element->geometry(x, geometry);
      } catch (const ElementShapeError&) {
        return true;
      }
    }
  }
  return false;
}

// Layers fit elements that are about as long as wide.
bool square_corners(Work& b) {
  std::vector<int> corners;
  for (const Grading& grading : b.meshing.gradings) {
    if (const int* node = b.node_index.find(grading.node); node != nullptr && grading.node != 0)
      corners.push_back(*node);
    if (grading.node != 0) continue;
    const std::vector<int> found = singular_corners(b.model);
    corners.insert(corners.end(), found.begin(), found.end());
  }
  return square_at(b, corners);
}

// An edge that is halved needs two elements of contact with the same line.
bool refuse_contact(Work& b) {
  for (const Group& group : b.model.groups) {
    if (!is_contact(*group.entry)) continue;
    b.error(
        "S557", group.where,
        "group " + std::to_string(group.number) + " is of " + group.entry->name +
            ": elements of contact can't be refined, graded or coarsened; expected a deck with the finer mesh");
    return true;
  }
  return false;
}

}  // namespace

void refine_as_asked(Work& b) {
  const MeshOptions& options = b.meshing;
  const bool changes =
      options.coarsen || options.refine > 0 || !options.gradings.empty() || options.refine_graded > 0;
  if (changes && refuse_contact(b)) return;
  if (!b.model.ties.empty() && !options.gradings.empty()) {
    b.error("S369", b.at_line(b.model.ties.front().line),
            "--grade can't divide the elements of a model with ties; --refine can");
    return;
  }
  const bool coarser = options.coarsen && coarsen(b);
  if (!options.coarsen && options.refine <= 0 && options.gradings.empty() && options.refine_graded <= 0) return;
  if (has_unusable_shapes(b.model)) return;
  const std::vector<char> before = used_nodes(b.model);
  const std::map<int, EdgeKey> middles = given_middles(b.model);
  const bool cut = options.coarsen && square_corners(b);
  if (options.coarsen && !coarser && !cut)
    b.note("S407", b.at_line(0), "the mesh stays as it is: no coarser one of quadrilaterals means the same");
  if (options.refine <= 0 && options.gradings.empty() && options.refine_graded <= 0) return;
  warn_point_loads(b);
  refine(b, options.refine, "--refine");
  for (const Grading& grading : options.gradings)
    for (const int node : nodes_of(b, grading)) {
      grade(b, node, grading.layers, grading.ratio);
      b.warning(
          "S406", b.at_line(0),
          "mesh graded towards node " + std::to_string(b.model.mesh.number[node]) +
              ": where the corner is singular the stress at it does not converge, it grows with every layer");
    }
  refine(b, options.refine_graded, "--refine-graded");
  refuse_lost_supports(b, middles, used_nodes(b.model));
  drop_lost_nodes(b, before);
}

}  // namespace sage::mesh
