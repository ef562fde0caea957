// Shape functions of a line through two nodes at -1 and 1, or a parabola with a third at 0: structures, edges.
#pragma once

#include <Eigen/Core>

namespace sage {

inline Eigen::Vector3d line_shapes(bool middle, double xi) {
  if (middle) return {0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi};
  return {0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0};
}

inline Eigen::Vector3d line_slopes(bool middle, double xi) {
  if (middle) return {xi - 0.5, xi + 0.5, -2.0 * xi};
  return {-0.5, 0.5, 0.0};
}

}  // namespace sage
