#include "sage/model/water.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "sage/model/solid_edges.hpp"

namespace sage {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Shape functions of an element at a place of the parent shape, and what they make of its nodes.
struct Mapped {
  std::vector<double> N;
  Eigen::MatrixX2d dN_parent, dN;  // one row a node; dN: along x and y
  Matrix2 J = Matrix2::Zero();     // d(x, y) / d(parent)
  Vector2 place = Vector2::Zero();

  void take(const Element& element, const Eigen::Matrix2Xd& x, const Vector2& parent) {
    N.resize(static_cast<std::size_t>(x.cols()));
    dN_parent.resize(x.cols(), 2);
    element.shape_functions(parent, N, {dN_parent.data(), static_cast<std::size_t>(dN_parent.size())});
    place = x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
    J = x * dN_parent;
  }
  double det() const { return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0); }
  void take_derivatives() {
    Matrix2 inverse;
    inverse << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0);
    dN = dN_parent * inverse / det();
  }
};

struct RulePlace {
  Vector2 parent;
  double weight;
};

// Gauss points and weights of (-1, 1).
struct GaussRule {
  std::vector<double> x, w;
  explicit GaussRule(int n) {
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
};

// Exact for the products that a straight-sided element of that degree has here.
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

Vector2 parent_corner(bool triangle, int corner) {
  static const Vector2 kSquare[] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
  static const Vector2 kTriangle[] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  return triangle ? kTriangle[corner] : kSquare[corner];
}

double measure(const Model& model, const Vector2& place) {
  return model.geometry == Geometry::axisymmetric ? 2.0 * std::numbers::pi * place.x() : 1.0;
}

std::pair<int, int> edge_key(int a, int b) {
  return std::minmax(a, b);
}

}  // namespace

const WaterCard* water_card(const Model& model, int stage, int group) {
  const WaterCard* found = nullptr;
  for (const WaterCard& card : model.water) {
    if (!card.pressure() || card.stage > stage || (card.group >= 0 && card.group != group)) continue;
    if (found == nullptr || card.stage >= found->stage) found = &card;
  }
  return found != nullptr && found->kind != WaterKind::dry ? found : nullptr;
}

