#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/model/saturated_weight.hpp"
#include "sage/model/water_parts.hpp"

namespace sage {

using namespace water;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Overburden::Overburden(const Model& model, const std::vector<char>& groups, int stage) {
  double high = -std::numeric_limits<double>::infinity();
  low_ = -high;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.solid()) continue;
    for (int e = 0; e < group.elements(); ++e) {
      Cell cell;
      cell.unit_weight = model.material_of(group).unit_weight;
      cell.line = saturating_line(model, stage, g);
      cell.saturation = saturation_weight(model.material_of(group));
      cell.corners = corners_of(model, group, e);
      for (const Vector2& corner : cell.corners) {
        low_ = std::min(low_, corner.x());
        high = std::max(high, corner.x());
      }
      cells_.push_back(std::move(cell));
    }
  }
  if (cells_.empty()) return;
  const auto bins = static_cast<std::size_t>(2.0 * std::sqrt(static_cast<double>(cells_.size()))) + 1;
  bins_.resize(bins);
  width_ = std::max(high - low_, 1e-300) / static_cast<double>(bins);
  const auto bin = [&](double x) {
    return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, (x - low_) / width_)));
  };
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto [left, right] =
        std::minmax_element(cells_[c].corners.begin(), cells_[c].corners.end(),
                            [](const Vector2& a, const Vector2& b) { return a.x() < b.x(); });
    for (std::size_t b = bin(left->x()); b <= bin(right->x()); ++b) bins_[b].push_back(static_cast<int>(c));
  }
}

// Half-open in x: on a line between two columns only one of them counts.
Overburden::Above Overburden::above(const Vector2& place) const {
  Above sum{0.0, place.y()};
  if (bins_.empty() || place.x() < low_) return sum;
  const auto bin = std::min(bins_.size() - 1, static_cast<std::size_t>((place.x() - low_) / width_));
  for (const int c : bins_[bin]) {
    const Cell& cell = cells_[c];
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (std::size_t i = 0; i < cell.corners.size(); ++i) {
      const Vector2 &a = cell.corners[i], &b = cell.corners[(i + 1) % cell.corners.size()];
      if (!(std::min(a.x(), b.x()) <= place.x() && place.x() < std::max(a.x(), b.x()))) continue;
      const double y = a.y() + (place.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
      bottom = std::min(bottom, y);
      top = std::max(top, y);
    }
    if (!(top > place.y())) continue;
    bottom = std::max(bottom, place.y());
    sum.stress += cell.unit_weight * (top - bottom);
    if (cell.line != nullptr)
      sum.stress +=
          cell.saturation * std::clamp(water_level(*cell.line, place.x()) - bottom, 0.0, top - bottom);
    sum.top = std::max(sum.top, top);
  }
  return sum;
}

PorePressure::PorePressure(const Model& model, int stage, const std::vector<char>& groups, const DofMap& map,
                           const Eigen::VectorXd* unknowns)
    : model_(&model),
      stage_(stage),
      groups_(groups),
      cards_(model.groups.size(), nullptr),
      falls_(model.groups.size()),
      nodes_(model.groups.size()) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (groups[g] && model.groups[g].structure())
      for (const WaterSide side : {WaterSide::left, WaterSide::right})
        beside_ = beside_ || water_card(model, stage, static_cast<int>(g), side) != nullptr;
    if (!groups[g] || !model.groups[g].solid()) continue;
    const WaterCard* const card = water_card(model, stage, static_cast<int>(g));
    if (card == nullptr || (card->kind == WaterKind::heads && unknowns == nullptr)) continue;
    if (card->kind == WaterKind::drawdown) {
      falls_[g] = fall_of(*card, static_cast<int>(g));
      if (falls_[g].before == nullptr) continue;  // the deck has an error
    }
    cards_[g] = card;
    if (card->kind == WaterKind::nodes) take_nodes(*card, g);
    if (card->kind == WaterKind::heads) take_heads(g, map, unknowns);
    if (card->kind == WaterKind::ratio && overburden_ == nullptr)
      overburden_ = std::make_shared<const Overburden>(model, groups, stage);
  }
}

bool PorePressure::any() const {
  const auto is_any = [](const WaterCard* card) { return card != nullptr; };
  return beside_ || std::ranges::any_of(cards_, is_any);
}

void PorePressure::take_nodes(const WaterCard& card, std::size_t group) {
  nodes_[group].assign(model_->mesh.nodes(), kNone);
  for (const auto& [node, pressure] : card.nodes) nodes_[group][node] = pressure;
  fill_middles(group);
}

void PorePressure::take_heads(std::size_t group, const DofMap& map, const Eigen::VectorXd* unknowns) {
  const int head = find_unknown(model_->unknowns, "head");
  nodes_[group].assign(model_->mesh.nodes(), kNone);
  for (const int node : model_->groups[group].nodes)
    if (const int dof = head < 0 ? -1 : map.of(node, head); dof >= 0)
      nodes_[group][node] = model_->units.water_unit_weight * ((*unknowns)[dof] - model_->mesh.x(1, node));
  fill_middles(group);
}

