#include "sage/model/locking.hpp"

#include <algorithm>

namespace sage {

double poissons_ratio(const Material& material) {
  return material.parameter(ParameterRole::poissons_ratio).value_or(0.0);
}

bool nearly_incompressible(const Model& model, const Group& group) {
  return poissons_ratio(model.material_of(group)) > 0.45 || group.excess >= 0;
}

bool resists_dilation(const ElementEntry& entry, const ElementTraits& traits) {
  return entry.solid() && entry.square() && entry.only_corners() && traits.own_doubles == 0;
}

const Formulation& default_formulation(const ElementEntry& entry, Geometry geometry, bool dilates) {
  const auto follows = [&](const Formulation& f) {
    return !resists_dilation(entry, entry.make(geometry, f.code)->traits());
  };
  const Formulation& own = entry.formulations.front();
  if (!dilates || !entry.solid() || follows(own)) return own;
  const auto found = std::ranges::find_if(entry.formulations, follows);
  return found == entry.formulations.end() ? own : *found;
}

Dilation dilation_of(const Material& material) {
  if (material.entry == nullptr || !material.entry->for_solids()) return {};
  const auto& rows = material.entry->parameters;
  const std::size_t count = std::min(rows.size(), material.parameters.size());
  // A code for flow: beside an angle 1 means none, without one it is the share of the associated flow.
  const int at = material.entry->find("flow");
  const double flow = at >= 0 && static_cast<std::size_t>(at) < count ? material.parameters[at] : 0.0;
  if (material.entry->find(ParameterRole::dilation_angle) < 0) return {0.0, flow};
  if (flow != 0.0) return {};
  double angle = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    if (rows[i].role == ParameterRole::dilation_angle) angle = std::max(angle, material.parameters[i]);
  return {angle, 0.0};
}

}  // namespace sage
