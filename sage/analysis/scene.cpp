#include "sage/analysis/scene.hpp"

#include <algorithm>

#include "sage/analysis/congruent.hpp"
#include "sage/messages/error.hpp"
#include "sage/model/dof_map.hpp"

namespace sage {

namespace {

bool has_law(const LawRef& law, int size) {
  return size_of_law(law) == size && std::visit([](const auto* held) { return held != nullptr; }, law);
}

bool is_symmetric(const LawRef& law) {
  return std::visit([](const auto* held) { return held->traits().symmetric; }, law);
}

// Loads that follow an edge have a stiffness of their own, which is symmetric on closed edges alone.
bool has_edge_loads(const Model& model, const Group& group) {
  const auto g = static_cast<int>(&group - model.groups.data());
  return std::ranges::any_of(model.stages, [g](const Stage& stage) {
    return std::ranges::find(stage.pressures, g, &EdgeLoad::group) != stage.pressures.end();
  });
}

}  // namespace

Scene analyse_scene(const Model& model) {
  Scene scene;
  const DofMap map(model);
  scene.dofs = map.dofs();
  std::vector<char> nonlinear(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups) {
    const LawRef law = model.material_of(group).law_ref();
    const ElementTraits& traits = group.element->traits();
    const LawRef second = model.second_law_of(group);
    if (traits.second_law_size > 0 && !has_law(second, traits.second_law_size))
      throw AnalysisError("S225", "group " + std::to_string(group.number) +
                                      " needs a second material, whose law has " +
                                      std::to_string(traits.second_law_size) + " component(s)");
    if (traits.second_law_size > 0 && (wants_context(second) || !history_of(second).empty()))
      throw AnalysisError("S225",
                          "group " + std::to_string(group.number) +
                              ": the law of the second material must not depend on place, time or history");
    const bool linear = traits.linear && traits.history.empty() && has_constant_stiffness(law) &&
                        (traits.second_law_size == 0 || has_constant_stiffness(second));
    const bool symmetric = traits.symmetric && !(traits.large_strain && has_edge_loads(model, group)) &&
                           is_symmetric(law) && (traits.second_law_size == 0 || is_symmetric(second));
    scene.group_linear.push_back(linear ? 1 : 0);
    scene.linear = scene.linear && linear;
    scene.symmetric = scene.symmetric && symmetric;
    scene.elements += group.elements();
    scene.points += group.elements() * traits.points;
    std::vector<int>& shapes = scene.shapes.emplace_back();
    if (linear) {
      shapes = shapes_of(model.mesh, group, model.geometry);
      scene.linear_elements += group.elements();
      scene.linear_shapes += shapes.empty() ? 0 : *std::max_element(shapes.begin(), shapes.end()) + 1;
    } else {
      for (int node : group.nodes) nonlinear[node] = 1;
    }
  }
  for (int dof = 0; dof < map.dofs(); ++dof) scene.nonlinear_dofs += nonlinear[map.at(dof).node];
  return scene;
}

std::string describe(const Scene& scene) {
  std::string text = scene.linear ? "linear" : "nonlinear";
  text += scene.symmetric ? ", symmetric" : ", unsymmetric";
  if (scene.linear_elements > 0 && !scene.linear)
    text += "; " + std::to_string(scene.linear_elements) + " of " + std::to_string(scene.elements) +
            " elements linear, " + std::to_string(scene.nonlinear_dofs) + " of " + std::to_string(scene.dofs) +
            " dofs belong to nonlinear elements";
  if (scene.linear_elements > 0 && scene.linear_shapes < scene.linear_elements)
    text += "; " + std::to_string(scene.linear_shapes) + (scene.linear_shapes == 1 ? " shape" : " shapes") +
            " of linear elements";
  return text;
}

}  // namespace sage
