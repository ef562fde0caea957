// What the motion of an edge makes of a load on it: pressure stays normal to the edge, and both act on its present length.
#pragma once

#include "elements/edge_load.hpp"
#include "sage/core/element.hpp"

namespace sage {

// change += the load on the moved edge less that on the edge in the mesh; K -= its derivative by the displacements (dofs x
// dofs, column-major; nullptr: not wanted).  mesh, moved: one column a node of the edge.
template <class Line, class Kinematics>
void add_follower(const Eigen::Matrix<double, 2, Line::nodes>& mesh,
                  const Eigen::Matrix<double, 2, Line::nodes>& moved, const EdgeTraction& load,
                  const std::vector<int>& edge, std::span<double> change, double* K) {
  add_edge_load<Line, Kinematics>(mesh, -load.normal, -load.shear, edge, change);
  add_edge_load<Line, Kinematics>(moved, load.normal, load.shear, edge, change);
  if (K == nullptr) return;
  const std::size_t dofs = change.size();
  for (const LinePoint& point : GaussLine<std::max(5, Line::nodes)>::table) {
    const Vector<Line::nodes> N = Line::N(point.xi), dN = Line::dN(point.xi);
    const Vector2 ends = Line2::N(point.xi), ds = moved * dN;
    const double p = ends.dot(load.normal), q = ends.dot(load.shear);
    const Matrix2 of_tangent = (Matrix2() << q, -p, p, q).finished();  // traction = of_tangent * ds
    const Vector2 traction = of_tangent * ds;
    const double around = Kinematics::measure(moved.row(0).dot(N));
    const double growth = Kinematics::geometry == Geometry::axisymmetric ? 2.0 * kPi : 0.0;
    for (int j = 0; j < Line::nodes; ++j) {
      Matrix2 rate = around * dN(j) * of_tangent;
      rate.col(0) += growth * N(j) * traction;
      const std::size_t column = 2 * static_cast<std::size_t>(edge[j]);
      for (int i = 0; i < Line::nodes; ++i) {
        const std::size_t row = 2 * static_cast<std::size_t>(edge[i]);
        Eigen::Map<Matrix2, 0, Eigen::OuterStride<>>(K + column * dofs + row,
                                                     Eigen::OuterStride<>(static_cast<Eigen::Index>(dofs))) -=
            point.w * N(i) * rate;
      }
    }
  }
}

}  // namespace sage
