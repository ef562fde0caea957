// Geometry of elements by corners and mid-side nodes, for those who have no shape functions at hand.
#pragma once

#include <array>
#include <optional>

#include "sage/core/types.hpp"

namespace sage {

// The parent coordinates of a corner, and of a place between corners.
using Place = std::array<double, 2>;

// The place at t = 0 ... 1 on a side from a to z.  It lies on the circle around `centre` (by equal angles, the shorter way
// round; between different radii the radius changes evenly), else on the parabola through `middle`, else on the chord.
Vector2 along_side(const Vector2& a, const Vector2& z, const std::optional<Vector2>& middle,
                   const std::optional<Vector2>& centre, double t);

// Shape of an element that is known by its corners and sides, each as in along_side(): the serendipity quadrilateral or
// the six-node triangle where all sides are straight or parabolas.
struct CoarseShape {
  int corners = 4;
  std::array<Vector2, 4> corner;
  std::array<std::optional<Vector2>, 4> middle, centre;  // of the side after each corner

  // Whether a middle node lies off its chord.
  bool curved() const;
  Vector2 at(const Place& q) const;
};

// Share of each corner in a place: linear in a triangle, bilinear in a quadrilateral.
std::array<double, 4> corner_shares(int corners, const Place& q);

// Corners of the parent shapes, counter-clockwise.
const std::array<Place, 4>& parent_corners(int corners);

}  // namespace sage
