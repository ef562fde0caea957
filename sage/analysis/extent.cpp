#include "sage/analysis/extent.hpp"

#include <algorithm>

#include "sage/model/dof_map.hpp"

namespace sage {

Extent::Extent(const Model& model) : axisymmetric_(model.geometry == Geometry::axisymmetric) {
  std::vector<char> used(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    for (const int node : group.nodes) used[node] = 1;
  for (int node = 0; node < model.mesh.nodes(); ++node)
    if (used[node]) nodes_.push_back(node);
  if (nodes_.empty()) return;
  Vector2 low = model.mesh.x.col(nodes_.front()), high = low;
  for (const int node : nodes_) {
    low = low.cwiseMin(model.mesh.x.col(node));
    high = high.cwiseMax(model.mesh.x.col(node));
  }
  sides_ = high - low;
  size_ = sides_.maxCoeff();
}

double Extent::motion(const Eigen::VectorXd& u) const {
  Vector2 low = Vector2::Zero(), high = Vector2::Zero();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector2 here = u.segment<2>(DofMap::displacement(nodes_[i]));
    if (i == 0) low = high = here;
    if (i == 0 && axisymmetric_) low.x() = high.x() = 0.0;
    low = low.cwiseMin(here);
    high = high.cwiseMax(here);
  }
  double largest = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    if (sides_[axis] > 0.0) largest = std::max(largest, (high[axis] - low[axis]) / sides_[axis]);
  return largest;
}

}  // namespace sage