const WaterCard* water_card(const Model& model, int stage, int group, WaterSide side) {
  const WaterCard* found = nullptr;
  for (const WaterCard& card : model.water) {
    const bool here = card.value == 0.0 || (card.value > 0.0) == (side == WaterSide::left);
    if (!card.pressure() || card.stage > stage || card.group != group || !here) continue;
    if (found == nullptr || card.stage >= found->stage) found = &card;
  }
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

namespace {

double water_slope(const WaterCard& card, double x) {
  const std::vector<Vector2>& line = card.line;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (x > line[i - 1].x() && x <= line[i].x())
      return (line[i].y() - line[i - 1].y()) / (line[i].x() - line[i - 1].x());
  return 0.0;
}

// Part of the hydrostatic pressure at a depth below a line: all of it, or by the card cos^2 of the line's slope, as in
// seepage along a slope, whose lines of equal head stand at right angles to it.
double share_of_depth(const WaterCard& card, double x) {
  if (card.value != 1.0) return 1.0;
  const double slope = water_slope(card, x);
  return 1.0 / (1.0 + slope * slope);
}

}  // namespace

Overburden::Overburden(const Model& model, const std::vector<char>& groups) {
  double high = -std::numeric_limits<double>::infinity();
  low_ = -high;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.solid()) continue;
    for (int e = 0; e < group.elements(); ++e) {
      Cell cell;
      cell.unit_weight = model.material_of(group).unit_weight;
      for (const std::vector<int>& edge : group.element->edges())
        cell.corners.push_back(model.mesh.x.col(group.nodes_of(e)[edge[0]]));
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
    const Cell& cell = cells_[static_cast<std::size_t>(c)];
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (std::size_t i = 0; i < cell.corners.size(); ++i) {
      const Vector2 &a = cell.corners[i], &b = cell.corners[(i + 1) % cell.corners.size()];
      if (!(std::min(a.x(), b.x()) <= place.x() && place.x() < std::max(a.x(), b.x()))) continue;
      const double y = a.y() + (place.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
      bottom = std::min(bottom, y);
      top = std::max(top, y);
    }
    if (!(top > place.y())) continue;
    sum.stress += cell.unit_weight * (top - std::max(bottom, place.y()));
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
      nodes_(model.groups.size()) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (groups[g] && model.groups[g].structure())
      for (const WaterSide side : {WaterSide::left, WaterSide::right})
        beside_ = beside_ || water_card(model, stage, static_cast<int>(g), side) != nullptr;
    if (!groups[g] || !model.groups[g].solid()) continue;
    const WaterCard* const card = water_card(model, stage, static_cast<int>(g));
    if (card == nullptr || (card->kind == WaterKind::heads && unknowns == nullptr)) continue;
    cards_[g] = card;
    if (card->kind == WaterKind::nodes) take_nodes(*card, g);
    if (card->kind == WaterKind::heads) take_heads(g, map, unknowns);
    if (card->kind == WaterKind::ratio && overburden_ == nullptr)
      overburden_ = std::make_shared<const Overburden>(model, groups);
  }
}

bool PorePressure::any() const {
  const auto is_any = [](const WaterCard* card) { return card != nullptr; };
  return beside_ || std::ranges::any_of(cards_, is_any);
}

void PorePressure::take_nodes(const WaterCard& card, std::size_t group) {
  nodes_[group].assign(static_cast<std::size_t>(model_->mesh.nodes()), kNone);
  for (const auto& [node, pressure] : card.nodes) nodes_[group][static_cast<std::size_t>(node)] = pressure;
  fill_middles(group);
}

void PorePressure::take_heads(std::size_t group, const DofMap& map, const Eigen::VectorXd* unknowns) {
  const int head = find_unknown(model_->unknowns, "head");
  nodes_[group].assign(static_cast<std::size_t>(model_->mesh.nodes()), kNone);
  for (const int node : model_->groups[group].nodes)
    if (const int dof = head < 0 ? -1 : map.of(node, head); dof >= 0)
      nodes_[group][static_cast<std::size_t>(node)] =
          model_->units.water_unit_weight * ((*unknowns)[dof] - model_->mesh.x(1, node));
  fill_middles(group);
}

// Nodes along an edge that have no pressure of their own lie between its ends.  What is left has none.
void PorePressure::fill_middles(std::size_t group) {
  std::vector<double>& u = nodes_[group];
  const Group& own = model_->groups[group];
  for (int e = 0; e < own.elements(); ++e)
    for (const std::vector<int>& edge : own.element->edges()) {
      const int* const nodes = own.nodes_of(e);
      const double a = u[static_cast<std::size_t>(nodes[edge[0]])],
                   b = u[static_cast<std::size_t>(nodes[edge[1]])];
      for (std::size_t i = 2; i < edge.size(); ++i) {
        double& middle = u[static_cast<std::size_t>(nodes[edge[i]])];
        const double part = static_cast<double>(i - 1) / static_cast<double>(edge.size() - 1);
        if (std::isnan(middle)) middle = a + part * (b - a);
      }
    }
  for (double& value : u)
    if (std::isnan(value)) value = 0.0;
}

double PorePressure::nodal(std::size_t group, int element, std::span<const double> N) const {
  const int* const nodes = model_->groups[group].nodes_of(element);
  double u = 0.0;
  for (std::size_t i = 0; i < N.size(); ++i) u += N[i] * nodes_[group][static_cast<std::size_t>(nodes[i])];
  return std::max(0.0, u);
}

double PorePressure::at(std::size_t group, int element, const Vector2& place, std::span<const double> N) const {
  const WaterCard* const card = cards_[group];
  if (card == nullptr) return 0.0;
  switch (card->kind) {
    case WaterKind::line:
      return std::max(0.0, share_of_depth(*card, place.x()) * model_->units.water_unit_weight *
                               (water_level(*card, place.x()) - place.y()));
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
           Vector2(water_slope(*card, place.x()), -1.0);
  const int* const nodes = model_->groups[group].nodes_of(element);
  for (Eigen::Index i = 0; i < dN.rows(); ++i)
    slope += nodes_[group][static_cast<std::size_t>(nodes[i])] * dN.row(i).transpose();
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

namespace {

SolidEdges edges_of_active(const Model& model, const std::vector<char>& groups) {
  return SolidEdges(model, [&](std::size_t g) { return groups[g] && model.groups[g].solid(); });
}

// Pairs of nodes that an active bar or beam goes along, whole elements and their halves.
std::set<std::pair<int, int>> lines_of_structures(const Model& model, const std::vector<char>& groups) {
  std::set<std::pair<int, int>> lines;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.structure() || group.element->edges().empty()) continue;
    const std::vector<int>& edge = group.element->edges().front();
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      for (std::size_t i = 0; i < edge.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) lines.insert(edge_key(nodes[edge[i]], nodes[edge[k]]));
    }
  }
  return lines;
}

// An element of a structure lies along the whole edge, or one along each part of it.
bool carries_structure(const std::set<std::pair<int, int>>& lines, const int* nodes,
                       const std::vector<int>& edge) {
  if (lines.empty()) return false;
  if (lines.contains(edge_key(nodes[edge[0]], nodes[edge[1]]))) return true;
  int last = nodes[edge[0]];
  const auto goes_on = [&](int next) { return lines.contains(edge_key(std::exchange(last, next), next)); };
  for (std::size_t i = 2; i < edge.size(); ++i)
    if (!goes_on(nodes[edge[i]])) return false;
  return edge.size() > 2 && goes_on(nodes[edge[1]]);
}

}  // namespace

