// Bars, springs and rings: an axial force alone.  docs/theory/structures.md
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "elements/edge_load.hpp"
#include "elements/line_frame.hpp"
#include "elements/point_kernel.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

// eps = t . du/ds.  Line2 with one point, Line3 with two.  In axisymmetry strips along the meridian, all around
// the circle: forces count for each unit of circumference, and nothing runs around.
template <class Line, class Kinematics>
class Bar final : public PointElement<1, 2 * Line::nodes, Line::nodes - 1> {
  static constexpr int kNodes = Line::nodes, kPoints = Line::nodes - 1;
  using Nodes = Eigen::Matrix<double, 2, kNodes>;

 public:
  explicit Bar(std::string_view name);
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override {
    return x * Line::N(GaussLine<kPoints>::table[point].xi);
  }
  // b: force per length.
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override;
  // One side, the line itself: pressure > 0 pushes to the left of the way from node 1 to node 2.
  const std::vector<std::vector<int>>& edges() const override;
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override;
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override { return to_nodes_; }

 private:
  std::vector<double> to_nodes_;
};

// N = k times how much further apart the two nodes are along the line between them; the law's stiffness is then a
// force for each unit of length.
template <class Kinematics>
class Spring final : public PointElement<1, 4, 1> {
 public:
  explicit Spring(std::string_view name)
      : PointElement({.name = name,
                      .geometry = Kinematics::geometry,
                      .nodes = 2,
                      .dofs = 4,
                      .points = 1,
                      .law_size = 1}) {}
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int /*point*/) const override {
    return 0.5 * (x.col(0) + x.col(1));
  }
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override {
    static constexpr std::array<double, 2> same{1.0, 1.0};
    return same;
  }
};

// A bar around the axis of symmetry through one node: eps = u_r / r, the force of the whole section.
class Ring final : public PointElement<1, 2, 1> {
 public:
  explicit Ring(std::string_view name)
      : PointElement({.name = name,
                      .geometry = Geometry::axisymmetric,
                      .nodes = 1,
                      .dofs = 2,
                      .points = 1,
                      .law_size = 1}) {}
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int /*point*/) const override { return x.col(0); }
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override;
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override {
    static constexpr std::array<double, 1> same{1.0};
    return same;
  }
};

}  // namespace sage
