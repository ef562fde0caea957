// Geometry of elements by corners and mid-side nodes, for those who have no shape functions at hand.
#pragma once

#include <array>
#include <optional>

#include "sage/core/types.hpp"

namespace sage {

// The parent coordinates of a corner, and of a place between corners.
using Place = std::array<double, 2>;

// Straight, or the parabola through a middle node; t from a to z.
Vector2 along_edge(const Vector2& a, const Vector2& z, const std::optional<Vector2>& middle, double t);

// Shape of an element that is known by its corners and by the middle nodes of the sides that are curved: the
// serendipity quadrilateral or the six-node triangle with straight sides where no middle node is given.
struct CoarseShape {
  int corners = 4;
  std::array<Vector2, 4> corner;
  std::array<std::optional<Vector2>, 4> middle;  // of the side after each corner

  bool curved() const;
  Vector2 at(const Place& q) const;
};

// Share of each corner in a place: linear in a triangle, bilinear in a quadrilateral.
std::array<double, 4> corner_shares(int corners, const Place& q);

// Corners of the parent shapes, counter-clockwise.
const std::array<Place, 4>& parent_corners(int corners);

}  // namespace sage