std::vector<FreeEdge> free_edges(const Model& model, const std::vector<char>& groups) {
  const std::set<std::pair<int, int>> lines = lines_of_structures(model, groups);
  std::vector<FreeEdge> free;
  edges_of_active(model, groups).for_single([&](int, const SolidEdge& edge) {
    const Group& group = model.groups[static_cast<std::size_t>(edge.group)];
    const std::vector<int>& local = group.element->edges()[static_cast<std::size_t>(edge.local)];
    free.push_back(
        {edge.group, edge.element, edge.local, carries_structure(lines, group.nodes_of(edge.element), local)});
  });
  return free;
}

namespace {

// Groups of active solids by the sides of elements of structures that they lie on, with or without a joint between.
class SolidsBeside {
 public:
  SolidsBeside(const Model& model, const std::vector<char>& groups) : solids_(edges_of_active(model, groups)) {
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      if (!groups[g] || !group.interface()) continue;
      for (int e = 0; e < group.elements(); ++e) {
        // Its sides go from 1 to 2 and from 3 to 4; what lies behind one has it the other way round.
        const int* const n = group.nodes_of(e);
        if (const int behind = touching(n[3], n[2]); behind >= 0) joints_[{n[0], n[1]}] = behind;
        if (const int behind = touching(n[1], n[0]); behind >= 0) joints_[{n[2], n[3]}] = behind;
      }
    }
  }

  // The group on the left of the way from node to node; -1 = there is none.
  int on(int from, int to) const {
    if (const int group = touching(from, to); group >= 0) return group;
    const auto joint = joints_.find({from, to});
    return joint == joints_.end() ? -1 : joint->second;
  }

 private:
  int touching(int from, int to) const {
    for (const SolidEdge& edge : solids_.at(std::min(from, to)))
      if (edge.other == std::max(from, to) && edge.reversed == (from > to)) return edge.group;
    return -1;
  }

  SolidEdges solids_;
  std::map<std::pair<int, int>, int> joints_;  // solids behind joints
};

