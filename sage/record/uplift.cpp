#include "sage/record/uplift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "sage/model/locate.hpp"
#include "sage/model/water.hpp"

namespace sage {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Gauss points of (0, 1): exact for the pressures of quadratic elements times a radius.
constexpr std::array<std::pair<double, double>, 3> kRule{
    {{0.11270166537925831, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.88729833462074169, 5.0 / 18.0}}};

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
        locator_(model) {
    for (int s = 0; s <= stage; ++s) gravity_ -= model.stages[s].gravity.y();
  }

  Column at(const Vector2& place) const {
    Column column;
    double free_level = -std::numeric_limits<double>::infinity();
    for (const Location& here : locator_.at(place)) {
      if (!active_[here.group]) continue;
      const WaterCard* const card = water_.card(here.group);
      if (card == nullptr) continue;
      column.water = std::max(column.water, water_.at(here.group, here.element, place, here.N));
      if (card->kind == WaterKind::line && card->action != WaterAction::none)
        free_level = std::max(free_level, water_level(*card, place.x()));
    }
    const Overburden::Above soil = above_.above(place);
    const double free_water = std::max(0.0, free_level - soil.top), gamma_w = model_.units.water_unit_weight;
    column.weight = gravity_ * soil.stress + gamma_w * free_water;
    column.at_rest = gamma_w * (soil.top + free_water - place.y());
    return column;
  }

 private:
  const Model& model_;
  const std::vector<char>& active_;
  PorePressure water_;
  Overburden above_;
  Locator locator_;
  double gravity_ = 0.0;
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
    for (const auto& [part, share] : kRule) {
      const Vector2 place = line[i - 1] + part * along;
      const Column here = columns.at(place);
      const double ring = model.geometry == Geometry::axisymmetric ? 2.0 * std::numbers::pi * place.x() : 1.0;
      const double w = share * along.x() * ring;
      sum.weight += w * here.weight;
      sum.water += w * here.water;
      sum.at_rest += w * here.at_rest;
    }
  }
  const double excess = sum.water - sum.at_rest;
  return {sum.weight, sum.water, sum.water > 0.0 ? sum.weight / sum.water : kNone,
          excess > 1e-9 * sum.water ? (sum.weight - sum.at_rest) / excess : kNone};
}

}  // namespace sage
