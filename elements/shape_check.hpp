// Says what is wrong with an element's shape.  Only the cheap tests run for every element; the search for a
// reason runs once a test has failed.
#pragma once

#include "elements/shapes.hpp"
#include "sage/core/element.hpp"

namespace sage {

// Below this quality (smallest over mean detJ) a shape is refused.
inline constexpr double kSmallestQuality = 1e-9;
// Radii this far below zero, relative to the element's size, are rounding of a mesher.
inline constexpr double kRadiusTolerance = 1e-9;

// Diagonal of the box around the nodes.
double extent(const NodeCoordinates& x);

// Throws ElementShapeError naming the first node with a negative radius.
void check_radii(const NodeCoordinates& x);

// Throws ElementShapeError with the reason why a solid's quality is too low: coordinates that are not numbers,
// coincident nodes, zero area, clockwise order, crossed edges, a re-entrant corner, a misplaced mid-side node.
[[noreturn]] void reject_shape(const NodeCoordinates& x, int corners, const EdgeNodes& edges);

}  // namespace sage