// Nodes along an edge that have no pressure of their own lie between its ends.  What is left has none.
void PorePressure::fill_middles(std::size_t group) {
  std::vector<double>& u = nodes_[group];
  const Group& own = model_->groups[group];
  for (int e = 0; e < own.elements(); ++e)
    for (const std::vector<int>& edge : own.element->edges()) {
      const int* const nodes = own.nodes_of(e);
      const double a = u[nodes[edge[0]]], b = u[nodes[edge[1]]];
      for (std::size_t i = 2; i < edge.size(); ++i) {
        double& middle = u[nodes[edge[i]]];
        const double part = static_cast<double>(i - 1) / static_cast<double>(edge.size() - 1);
        if (std::isnan(middle)) middle = a + part * (b - a);
      }
    }
  for (double& value : u)
    if (std::isnan(value)) value = 0.0;
}

PorePressure::Fall PorePressure::fall_of(const WaterCard& card, int group) const {
  Fall fall{line_before(*model_, card, group), nullptr,
            is_undrained(*model_, card.stage, group) ? 0.0 : card.value};
  if (fall.before == nullptr) return fall;
  for (std::size_t g = 0; g < falls_.size(); ++g)
    if (falls_[g].ground != nullptr && cards_[g]->stage == card.stage) fall.ground = falls_[g].ground;
  if (fall.ground != nullptr) return fall;
  Activity before(*model_);
  for (int s = 0; s < card.stage; ++s) before.enter(model_->stages[s]);
  fall.ground = std::make_shared<const Overburden>(*model_, before.group, card.stage - 1);
  return fall;
}

double PorePressure::nodal(std::size_t group, int element, std::span<const double> N) const {
  const int* const nodes = model_->groups[group].nodes_of(element);
  double u = 0.0;
  for (std::size_t i = 0; i < N.size(); ++i) u += N[i] * nodes_[group][nodes[i]];
  return std::max(0.0, u);
}

double PorePressure::below(const WaterCard& line, const Vector2& place) const {
  return std::max(0.0, share_of_depth(line, place.x()) * model_->units.water_unit_weight *
                           (water_level(line, place.x()) - place.y()));
}

// docs/theory/effective_stress.md, "Rapid drawdown".
double PorePressure::drawn_down(std::size_t group, int element, const Vector2& place) const {
  const WaterCard &now = *cards_[group], &before = *falls_[group].before;
  // A little inside the element: on a vertical side the ground of the element counts, not that behind the side.
  const std::vector<Vector2> corners = corners_of(*model_, model_->groups[group], element);
  double inward = 0.0;
  for (const Vector2& corner : corners) inward += corner.x() - place.x();
  const Vector2 inside(place.x() + std::copysign(1e-12 * (std::abs(place.x()) + std::abs(inward)), inward),
                       place.y());
  const double ground = falls_[group].ground->above(inside).top;
  const auto depth_of_water = [&](const WaterCard& line) {
    return std::max(0.0, water_level(line, place.x()) - ground);
  };
  const double fall = std::max(0.0, depth_of_water(before) - depth_of_water(now));
  return std::max(0.0, below(before, place) - falls_[group].share * model_->units.water_unit_weight * fall);
}

double PorePressure::outside(std::size_t group, int element, const Vector2& place,
                             std::span<const double> N) const {
  const WaterCard* const card = cards_[group];
  if (card == nullptr || card->kind != WaterKind::drawdown) return at(group, element, place, N);
  return std::max(0.0, model_->units.water_unit_weight * (water_level(*card, place.x()) - place.y()));
}

double PorePressure::at(std::size_t group, int element, const Vector2& place, std::span<const double> N) const {
  const WaterCard* const card = cards_[group];
  if (card == nullptr) return 0.0;
  switch (card->kind) {
    case WaterKind::line:
      return below(*card, place);
    case WaterKind::drawdown:
      return drawn_down(group, element, place);
    case WaterKind::ratio:
      return card->value * overburden_->above(place).stress;
    default:
      return nodal(group, element, N);
  }
}

Vector2 PorePressure::gradient(std::size_t group, int element, const Vector2& place, std::span<const double> N,
                               const Eigen::MatrixX2d& dN) const {
  Vector2 slope = Vector2::Zero();
  const WaterCard* const card = cards_[group];
  if (card == nullptr || !(at(group, element, place, N) > 0.0)) return slope;
  if (card->kind == WaterKind::line)
    return share_of_depth(*card, place.x()) * model_->units.water_unit_weight *
           Vector2(slope_at(*card, place.x()), -1.0);
  const int* const nodes = model_->groups[group].nodes_of(element);
  for (Eigen::Index i = 0; i < dN.rows(); ++i) slope += nodes_[group][nodes[i]] * dN.row(i).transpose();
  return slope;
}

double PorePressure::at_point(std::size_t group, int element, int point) const {
  if (cards_[group] == nullptr) return 0.0;
  const Group& own = model_->groups[group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, own, element, x);
  const Vector2 place = own.element->position(x, point);
  Mapped mapped;
  if (nodes_[group].empty()) return at(group, element, place, {});
  Vector2 parent = own.entry->triangle() ? Vector2(1.0 / 3.0, 1.0 / 3.0) : Vector2(0.0, 0.0);
  for (int step = 0; step < 20; ++step) {
    mapped.take(*own.element, x, parent);
    const Vector2 missing = place - mapped.place;
    const double det = mapped.det();
    const Vector2 change((mapped.J(1, 1) * missing.x() - mapped.J(0, 1) * missing.y()) / det,
                         (-mapped.J(1, 0) * missing.x() + mapped.J(0, 0) * missing.y()) / det);
    if (!(change.cwiseAbs().maxCoeff() > 1e-13)) break;
    parent += change;
  }
  mapped.take(*own.element, x, parent);
  return at(group, element, place, mapped.N);
}

}  // namespace sage
