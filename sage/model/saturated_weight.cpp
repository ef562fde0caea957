#include "sage/model/saturated_weight.hpp"

#include <limits>

#include "sage/model/locate.hpp"
#include "sage/model/water_parts.hpp"

namespace sage {

namespace {

using Polygon = std::vector<Vector2>;

// The part of a convex polygon where n . x <= limit.
Polygon cut(const Polygon& whole, const Vector2& n, double limit) {
  Polygon part;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Vector2 &a = whole[i], &b = whole[(i + 1) % whole.size()];
    const double over_a = n.dot(a) - limit, over_b = n.dot(b) - limit;
    if (over_a <= 0.0) part.push_back(a);
    if (over_a * over_b < 0.0) part.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return part;
}

// The parts below a line of water, one for each of its segments; beyond its ends it is level.
std::vector<Polygon> parts_below(const Polygon& whole, const std::vector<Vector2>& line) {
  constexpr double kFar = std::numeric_limits<double>::max();
  std::vector<Polygon> parts;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const bool first = i == 0, last = i == line.size();
    const Vector2 &a = line[first ? 0 : i - 1], &b = line[last ? i - 1 : i];
    const double from = first ? -kFar : a.x(), to = last ? kFar : b.x();
    const double slope = first || last ? 0.0 : (b.y() - a.y()) / (b.x() - a.x());
    Polygon part = cut(whole, {-1.0, 0.0}, -from);
    part = cut(part, {1.0, 0.0}, to);
    part = cut(part, {-slope, 1.0}, a.y() - slope * a.x());
    if (part.size() > 2) parts.push_back(std::move(part));
  }
  return parts;
}

// Sums N times the measure over a triangle within an element with nodes at x.
void add_triangle(const Model& model, const Group& group, const Eigen::Matrix2Xd& x,
                  const std::array<Vector2, 3>& triangle, std::vector<double>& sum) {
  const Vector2 along = triangle[1] - triangle[0], across = triangle[2] - triangle[0];
  const double area2 = along.x() * across.y() - along.y() * across.x();
  Vector2 parent = Vector2::Zero();
  std::vector<double> N;
  for (const water::RulePlace& q : water::rule_for(true, group.element->traits().degree)) {
    const Vector2 place = triangle[0] + q.parent.x() * along + q.parent.y() * across;
    if (!find_parent(group, x, place, parent, N)) continue;
    const double w = q.weight * area2 * water::measure(model, place);
    for (std::size_t n = 0; n < N.size(); ++n) sum[n] += w * N[n];
  }
}

}  // namespace

double saturation_weight(const Material& material) {
  return material.saturated_unit_weight > 0.0 ? material.saturated_unit_weight - material.unit_weight : 0.0;
}

const WaterCard* saturating_line(const Model& model, int stage, std::size_t group) {
  if (!model.groups[group].solid() || saturation_weight(model.material_of(model.groups[group])) == 0.0)
    return nullptr;
  const WaterCard* card = water_card(model, stage, static_cast<int>(group));
  if (card != nullptr && card->kind == WaterKind::drawdown)  // the ground stays saturated
    card = line_before(model, *card, static_cast<int>(group));
  return card != nullptr && card->kind == WaterKind::line ? card : nullptr;
}

void add_saturation_weight(const Model& model, std::size_t group, const WaterCard& line, const Vector2& gravity,
                           const AddElementForce& add) {
  const Group& own = model.groups[group];
  const Vector2 b = gravity * saturation_weight(model.material_of(own));
  Eigen::Matrix2Xd x;
  std::vector<double> sum, f;
  for (int e = 0; e < own.elements(); ++e) {
    const Polygon corners = water::corners_of(model, own, e);
    const std::vector<Polygon> parts = parts_below(corners, line.line);
    if (parts.empty()) continue;
    element_coordinates(model.mesh, own, e, x);
    sum.assign(static_cast<std::size_t>(x.cols()), 0.0);
    for (const Polygon& part : parts)
      for (std::size_t i = 2; i < part.size(); ++i)
        add_triangle(model, own, x, {part[0], part[i - 1], part[i]}, sum);
    f.clear();
    for (const double weight : sum) f.insert(f.end(), {weight * b.x(), weight * b.y()});
    add(e, f);
  }
}

}  // namespace sage
