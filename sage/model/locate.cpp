#include "sage/model/locate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "sage/model/coarse_shape.hpp"

namespace sage {

namespace {

constexpr double kEdge = 1e-6;  // places so close outside an element (of its size) count as on its edge

bool in_parent(const Vector2& q, bool triangle) {
  constexpr double tolerance = 2.0 * kEdge;
  if (triangle) return q.minCoeff() >= -tolerance && q.sum() <= 1.0 + tolerance;
  return q.cwiseAbs().maxCoeff() <= 1.0 + tolerance;
}

bool share_a_node(const Model& model, const Location& a, const Location& b) {
  const Group &ga = model.groups[a.group], &gb = model.groups[b.group];
  const int *na = ga.nodes_of(a.element), *nb = gb.nodes_of(b.element);
  return std::find_first_of(na, na + ga.node_count(), nb, nb + gb.node_count()) != na + ga.node_count();
}

// The most by which circles lie outside the chords of an element's sides.
double bulge_of(const Mesh& mesh, const ArcSides& arcs, const Group& group, int e) {
  const int* const nodes = group.nodes_of(e);
  double most = 0.0;
  for (const std::vector<int>& edge : group.element->edges()) {
    const std::optional<Vector2> centre = arcs.centre(nodes[edge[0]], nodes[edge[1]]);
    if (!centre) continue;
    const Vector2 a = mesh.x.col(nodes[edge[0]]), z = mesh.x.col(nodes[edge[1]]);
    most = std::max(most, (along_side(a, z, {}, centre, 0.5) - 0.5 * (a + z)).norm());
  }
  return most;
}

}  // namespace

ElementKind kind_at_points(const Model& model) {
  const auto has = [&](ElementKind kind) {
    return std::ranges::any_of(
        model.groups, [&](const Group& group) { return group.entry->kind == kind && group.elements() > 0; });
  };
  // Elements of one's own may flow without a head: reports would not know what to show.
  const bool heads =
      std::ranges::any_of(model.unknowns, [](const UnknownField& unknown) { return unknown.name == "head"; });
  return heads && has(ElementKind::flow) && !has(ElementKind::solid) ? ElementKind::flow : ElementKind::solid;
}

// Newton; exact in one step where the map is affine.
bool find_parent(const Group& group, const Eigen::Matrix2Xd& x, const Vector2& place, Vector2& parent,
                 std::vector<double>& N) {
  constexpr int kSteps = 20;
  constexpr double kFar = 10.0;
  const auto nodes = static_cast<std::size_t>(x.cols());
  N.resize(nodes);
  std::vector<double> dN(2 * nodes);
  parent = group.entry->triangle() ? Vector2(1.0 / 3.0, 1.0 / 3.0) : Vector2(0.0, 0.0);
  for (int step = 0; step < kSteps; ++step) {
    if (!group.element->shape_functions(parent, N, dN)) return false;
    const Vector2 missing = place - x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
    const Matrix2 J = x * Eigen::Map<const Eigen::MatrixX2d>(dN.data(), x.cols(), 2);
    const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    if (det == 0.0 || !std::isfinite(det)) return false;
    const Vector2 change((J(1, 1) * missing.x() - J(0, 1) * missing.y()) / det,
                         (-J(1, 0) * missing.x() + J(0, 0) * missing.y()) / det);
    parent += change;
    if (parent.cwiseAbs().maxCoeff() > kFar) return false;
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return group.element->shape_functions(parent, N, dN);
}

Locator::Locator(const Model& model, ElementKind kind) : model_(&model), arcs_(model.mesh) {
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (group.entry->kind != kind) continue;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      const Vector2 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
      // Curved edges bulge.
      const Vector2 margin = Vector2::Constant(0.05 * (high - low).maxCoeff() + model.mesh.reach +
                                               bulge_of(model.mesh, arcs_, group, e));
      boxes_.push_back({g, e, low - margin, high + margin});
    }
  }
  if (boxes_.empty()) return;
  left_ = std::ranges::min_element(boxes_, {}, [](const Box& box) { return box.low.x(); })->low.x();
  const double right =
      std::ranges::max_element(boxes_, {}, [](const Box& box) { return box.high.x(); })->high.x();
  strips_.resize(static_cast<std::size_t>(std::sqrt(static_cast<double>(boxes_.size()))) + 1);
  strip_ = std::max(right - left_, std::numeric_limits<double>::min()) / static_cast<double>(strips_.size());
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (std::size_t s = strip_at(boxes_[i].low.x()); s <= strip_at(boxes_[i].high.x()); ++s)
      strips_[s].push_back(static_cast<int>(i));
}

std::size_t Locator::strip_at(double x) const {
  const double last = static_cast<double>(strips_.size()) - 1.0;
  return static_cast<std::size_t>(std::clamp(std::floor((x - left_) / strip_), 0.0, last));
}

bool Locator::inside(const Box& box, const Vector2& place, Location& found) const {
  const Group& group = model_->groups[box.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, box.element, x);
  found.group = box.group;
  found.element = box.element;
  return find_parent(group, x, place, found.parent, found.N) &&
         in_parent(found.parent, group.entry->triangle());
}

