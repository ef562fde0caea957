// Stress at the nodes from stress at the points: a least-squares fit in parent coordinates, made once an
// element type.
#pragma once

#include <span>
#include <vector>

#include "elements/shapes.hpp"

namespace sage {

// nodes x points, row-major.  Exact where there are as many points as terms.  Every row sums to 1.
std::vector<double> extrapolation_matrix(std::span<const ParentPoint> points,
                                         std::span<const ParentPoint> nodes, Basis basis);

}  // namespace sage
