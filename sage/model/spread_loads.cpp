#include "sage/model/spread_loads.hpp"

#include <algorithm>

#include "sage/core/spaced_members.hpp"
#include "sage/model/water.hpp"

namespace sage {

namespace {

class SpreadLoads {
 public:
  SpreadLoads(const Model& model, std::size_t group)
      : model_(model), group_(model.groups[group]), index_(static_cast<int>(group)) {}

  std::vector<double> at(int last) {
    Activity activity(model_);
    std::vector<const EdgeLoad*> edges;
    Vector2 gravity = Vector2::Zero();
    const auto active = [&] { return activity.group[index_] != 0; };
    for (int s = 0; s <= last; ++s) {
      const Stage& stage = model_.stages[s];
      activity.enter(stage);
      gravity += stage.gravity;
      for (const EdgeLoad& load : stage.pressures)
        if (active() && load.group == index_) edges.push_back(&load);
    }
    if (last < 0 || !active()) return {};
    for (const EdgeLoad* load : edges)
      add(load->element, [&](std::span<double> f) {
        group_.element->edge_load(x_, load->edge, load->normal, load->shear, f);
      });
    const Vector2 weight = gravity * weight_density(model_, group_);
    for (int e = 0; e < group_.elements() && !weight.isZero(0.0); ++e)
      add(e, [&](std::span<double> f) { group_.element->body_load(x_, weight, f); });
    water_on_structures(model_, last, activity.group, index_,
                        [&](int, int element, std::span<const double> load) {
                          add(element, [&](std::span<double> f) { std::ranges::copy(load, f.begin()); });
                        });
    return std::move(loads_);
  }

 private:
  template <class Load>
  void add(int element, const Load& load) {
    const auto dofs = static_cast<std::size_t>(group_.element->traits().dofs);
    if (loads_.empty()) loads_.assign(static_cast<std::size_t>(group_.elements()) * dofs, 0.0);
    element_coordinates(model_.mesh, group_, element, x_);
    one_.assign(dofs, 0.0);
    load(one_);
    for (std::size_t i = 0; i < dofs; ++i) loads_[static_cast<std::size_t>(element) * dofs + i] += one_[i];
  }

  const Model& model_;
  const Group& group_;
  int index_;
  std::vector<double> loads_, one_;
  Eigen::Matrix2Xd x_;
};

}  // namespace

double spacing_of(const LawRef& law) {
  const auto* const* one = std::get_if<const Law<1>*>(&law);
  const auto* const spaced = one != nullptr ? dynamic_cast<const SpacedMembers*>(*one) : nullptr;
  return spaced != nullptr ? spaced->spacing() : 1.0;
}

double weight_density(const Model& model, const Group& group) {
  const Material& material = model.material_of(group);
  if (!group.structure()) return material.unit_weight;
  return material.unit_weight * material.parameter(ParameterRole::thickness).value_or(1.0) /
         spacing_of(material.law_ref());
}

std::vector<double> spread_loads(const Model& model, int stage, std::size_t group) {
  return SpreadLoads(model, group).at(stage);
}

}  // namespace sage