// Pore pressure stands, or may stand, in solids of the group on the line between two nodes.
bool is_wet(const Model& model, int stage, int group, int from, int to) {
  const WaterCard* const card = group < 0 ? nullptr : water_card(model, stage, group);
  if (card == nullptr || card->kind != WaterKind::line) return card != nullptr;
  const auto covered = [&](int node) {
    return water_level(*card, model.mesh.x(0, node)) > model.mesh.x(1, node);
  };
  return covered(from) || covered(to);
}

}  // namespace

std::vector<BesideStructure> structures_beside_water(const Model& model, int stage,
                                                     const std::vector<char>& groups) {
  std::vector<BesideStructure> list;
  bool any = false;
  for (std::size_t g = 0; g < model.groups.size(); ++g) any = any || (groups[g] && model.groups[g].structure());
  if (!any) return list;
  const SolidsBeside solids(model, groups);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!groups[g] || !group.structure() || group.element->edges().empty()) continue;
    const std::vector<int>& edge = group.element->edges().front();
    for (int e = 0; e < group.elements(); ++e) {
      const int a = group.nodes_of(e)[edge[0]], b = group.nodes_of(e)[edge[1]];
      const int left = solids.on(a, b), right = solids.on(b, a);
      list.push_back({static_cast<int>(g), e, left < 0, right < 0,
                      is_wet(model, stage, left, a, b) || is_wet(model, stage, right, a, b)});
    }
  }
  return list;
}

namespace {

// The line of a structure's element through its two or three nodes, by xi from -1 to 1.
struct StructureLine {
  Eigen::Matrix<double, 2, 3> x = Eigen::Matrix<double, 2, 3>::Zero();
  bool curved = false;

