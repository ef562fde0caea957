#include "sage/record/uplift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/math/quadrature.hpp"
#include "sage/model/locate.hpp"
#include "sage/model/water_parts.hpp"
#include "sage/model/weight_above.hpp"

namespace sage {

namespace {

constexpr double kNoFactor = std::numeric_limits<double>::quiet_NaN();

// What stands above and presses below a place, as stresses.
struct Column {
  double weight = 0.0, water = 0.0, at_rest = 0.0;
};

class Columns {
 public:
  Columns(const Model& model, int stage, const Activity& activity, const Eigen::VectorXd& unknowns)
      : model_(model),
        active_(activity.group),
        water_(model, stage, activity.group, activity.dof_map, &unknowns),
        above_(model, activity.group, stage),
        locator_(model) {}

  Column at(const Vector2& place) const {
    Column column;
    double level = -std::numeric_limits<double>::infinity();  // of free water
    for (const Location& here : locator_.at(place)) {
      if (!active_[here.group]) continue;
      const WaterCard* const card = water_.card(here.group);
      if (card == nullptr) continue;
      column.water = std::max(column.water, water_.at(here.group, here.element, place, here.N));
      level = std::max(level, free_level(*card, place.x()));
    }
    const WeightAbove::Above above = above_.at(place, level);
    column.weight = above.stress;
    column.at_rest = model_.units.water_unit_weight * (above.level - place.y());
    return column;
  }

 private:
  const Model& model_;
  const std::vector<char>& active_;
  PorePressure water_;
  WeightAbove above_;
  Locator locator_;
};

}  // namespace

Uplift uplift_on(const Model& model, int stage, const std::vector<int>& nodes, const Activity& activity,
                 const Eigen::VectorXd& unknowns) {
  const Columns columns(model, stage, activity, unknowns);
  std::vector<Vector2> line;
  for (const int node : nodes) line.push_back(model.mesh.x.col(node));
  std::ranges::sort(line, {}, [](const Vector2& x) { return x.x(); });
  Column sum;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2 along = line[i] - line[i - 1];
    // Exact for the pressures of quadratic elements times a radius.
    for (const LinePoint& point : GaussLine<3>::table) {
      const Vector2 place = line[i - 1] + 0.5 * (1.0 + point.xi) * along;
      const Column here = columns.at(place);
      const double w = 0.5 * point.w * along.x() * water::measure(model, place);
      sum.weight += w * here.weight;
      sum.water += w * here.water;
      sum.at_rest += w * here.at_rest;
    }
  }
  const double excess = sum.water - sum.at_rest;
  return {sum.weight, sum.water, sum.water > 0.0 ? sum.weight / sum.water : kNoFactor,
          excess > 1e-9 * sum.water ? (sum.weight - sum.at_rest) / excess : kNoFactor};
}

}  // namespace sage
