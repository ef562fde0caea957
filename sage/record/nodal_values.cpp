#include "sage/record/nodal_values.hpp"

#include <algorithm>

#include "sage/record/point_fields.hpp"

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

std::size_t size_of(const FieldList& fields) {
  std::size_t size = 0;
  for (const FieldEntry* field : fields) size += field->size();
  return size;
}

std::size_t carried_size_of(const FieldList& fields) {
  std::size_t size = 0;
  for (const FieldEntry* field : fields) size += carried_size(*field);
  return size;
}

std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  const FieldList& fields, NodalRule rule) {
  const std::size_t n = carried_size_of(fields);
  std::vector<double> sum(static_cast<std::size_t>(layout.entries()) * n, 0.0);
  std::vector<int> uses(static_cast<std::size_t>(layout.entries()), 0);
  std::vector<double> at_points, equal;
  std::vector<std::size_t> carried;
  for (const FieldEntry* field : fields) carried.push_back(carried_size(*field));
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const GroupData& data = solution.groups()[g];
    if (layout.of_group[g].empty()) continue;
    const Group& group = *data.group;
    const auto points = static_cast<std::size_t>(group.element->traits().points);
    const PointFields reader(fields, data);
    at_points.resize(points * n);
    equal.assign(points * group.node_count(), 1.0 / static_cast<double>(points));
    for (int e = 0; e < group.elements(); ++e) {
      const auto eu = static_cast<std::size_t>(e);
      for (std::size_t p = 0; p < points; ++p) {
        const PointState point(model.mesh, data, eu * points + p);
        double* to = at_points.data() + p * n;
        for (std::size_t f = 0; f < fields.size(); ++f) {
          reader.carry(f, point, to);
          to += carried[f];
        }
      }
      element_coordinates(model.mesh, group, e, x);
      const std::span<const double> map = rule == NodalRule::element_means ? std::span<const double>(equal)
                                                                           : group.element->point_to_node_at(x);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        const auto entry = static_cast<std::size_t>(layout.of_group[g][eu * group.node_count() + i]);
        ++uses[entry];
        double* const to = sum.data() + entry * n;
        for (std::size_t p = 0; p < points; ++p) {
          const double part = map[i * points + p];
          const double* const from = at_points.data() + p * n;
#pragma GCC ivdep
          for (std::size_t c = 0; c < n; ++c) to[c] += part * from[c];
        }
      }
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= std::max(uses[k / n], 1);
  return sum;
}

namespace {

// Adds one of `points` points to the mean over its element; what a field of_mean adds is what it carries.
void add_share(const FieldList& fields, const PointFields& reader, const PointState& point, double points,
               std::vector<double>& one, double* sum) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t n = fields[f]->of_mean ? carried_size(*fields[f]) : fields[f]->size();
    if (fields[f]->of_mean)
      reader.carry(f, point, one.data());
    else
      reader.read(f, point, one.data());
    for (std::size_t c = 0; c < n; ++c) sum[c] += one[c] / points;
    sum += n;
  }
}

}  // namespace

std::vector<double> element_average(const Mesh& mesh, const GroupData& data, const FieldList& fields) {
  const std::size_t n = size_of(fields);
  std::size_t summed = 0, most = 0;
  for (const FieldEntry* field : fields) {
    summed += field->of_mean ? carried_size(*field) : field->size();
    most = std::max({most, carried_size(*field), field->size()});
  }
  const auto points = static_cast<std::size_t>(data.group->element->traits().points);
  const auto elements = static_cast<std::size_t>(data.group->elements());
  std::vector<double> mean(elements * n, 0.0), sum(summed), one(most);
  const PointFields reader(fields, data);
  for (std::size_t e = 0; e < elements; ++e) {
    std::ranges::fill(sum, 0.0);
    for (std::size_t p = 0; p < points; ++p)
      add_share(fields, reader, {mesh, data, e * points + p}, static_cast<double>(points), one, sum.data());
    const double* from = sum.data();
    double* to = mean.data() + e * n;
    for (const FieldEntry* field : fields) {
      if (field->of_mean && !applies(*field, data))  // the mean of no stress has an angle, 0, all the same
        std::fill_n(to, field->size(), std::nan(""));
      else if (field->of_mean)
        value_of_carried(*field, from, to);
      else
        std::copy_n(from, field->size(), to);
      from += field->of_mean ? carried_size(*field) : field->size();
      to += field->size();
    }
  }
  return mean;
}

}  // namespace sage