  StructureLine(const Mesh& mesh, const int* nodes, const std::vector<int>& edge) : curved(edge.size() > 2) {
    for (std::size_t i = 0; i < std::min<std::size_t>(edge.size(), 3); ++i)
      x.col(static_cast<Eigen::Index>(i)) = mesh.x.col(nodes[edge[i]]);
  }
  Eigen::Vector3d N(double xi) const {
    if (curved) return {0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi};
    return {0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0};
  }
  Vector2 along(double xi) const {
    return x * (curved ? Eigen::Vector3d(xi - 0.5, xi + 0.5, -2.0 * xi) : Eigen::Vector3d(-0.5, 0.5, 0.0));
  }
  Vector2 at(double xi) const { return x * N(xi); }
};

// Between a and b, where f has other signs.
template <class F>
double zero_between(const F& f, double a, double b) {
  const bool below = f(a) < 0.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (a + b);
    ((f(middle) < 0.0) == below ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

// xi where the depth below the water begins or bends: pieces between them have a smooth pressure.
std::vector<double> pieces(const StructureLine& line, const WaterCard& card) {
  constexpr int kLooks = 8;
  std::vector<double> at{-1.0, 1.0};
  const auto add_zeros = [&](const auto& f) {
    for (int i = 0; i < kLooks; ++i) {
      const double a = -1.0 + 2.0 * i / kLooks, b = -1.0 + 2.0 * (i + 1) / kLooks;
      if ((f(a) < 0.0) != (f(b) < 0.0)) at.push_back(zero_between(f, a, b));
    }
  };
  add_zeros([&](double xi) { return water_level(card, line.at(xi).x()) - line.at(xi).y(); });
  for (const Vector2& point : card.line) add_zeros([&](double xi) { return line.at(xi).x() - point.x(); });
  std::ranges::sort(at);
  return at;
}

// f += free water of a card on an element.  sense: 1 pushes to the left of the way from node 1 to node 2.  at_nodes: by
// the shape functions of the edges of solids beside it.
void add_free_water(const Model& model, const Group& group, int element, const WaterCard& card, double sense,
                    bool at_nodes, std::span<double> f) {
  const GaussRule rule(4);
  const std::vector<int>& edge = group.element->edges().front();
  const StructureLine line(model.mesh, group.nodes_of(element), edge);
  const std::vector<double> ends = pieces(line, card);
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, group, element, x);
  const auto force_at = at_nodes ? nullptr : group.formulation_entry().force_at;
  for (std::size_t piece = 1; piece < ends.size(); ++piece) {
    const double half = 0.5 * (ends[piece] - ends[piece - 1]);
    for (std::size_t q = 0; q < rule.x.size(); ++q) {
      const double xi = ends[piece - 1] + half * (1.0 + rule.x[q]);
      const Vector2 place = line.at(xi), along = line.along(xi);
      const double u = model.units.water_unit_weight * (water_level(card, place.x()) - place.y());
      if (!(u > 0.0)) continue;
      const Vector2 force =
          sense * half * rule.w[q] * measure(model, place) * u * Vector2(-along.y(), along.x());
      if (force_at != nullptr) {
        force_at(x, xi, force, f);
        continue;
      }
      const Eigen::Vector3d N = line.N(xi);
      for (std::size_t i = 0; i < std::min<std::size_t>(edge.size(), 3); ++i)
        Vector2::Map(f.data() + 2 * edge[i]) += N[static_cast<Eigen::Index>(i)] * force;
    }
  }
}

}  // namespace

void water_on_structures(const Model& model, int stage, const std::vector<char>& groups, int only,
                         const AddWater& add) {
  const auto card = [&](int group, WaterSide side) { return water_card(model, stage, group, side); };
  const auto any = [&](int group) {
    return (only < 0 || group == only) && groups[static_cast<std::size_t>(group)] &&
           model.groups[static_cast<std::size_t>(group)].structure() &&
           (card(group, WaterSide::left) != nullptr || card(group, WaterSide::right) != nullptr);
  };
  bool wanted = false;
  for (std::size_t g = 0; g < model.groups.size(); ++g) wanted = wanted || any(static_cast<int>(g));
  if (!wanted) return;
  std::vector<double> f;
  for (const BesideStructure& one : structures_beside_water(model, stage, groups)) {
    if (!any(one.group)) continue;
    const WaterCard* const left = one.left ? card(one.group, WaterSide::left) : nullptr;
    const WaterCard* const right = one.right ? card(one.group, WaterSide::right) : nullptr;
    if (left == nullptr && right == nullptr) continue;
    const Group& group = model.groups[static_cast<std::size_t>(one.group)];
    f.assign(static_cast<std::size_t>(group.element->traits().dofs), 0.0);
    if (left != nullptr) add_free_water(model, group, one.element, *left, -1.0, one.wet, f);
    if (right != nullptr) add_free_water(model, group, one.element, *right, 1.0, one.wet, f);
    add(one.group, one.element, f);
  }
}

namespace {

// The force of water, put together.
class WaterForce {
 public:
  WaterForce(const Model& model, const Activity& activity, const PorePressure& water)
      : model_(model), activity_(activity), water_(water) {
    force_.setZero(activity.dof_map.dofs());
  }

  Eigen::VectorXd sum() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (water_.card(g) != nullptr) add_group(g);
    add_edges();
    add_structures();
    return std::move(force_);
  }

