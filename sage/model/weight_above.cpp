#include "sage/model/weight_above.hpp"

#include <algorithm>
#include <cmath>

#include "sage/model/spread_loads.hpp"
#include "sage/model/water_parts.hpp"

namespace sage {

WeightAbove::WeightAbove(const Model& model, const std::vector<char>& groups, int stage)
    : soil_(model, groups, stage), water_unit_weight_(model.units.water_unit_weight), reach_(model.mesh.reach) {
  for (int s = 0; s <= stage; ++s) gravity_ -= model.stages[s].gravity.y();
  add_structures(model, groups, stage);
}

void WeightAbove::add_structures(const Model& model, const std::vector<char>& groups, int stage) {
  std::vector<std::vector<double>> loads(model.groups.size());
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (groups[g] && model.groups[g].structure()) loads[g] = spread_loads(model, stage, g);
  Eigen::Matrix2Xd x;
  for (const BesideStructure& one : structures_beside_water(model, stage, groups)) {
    const Group& group = model.groups[one.group];
    element_coordinates(model.mesh, group, one.element, x);
    const Vector2 along = x.col(1) - x.col(0);
    const bool ground = along.x() > 0.0 ? !one.right : !one.left, open = along.x() > 0.0 ? one.left : one.right;
    if (!ground || !open || !(std::abs(along.x()) > reach_)) continue;
    Line line{x.col(0), x.col(1), 0.0};
    const std::vector<double>& load = loads[one.group];
    const auto dofs = static_cast<std::size_t>(group.element->traits().dofs);
    const double width = std::abs(along.x()) * water::measure(model, 0.5 * (line.from + line.to));
    for (Eigen::Index i = 0; i < x.cols() && !load.empty(); ++i)
      line.stress -=
          load[static_cast<std::size_t>(one.element) * dofs + static_cast<std::size_t>(2 * i + 1)] / width;
    lines_.push_back(line);
  }
}

// Nothing where no structure lies on the ground, which ends at the level `top`.  Half-open in x: between two plates one of them
// counts.
std::optional<double> WeightAbove::of_structures(const Vector2& place, double top) const {
  std::optional<double> sum;
  for (const Line& line : lines_) {
    if (!(std::min(line.from.x(), line.to.x()) <= place.x() &&
          place.x() < std::max(line.from.x(), line.to.x())))
      continue;
    const double part = (place.x() - line.from.x()) / (line.to.x() - line.from.x());
    const double level = line.from.y() + part * (line.to.y() - line.from.y());
    if (std::abs(level - top) <= reach_ + 1e-6 * (line.to - line.from).norm())
      sum = sum.value_or(0.0) + line.stress;
  }
  return sum;
}

WeightAbove::Above WeightAbove::at(const Vector2& place, double free_level) const {
  const Overburden::Above soil = soil_.above(place);
  const double level = std::max(soil.top, free_level);
  const std::optional<double> carried = of_structures(place, soil.top);
  return {gravity_ * soil.stress + carried.value_or(water_unit_weight_ * (level - soil.top)), level};
}

}  // namespace sage
