#include "sage/model/locate.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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

}  // namespace

Locator::Locator(const Model& model) : model_(&model) {
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (group.element->traits().law_size != 4) continue;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      const Vector2 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
      const Vector2 margin = Vector2::Constant(0.05 * (high - low).maxCoeff());  // curved edges bulge
      boxes_.push_back({g, e, low - margin, high + margin});
    }
  }
}

// Newton for the place in the parent shape; exact in one step where the map is affine.
bool Locator::inside(const Box& box, const Vector2& place, Location& found) const {
  constexpr int kSteps = 20;
  const Group& group = model_->groups[box.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, box.element, x);
  const auto nodes = static_cast<std::size_t>(x.cols());
  std::vector<double>& N = found.N;
  N.resize(nodes);
  std::vector<double> dN(2 * nodes);
  const bool triangle = group.element->edges().size() == 3;
  Vector2 q = triangle ? Vector2(1.0 / 3.0, 1.0 / 3.0) : Vector2(0.0, 0.0);
  for (int step = 0; step < kSteps; ++step) {
    if (!group.element->shape_functions(q, N, dN)) return false;
    const Vector2 missing = place - x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
    const Matrix2 J = x * Eigen::Map<const Eigen::MatrixX2d>(dN.data(), x.cols(), 2);
    const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    if (det == 0.0 || !std::isfinite(det)) return false;
    const Vector2 change((J(1, 1) * missing.x() - J(0, 1) * missing.y()) / det,
                         (-J(1, 0) * missing.x() + J(0, 0) * missing.y()) / det);
    q += change;
    if (q.cwiseAbs().maxCoeff() > 10.0) return false;  // far outside
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  found.group = box.group;
  found.element = box.element;
  found.parent = q;
  return in_parent(q, triangle) && group.element->shape_functions(q, N, dN);
}

std::vector<Location> Locator::at(const Vector2& place) const {
  std::vector<Location> found;
  for (const Box& box : boxes_) {
    if ((place.array() < box.low.array()).any() || (place.array() > box.high.array()).any()) continue;
    Location location;
    if (inside(box, place, location)) found.push_back(std::move(location));
  }
  return found;
}

std::vector<int> zones_of(const Model& model) {
  std::vector<int> birth(model.groups.size(), -1);  // -1: there from the start
  for (std::size_t s = 0; s < model.stages.size(); ++s)
    for (int g : model.stages[s].births) birth[static_cast<std::size_t>(g)] = static_cast<int>(s);
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