 private:
  void add_group(std::size_t g) {
    const Group& group = model_.groups[g];
    const bool ring = model_.geometry == Geometry::axisymmetric;
    const bool as_force = water_.card(g)->action == WaterAction::force;
    const std::vector<RulePlace> rule = rule_for(group.entry->triangle(), group.element->traits().degree);
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_.mesh, group, e, x_);
      const int* const nodes = group.nodes_of(e);
      for (const RulePlace& q : rule) {
        mapped_.take(*group.element, x_, q.parent);
        mapped_.take_derivatives();
        const double w = q.weight * mapped_.det() * measure(model_, mapped_.place);
        const double u = water_.at(g, e, mapped_.place, mapped_.N);
        if (!(u > 0.0)) continue;
        const Vector2 slope =
            as_force ? water_.gradient(g, e, mapped_.place, mapped_.N, mapped_.dN) : Vector2(0.0, 0.0);
        for (Eigen::Index i = 0; i < x_.cols(); ++i) {
          const double N = mapped_.N[static_cast<std::size_t>(i)];
          Vector2 f = u * mapped_.dN.row(i).transpose();
          if (ring) f.x() += u * N / mapped_.place.x();
          if (as_force) f = -N * slope;
          at(nodes[i]) += w * f;
        }
      }
    }
  }

  // Edges where the water outside, or in a joint, has the pressure of that behind them.
  void add_edges() {
    std::vector<FreeEdge> wet;
    std::set<std::pair<int, int>> keys;
    for (const FreeEdge& edge : free_edges(model_, activity_.group)) {
      const WaterCard* const card = water_.card(static_cast<std::size_t>(edge.group));
      if (card == nullptr || card->kind == WaterKind::ratio) continue;
      // Seepage force and buoyancy have the water at their edges in them.
      if (card->action == WaterAction::force) {
        keys.insert(key_of(edge));
        if (edge.on_structure) in_forces_.emplace(key_of(edge), edge);
      }
      if (card->action != WaterAction::edges || edge.on_structure) continue;
      wet.push_back(edge);
      keys.insert(key_of(edge));
    }
    take_joints();
    for (const FreeEdge& edge : wet) add_edge(edge, keys);
    take_back_shared();
  }

  // Where solids with seepage force meet such with pressures, no water stands between them: what the seepage force has
  // of it goes.
  void take_back_shared() {
    const auto card_of = [&](const SolidEdge& edge) {
      return water_.card(static_cast<std::size_t>(edge.group));
    };
    bool forces = false, pressures = false;
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (const WaterCard* const card = water_.card(g); card != nullptr)
        (card->action == WaterAction::force ? forces : pressures) = true;
    if (!forces || !pressures) return;
    const SolidEdges solids = edges_of_active(model_, activity_.group);
    for (int node = 0; node < model_.mesh.nodes(); ++node)
      for (const SolidEdge& edge : solids.at(node)) {
        if (card_of(edge) == nullptr || card_of(edge)->action != WaterAction::force) continue;
        const bool meets = std::ranges::any_of(solids.at(node), [&](const SolidEdge& one) {
          const WaterCard* const card = card_of(one);
          return one.other == edge.other && card != nullptr && card->action != WaterAction::force;
        });
        if (meets) press_edge({edge.group, edge.element, edge.local, false}, -1.0, nullptr);
      }
  }

  std::pair<int, int> key_of(const FreeEdge& edge) const {
    const Group& group = model_.groups[static_cast<std::size_t>(edge.group)];
    const std::vector<int>& local = group.element->edges()[static_cast<std::size_t>(edge.edge)];
    const int* const nodes = group.nodes_of(edge.element);
    return edge_key(nodes[local[0]], nodes[local[1]]);
  }

  // Sides of active interfaces: by their end nodes the nodes that lie opposite of each.
  void take_joints() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const Group& group = model_.groups[g];
      if (!activity_.group[g] || !group.interface()) continue;
      for (int e = 0; e < group.elements(); ++e) {
        const int* const n = group.nodes_of(e);
        std::map<int, int> right{{n[0], n[3]}, {n[1], n[2]}};
        for (std::size_t pair = 4; pair + 1 < group.node_count(); pair += 2) right[n[pair]] = n[pair + 1];
        std::map<int, int> left;
        for (const auto& [a, b] : right) left[b] = a;
        joints_[edge_key(n[0], n[1])] = std::move(right);
        joints_[edge_key(n[2], n[3])] = std::move(left);
      }
    }
  }

  // -u n on the solid; what lies behind a joint gets the opposite unless it is wet itself.
  void add_edge(const FreeEdge& edge, const std::set<std::pair<int, int>>& wet) {
    const Group& group = model_.groups[static_cast<std::size_t>(edge.group)];
    const int* const nodes = group.nodes_of(edge.element);
    const std::vector<int>& local = group.element->edges()[static_cast<std::size_t>(edge.edge)];
    const auto joint = joints_.find(key_of(edge));
    const std::map<int, int>* behind = joint == joints_.end() ? nullptr : &joint->second;
    if (behind != nullptr) {
      const auto other = [&](int corner) { return behind->at(nodes[local[static_cast<std::size_t>(corner)]]); };
      if (wet.contains(edge_key(other(0), other(1)))) behind = nullptr;
    }
    press_edge(edge, 1.0, behind);
  }

  // -u n on the solid, times sense, and the opposite on the nodes behind.
  void press_edge(const FreeEdge& edge, double sense, const std::map<int, int>* behind) {
    const auto g = static_cast<std::size_t>(edge.group);
    const Group& group = model_.groups[g];
    const bool triangle = group.entry->triangle();
    element_coordinates(model_.mesh, group, edge.element, x_);
    const int* const nodes = group.nodes_of(edge.element);
    const std::vector<int>& local = group.element->edges()[static_cast<std::size_t>(edge.edge)];
    const Vector2 from = parent_corner(triangle, local[0]), to = parent_corner(triangle, local[1]);
    const GaussRule line(group.element->traits().degree + 2);
    for (std::size_t q = 0; q < line.x.size(); ++q) {
      mapped_.take(*group.element, x_, from + 0.5 * (1.0 + line.x[q]) * (to - from));
      const Vector2 along = 0.5 * mapped_.J * (to - from);
      const double w = sense * line.w[q] * measure(model_, mapped_.place);
      const double u = water_.at(g, edge.element, mapped_.place, mapped_.N);
      if (!(u > 0.0)) continue;
      for (const int i : local) {
        const Vector2 f = mapped_.N[static_cast<std::size_t>(i)] * w * u * Vector2(-along.y(), along.x());
        at(nodes[i]) += f;
        if (behind == nullptr) continue;
        if (const auto opposite = behind->find(nodes[i]); opposite != behind->end()) at(opposite->second) -= f;
      }
    }
  }

  void add_structures() {
    std::vector<int> dofs;
    const auto add = [&](int g, int element, std::span<const double> f) {
      const Group& group = model_.groups[static_cast<std::size_t>(g)];
      activity_.dof_map.list(group, element, dofs);
      for (std::size_t i = 0; i < dofs.size(); ++i) force_[dofs[i]] += f[i];
      take_back_behind(group, element);
    };
    water_on_structures(model_, water_.stage(), activity_.group, -1, add);
  }

  // Seepage force has water at the edge that carries the structure; what the card says of its other side stands in its
  // place.
  void take_back_behind(const Group& group, int element) {
    const std::vector<int>& edge = group.element->edges().front();
    const int* const nodes = group.nodes_of(element);
    const auto behind = in_forces_.find(edge_key(nodes[edge[0]], nodes[edge[1]]));
    if (behind == in_forces_.end()) return;
    press_edge(behind->second, -1.0, nullptr);
    in_forces_.erase(behind);
  }

  Eigen::VectorBlock<Eigen::VectorXd, 2> at(int node) { return force_.segment<2>(DofMap::displacement(node)); }

  const Model& model_;
  const Activity& activity_;
  const PorePressure& water_;
  Eigen::VectorXd force_;
  Eigen::Matrix2Xd x_;
  Mapped mapped_;
  std::map<std::pair<int, int>, std::map<int, int>> joints_;
  std::map<std::pair<int, int>, FreeEdge> in_forces_;  // that carry structures, of solids with seepage force
};

}  // namespace

Eigen::VectorXd water_force(const Model& model, const Activity& activity, const PorePressure& water) {
  return WaterForce(model, activity, water).sum();
}

}  // namespace sage
