#include "sage/analysis/flow_through.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sage/math/line_shapes.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

namespace {

using Operator = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3>>;

// Stress or strain of a point: three numbers of a law of water.
Vector<3> at_point(const std::vector<double>& values, int points, int element, int point) {
  return Vector<3>::Map(values.data() +
                        3 * (static_cast<std::size_t>(element) * static_cast<std::size_t>(points) +
                             static_cast<std::size_t>(point)));
}

// Of the nodes of one edge, whose element lies on the left of the line: the line goes along with the edge.
double largest_gradient(const Model& model, const GroupData& data, const FlowLine::Edge& on) {
  const Element& element = *data.group->element;
  const int points = element.traits().points;
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, *data.group, on.element, x);
  const std::vector<int>& edge = element.edges()[on.edge];
  const Vector2 along = (x.col(edge[1]) - x.col(edge[0])).normalized(), out(along.y(), -along.x());
  const std::span<const double> map = element.point_to_node(x);
  double largest = -std::numeric_limits<double>::infinity();
  for (const int node : edge) {
    Vector2 slope = Vector2::Zero();
    for (int p = 0; p < points; ++p)
      slope += map[node * points + p] * at_point(data.state.committed.eps, points, on.element, p).head<2>();
    largest = std::max(largest, -slope.dot(out));
  }
  return largest;
}

// Of one edge with two or three nodes: pressure times the normal that points to the right of the line.
Vector2 pressure_force(const Model& model, const GroupData& data, const FlowLine::Edge& on,
                       const DofMap& dof_map, const Eigen::VectorXd& u) {
  const std::vector<int>& edge = data.group->element->edges()[on.edge];
  const int field = find_unknown(model.unknowns, "head");
  const auto node = [&](int i) { return data.group->nodes_of(on.element)[edge[i]]; };
  Vector2 force = Vector2::Zero();
  const bool curved = edge.size() > 2;
  for (const LinePoint& q : GaussLine<3>::table) {
    const Vector<3> N = line_shapes(curved, q.xi), slope = line_slopes(curved, q.xi);
    Vector2 x = Vector2::Zero(), along = Vector2::Zero();
    double head = 0.0;
    for (int i = 0; i < (curved ? 3 : 2); ++i) {
      x += N[i] * model.mesh.x.col(node(i));
      along += slope[i] * model.mesh.x.col(node(i));
      head += N[i] * u[dof_map.of(node(i), field)];
    }
    const double ring = model.geometry == Geometry::axisymmetric ? 2.0 * kPi * x.x() : 1.0;
    force += q.w * ring * (head - x.y()) * Vector2(along.y(), -along.x());
  }
  return model.units.water_unit_weight * force;
}

double mean_head(const Model& model, const std::vector<int>& nodes, const DofMap& dof_map,
                 const Eigen::VectorXd& u) {
  const int field = find_unknown(model.unknowns, "head");
  double sum = 0.0;
  for (const int node : nodes) sum += u[dof_map.of(node, field)];
  return sum / static_cast<double>(nodes.size());
}

// What meets at a node: the angle that the elements fill, and the edges that one of them has alone.
struct FlowCorner {
  double angle = 0.0;                      // radians
  std::map<std::vector<int>, int> owners;  // elements of each edge there, by its nodes
};

double angle_of(const Eigen::Matrix2Xd& x, const std::vector<std::vector<int>>& edges, int local) {
  Vector2 out = Vector2::Zero(), in = Vector2::Zero();
  for (const std::vector<int>& edge : edges) {
    if (edge[0] == local) out = x.col(edge[1]) - x.col(edge[0]);
    if (edge[1] == local) in = x.col(edge[0]) - x.col(edge[1]);
  }
  if (out.isZero(0.0)) return kPi;  // a node within an edge
  const double turn = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
  return turn < 0.0 ? turn + 2.0 * kPi : turn;
}

std::map<int, FlowCorner> corners_at(const Model& model, const std::vector<char>& active,
                                     const std::vector<int>& nodes) {
  std::map<int, FlowCorner> corners;
  for (const int node : nodes) corners[node];
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.flow() || !active[g]) continue;
    const std::vector<std::vector<int>>& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e) {
      const int* const own = group.nodes_of(e);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        const auto corner = corners.find(own[i]);
        if (corner == corners.end()) continue;
        element_coordinates(model.mesh, group, e, x);
        const auto local = static_cast<int>(i);
        const bool inside = std::ranges::none_of(
            edges, [&](const auto& edge) { return std::ranges::find(edge, local) != edge.end(); });
        corner->second.angle += inside ? 2.0 * kPi : angle_of(x, edges, local);
        for (const std::vector<int>& edge : edges) {
          if (std::ranges::find(edge, local) == edge.end()) continue;
          std::vector<int> key;
          for (const int n : edge) key.push_back(own[n]);
          std::ranges::sort(key);
          ++corner->second.owners[key];
        }
      }
    }
  }
  return corners;
}

}  // namespace

std::vector<int> unbounded_corners(const Model& model, const Activity& activity,
                                   const std::vector<int>& nodes) {
  constexpr double kMore = 10.0 * kRadiansPerDegree;
  const int field = find_unknown(model.unknowns, "head");
  const auto held = [&](int node) { return activity.held[activity.dof_map.of(node, field)] != 0; };
  std::vector<int> found;
  for (const auto& [node, corner] : corners_at(model, activity.group, nodes)) {
    int free = 0, with_heads = 0;
    for (const auto& [edge, owners] : corner.owners) {
      if (owners > 1) continue;
      ++free;
      with_heads += std::ranges::all_of(edge, held) ? 1 : 0;
    }
    if (free == 0) continue;
    const bool two_kinds = with_heads > 0 && with_heads < free;
    if (corner.angle > (two_kinds ? 0.5 * kPi : kPi) + kMore) found.push_back(node);
  }
  return found;
}

Eigen::VectorXd taken_in(const Model& model, const GroupData& data, int element) {
  const ElementTraits& traits = data.group->element->traits();
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, *data.group, element, x);
  std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
  data.group->element->geometry(x, geometry);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(traits.dofs);
  for (int p = 0; p < traits.points; ++p) {
    const double* const block = geometry.data() + static_cast<std::ptrdiff_t>(p) * (1 + 3 * traits.dofs);
    f += block[0] * Operator(block + 1, traits.dofs, 3) *
         at_point(data.state.committed.sigma, traits.points, element, p);
  }
  return f;
}

FlowThrough flow_through(const Model& model, const FlowLine& line, const std::vector<int>& nodes,
                         std::span<const GroupData> groups, const Activity& activity,
                         const Eigen::VectorXd& u) {
  FlowThrough through;
  const DofMap& dof_map = activity.dof_map;
  for (const FlowLine::Corner& corner : line.corners)
    through.discharge -= taken_in(model, groups[corner.group], corner.element)[corner.local];
  through.gradient = -std::numeric_limits<double>::infinity();
  for (const FlowLine::Edge& edge : line.edges)
    through.gradient = std::max(through.gradient, largest_gradient(model, groups[edge.group], edge));
  if (!unbounded_corners(model, activity, nodes).empty())
    through.gradient = std::numeric_limits<double>::quiet_NaN();
  for (const FlowLine::Edge& edge : line.edges)
    through.force += pressure_force(model, groups[edge.group], edge, dof_map, u);
  if (!(model.units.water_unit_weight > 0.0))
    through.force.setConstant(std::numeric_limits<double>::quiet_NaN());
  through.head = mean_head(model, nodes, dof_map, u);
  return through;
}

}  // namespace sage
