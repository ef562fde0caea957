#include "sage/model/water.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "sage/model/water_parts.hpp"

namespace sage {

namespace {

// The last one of the deck among the cards that hold in the stage and are meant.
template <class Meant>
const WaterCard* last_card(const Model& model, int stage, const Meant& meant) {
  const WaterCard* found = nullptr;
  for (const WaterCard& card : model.water)
    if (card.stage <= stage && meant(card) && (found == nullptr || card.stage >= found->stage)) found = &card;
  return found;
}

bool is_about(const WaterCard& card, int group) {
  return card.group < 0 || card.group == group;
}

}  // namespace

const WaterCard* water_card(const Model& model, int stage, int group) {
  const WaterCard* const found =
      last_card(model, stage, [&](const WaterCard& card) { return card.pressure() && is_about(card, group); });
  return found != nullptr && found->kind != WaterKind::dry ? found : nullptr;
}

const WaterCard* line_before(const Model& model, const WaterCard& drawdown, int group) {
  const WaterCard* card = &drawdown;
  while (card != nullptr && card->kind == WaterKind::drawdown && card->stage > 0)
    card = water_card(model, card->stage - 1, group);
  return card != nullptr && card->kind == WaterKind::line ? card : nullptr;
}

bool is_undrained(const Model& model, int stage, int group) {
  const WaterCard* const found =
      last_card(model, stage, [&](const WaterCard& card) { return !card.pressure() && is_about(card, group); });
  return found != nullptr && found->kind == WaterKind::undrained;
}

const WaterCard* water_card(const Model& model, int stage, int group, WaterSide side) {
  const WaterCard* const found = last_card(model, stage, [&](const WaterCard& card) {
    const bool here = card.value == 0.0 || (card.value > 0.0) == (side == WaterSide::left);
    return card.pressure() && card.group == group && here;
  });
  return found != nullptr && found->kind == WaterKind::line ? found : nullptr;
}

double water_level(const WaterCard& card, double x) {
  const std::vector<Vector2>& line = card.line;
  if (x <= line.front().x()) return line.front().y();
  for (std::size_t i = 1; i < line.size(); ++i)
    if (x <= line[i].x()) {
      const double part = (x - line[i - 1].x()) / (line[i].x() - line[i - 1].x());
      return line[i - 1].y() + part * (line[i].y() - line[i - 1].y());
    }
  return line.back().y();
}

double free_level(const WaterCard& card, double x) {
  const bool level = card.kind == WaterKind::line || card.kind == WaterKind::drawdown;
  const bool free = level && card.action != WaterAction::none;
  return free ? water_level(card, x) : -std::numeric_limits<double>::infinity();
}

namespace water {

GaussRule::GaussRule(int n) {
  for (int i = 0; i < n; ++i) {
    double t = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double p0 = 1.0, p1 = t;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * t * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = next;
      }
      slope = n * (t * p1 - p0) / (t * t - 1.0);
      const double change = p1 / slope;
      t -= change;
      if (std::abs(change) < 1e-16) break;
    }
    x.push_back(t);
    w.push_back(2.0 / ((1.0 - t * t) * slope * slope));
  }
}

std::vector<RulePlace> rule_for(bool triangle, int degree) {
  const GaussRule line(degree + 2);
  std::vector<RulePlace> places;
  for (std::size_t i = 0; i < line.x.size(); ++i)
    for (std::size_t j = 0; j < line.x.size(); ++j) {
      if (!triangle) {
        places.push_back({{line.x[i], line.x[j]}, line.w[i] * line.w[j]});
        continue;
      }
      // The square folded onto the triangle.
      const double s = 0.5 * (1.0 + line.x[i]), t = 0.5 * (1.0 + line.x[j]);
      places.push_back({{s, (1.0 - s) * t}, 0.25 * line.w[i] * line.w[j] * (1.0 - s)});
    }
  return places;
}

std::vector<Vector2> corners_of(const Model& model, const Group& group, int element) {
  std::vector<Vector2> corners;
  for (const std::vector<int>& edge : group.element->edges())
    corners.push_back(model.mesh.x.col(group.nodes_of(element)[edge[0]]));
  return corners;
}

double measure(const Model& model, const Vector2& place) {
  return model.geometry == Geometry::axisymmetric ? 2.0 * std::numbers::pi * place.x() : 1.0;
}

SolidEdges edges_of_active(const Model& model, const std::vector<char>& groups) {
  return SolidEdges(model, [&](std::size_t g) { return groups[g] && model.groups[g].solid(); });
}

double slope_at(const WaterCard& card, double x) {
  const std::vector<Vector2>& line = card.line;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (x > line[i - 1].x() && x <= line[i].x())
      return (line[i].y() - line[i - 1].y()) / (line[i].x() - line[i - 1].x());
  return 0.0;
}

double share_of_depth(const WaterCard& card, double x) {
  if (card.value != 1.0) return 1.0;
  const double slope = slope_at(card, x);
  return 1.0 / (1.0 + slope * slope);
}

}  // namespace water

}  // namespace sage