// Whether a place beyond a side lies before the circle that the side follows, where the element is within that.
bool Locator::before_circle(const Box& box, std::size_t side, const Vector2& place) const {
  const Group& group = model_->groups[box.group];
  const int* const nodes = group.nodes_of(box.element);
  const std::vector<int>& edge = group.element->edges()[side];
  const std::optional<Vector2> centre = arcs_.centre(nodes[edge[0]], nodes[edge[1]]);
  if (!centre) return false;
  const Vector2 a = model_->mesh.x.col(nodes[edge[0]]), z = model_->mesh.x.col(nodes[edge[1]]), along = z - a,
                inward(-along.y(), along.x());  // edges run counter-clockwise
  return inward.dot(*centre - a) > 0.0 &&
         (place - *centre).norm() <= (a - *centre).norm() * (1.0 + kEdge) + model_->mesh.reach;
}

// Distance of the nearest place on the element's edges (infinite where there is none): Newton along each side,
// kept between its ends.  None where a circle that the nearest side follows holds the place.
double Locator::nearest(const Box& box, const Vector2& place, Location& found) const {
  constexpr int kSteps = 20;
  const Group& group = model_->groups[box.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, box.element, x);
  const auto nodes = static_cast<std::size_t>(x.cols());
  std::vector<double> N(nodes), dN(2 * nodes);
  double least = std::numeric_limits<double>::infinity(), at_least = 0.0;
  std::size_t nearest_side = 0;
  const auto corners = static_cast<std::size_t>(group.entry->triangle() ? 3 : 4);
  const std::array<Place, 4>& corner = parent_corners(group.entry->triangle() ? 3 : 4);
  for (std::size_t side = 0; side < corners; ++side) {
    const Vector2 from(corner[side][0], corner[side][1]);
    const Place& to = corner[(side + 1) % corners];
    const Vector2 along = Vector2(to[0], to[1]) - from;
    double t = 0.5;
    for (int step = 0; step < kSteps; ++step) {
      if (!group.element->shape_functions(from + t * along, N, dN)) return least;
      const Vector2 missing = place - x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
      const Vector2 tangent = x * Eigen::Map<const Eigen::MatrixX2d>(dN.data(), x.cols(), 2) * along;
      const double next = std::clamp(t + missing.dot(tangent) / tangent.squaredNorm(), 0.0, 1.0);
      if (missing.norm() < least) {
        least = missing.norm();
        nearest_side = side;
        at_least = t;
        found = {box.group, box.element, from + t * along, N};
      }
      if (!(std::abs(next - t) > 1e-12)) break;
      t = next;
    }
  }
  const bool between_ends = at_least > 0.0 && at_least < 1.0;
  return between_ends && before_circle(box, nearest_side, place) ? 0.0 : least;
}

std::vector<Location> Locator::at(const Vector2& place) const {
  constexpr double kAlike = 1e-3;  // of the reach: elements that share the nearest place
  struct Near {
    Location location;
    double distance = 0.0;
  };
  std::vector<Location> found;
  std::vector<Near> near;
  constexpr double kHeld = -1.0;
  std::map<std::size_t, double> least;  // distance by group; kHeld where an element holds the place
  if (strips_.empty()) return found;
  for (const int i : strips_[strip_at(place.x())]) {
    const Box& box = boxes_[i];
    if ((place.array() < box.low.array()).any() || (place.array() > box.high.array()).any()) continue;
    Location location;
    if (inside(box, place, location)) {
      found.push_back(std::move(location));
      least[box.group] = kHeld;
      continue;
    }
    const double distance = nearest(box, place, location);
    if (!(distance <= model_->mesh.reach)) continue;
    near.push_back({std::move(location), distance});
    const auto known = least.try_emplace(box.group, distance).first;
    known->second = std::min(known->second, distance);
  }
  for (Near& one : near)
    if (const double best = least[one.location.group];
        best != kHeld && one.distance <= best + kAlike * model_->mesh.reach)
      found.push_back(std::move(one.location));
  const auto before = [](const Location& a, const Location& b) {
    return std::pair(a.group, a.element) < std::pair(b.group, b.element);
  };
  std::sort(found.begin(), found.end(), before);
  return found;
}

double reach_of(const Model& model) {
  double largest = 0.0;
  for (const Group& group : model.groups)
    for (int e = 0; group.solid() && e < group.elements(); ++e) {
      Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity()), high = -low;
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        const int node = group.nodes_of(e)[i];
        if (node < 0) continue;  // to be made
        low = low.cwiseMin(model.mesh.x.col(node));
        high = high.cwiseMax(model.mesh.x.col(node));
      }
      largest = std::max(largest, (high - low).norm());
    }
  constexpr double kUneven = 2.0;  // a side whose middle node lies off its middle is that much longer there
  return kUneven * kEdge * largest;
}

std::vector<int> zones_of(const Model& model) {
  std::vector<int> birth(model.groups.size(), -1);  // -1: there from the start
  for (std::size_t s = 0; s < model.stages.size(); ++s)
    for (int g : model.stages[s].births) birth[g] = static_cast<int>(s);
  std::map<std::pair<int, int>, int> zones;
  std::vector<int> zone;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    zone.push_back(
        zones.try_emplace({model.groups[g].material, birth[g]}, static_cast<int>(zones.size())).first->second);
  return zone;
}

std::vector<Location> one_body(const Model& model, std::vector<Location> found, const std::vector<char>& active,
                               int group) {
  std::erase_if(found, [&](const Location& l) {
    return (!active.empty() && !active[l.group]) || (group >= 0 && l.group != static_cast<std::size_t>(group));
  });
  if (found.empty()) return found;
  const Location first = found.front();
  const std::vector<int> zone = zones_of(model);
  std::erase_if(found, [&](const Location& l) {
    return zone[l.group] != zone[first.group] || !share_a_node(model, first, l);
  });
  return found;
}

}  // namespace sage
