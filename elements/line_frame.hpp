// What bars and beams share: their directions, the circle that a point stands for, loads along the line.
#pragma once

#include "elements/kinematics.hpp"
#include "elements/shape_check.hpp"
#include "elements/shapes.hpp"
#include "sage/core/types.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// Along the line from its first to its second end, and to the left of it.
struct LineFrame {
  Vector2 t = Vector2::UnitX(), n = Vector2::UnitY();
  double J = 0.0;  // length for each unit of the parent line

  explicit LineFrame(const Vector2& along) : J(along.norm()) {
    t = along / J;
    n = {-t.y(), t.x()};
  }
};

// The value of an end where a load is given at both, at xi.
inline double between_ends(const Vector2& ends, double xi) {
  return Line2::N(xi).dot(ends);
}

// Refuses a structure that can't be computed with; what: "bar", "beam".
template <class Line, class Kinematics>
void check_line(const NodeCoordinates& x, const std::string& what) {
  if (!x.allFinite()) throw ElementShapeError(what + ": a coordinate is not a number");
  const double size = extent(x);
  if (!((x.col(1) - x.col(0)).norm() > 1e-12 * x.cwiseAbs().maxCoeff()) || !(size > 0.0))
    throw ElementShapeError(what + ": no length, its ends are at the same place");
  if constexpr (Kinematics::geometry == Geometry::axisymmetric) {
    check_radii(x);
    if (x.row(0).maxCoeff() <= kRadiusTolerance * size)
      throw ElementShapeError(what + ": it lies on the axis r = 0, where a circle has no length");
  }
  if constexpr (Line::nodes == 3) {
    const Vector2 chord = (x.col(1) - x.col(0)).normalized();
    for (const double xi : {-1.0, 1.0})
      if (!(chord.dot(x * Line::dN(xi)) > 1e-3 * size))
        throw ElementShapeError(what + ": its middle node folds the element: keep it near the middle");
  }
}

}  // namespace sage
