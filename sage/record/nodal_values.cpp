#include "sage/record/nodal_values.hpp"

#include <algorithm>

namespace sage {

NodalLayout nodal_layout(const Model& model, const Activity& activity) {
  NodalLayout layout;
  layout.of_group.resize(model.groups.size());
  const auto nodes = static_cast<std::size_t>(model.mesh.nodes());
  std::vector<int> entry(nodes * model.materials.size(), -1);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!activity.group[g]) continue;
    const Group& group = model.groups[g];
    const std::size_t first = static_cast<std::size_t>(group.material) * nodes;
    for (int node : group.nodes) {
      int& e = entry[first + static_cast<std::size_t>(node)];
      if (e < 0) {
        e = layout.entries();
        layout.node.push_back(node);
      }
      layout.of_group[g].push_back(e);
    }
  }
  return layout;
}

std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  int components, const PointValue& value) {
  const auto n = static_cast<std::size_t>(components);
  std::vector<double> sum(static_cast<std::size_t>(layout.entries()) * n, 0.0);
  std::vector<int> uses(static_cast<std::size_t>(layout.entries()), 0);
  std::vector<double> at_points;
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const GroupData& data = solution.assembly->groups()[g];
    if (layout.of_group[g].empty()) continue;
    const Group& group = *data.group;
    const auto points = static_cast<std::size_t>(group.element->traits().points);
    at_points.resize(points * n);
    for (int e = 0; e < group.elements(); ++e) {
      const auto eu = static_cast<std::size_t>(e);
      for (std::size_t p = 0; p < points; ++p) value(data, eu * points + p, at_points.data() + p * n);
      element_coordinates(model.mesh, group, e, x);
      const std::span<const double> map = group.element->point_to_node_at(x);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        const auto entry = static_cast<std::size_t>(layout.of_group[g][eu * group.node_count() + i]);
        ++uses[entry];
        for (std::size_t p = 0; p < points; ++p)
          for (std::size_t c = 0; c < n; ++c) sum[entry * n + c] += map[i * points + p] * at_points[p * n + c];
      }
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= std::max(uses[k / n], 1);
  return sum;
}

std::vector<double> element_average(const GroupData& data, int components, const PointValue& value) {
  const auto n = static_cast<std::size_t>(components);
  const auto points = static_cast<std::size_t>(data.group->element->traits().points);
  std::vector<double> mean(static_cast<std::size_t>(data.group->elements()) * n, 0.0), one(n);
  for (std::size_t k = 0; k < mean.size() / n; ++k)
    for (std::size_t p = 0; p < points; ++p) {
      value(data, k * points + p, one.data());
      for (std::size_t c = 0; c < n; ++c) mean[k * n + c] += one[c] / static_cast<double>(points);
    }
  return mean;
}

}  // namespace sage
