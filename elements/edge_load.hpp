// Consistent nodal forces of a traction on one edge.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "elements/shapes.hpp"
#include "sage/core/types.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

// f_i += integral N_i (p n + q s) measure(r) dL.  s is the unit tangent in the edge's own direction, n = (-s_y,
// s_x) points into the element because edges run counter-clockwise.  p and q vary linearly in xi from the first
// to the second corner.  x: one column a node of the edge, end, end, inner nodes.  Exact on straight edges: N p
// r is of degree nodes + 1.
template <class Line, class Kinematics>
void add_edge_load(const Eigen::Matrix<double, 2, Line::nodes>& x, const Vector2& normal, const Vector2& shear,
                   const std::vector<int>& edge, std::span<double> f) {
  for (const LinePoint& point : GaussLine<std::max(5, Line::nodes)>::table) {
    const Vector<Line::nodes> N = Line::N(point.xi);
    const Vector2 ds = x * Line::dN(point.xi);  // tangent times J
    const Vector2 into(-ds.y(), ds.x());
    const Vector2 ends = Line2::N(point.xi);
    const Vector2 traction = ends.dot(normal) * into + ends.dot(shear) * ds;
    const double w = point.w * Kinematics::measure(x.row(0).dot(N));
    for (int i = 0; i < Line::nodes; ++i) {
      const std::size_t dof = 2 * static_cast<std::size_t>(edge[i]);
      f[dof] += w * N(i) * traction.x();
      f[dof + 1] += w * N(i) * traction.y();
    }
  }
}

// f_i += integral N_i q measure(r) dL, one number a node; q varies linearly as p does above.
template <class Line, class Kinematics>
void add_edge_inflow(const Eigen::Matrix<double, 2, Line::nodes>& x, const Vector2& inflow,
                     const std::vector<int>& edge, std::span<double> f) {
  for (const LinePoint& point : GaussLine<std::max(5, Line::nodes)>::table) {
    const Vector<Line::nodes> N = Line::N(point.xi);
    const double length = (x * Line::dN(point.xi)).norm();
    const Vector2 ends = Line2::N(point.xi);
    const double w = point.w * length * Kinematics::measure(x.row(0).dot(N)) * ends.dot(inflow);
    for (int i = 0; i < Line::nodes; ++i) f[edge[i]] += w * N(i);
  }
}

}  // namespace sage
