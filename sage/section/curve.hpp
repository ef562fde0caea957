// Straight pieces and arcs, and where they meet.  Not part of the public interface.
#pragma once

#include <vector>

#include "sage/core/types.hpp"

namespace sage::section {

// From a to b, straight or along an arc around `centre` by `sweep` (radians, counter-clockwise positive).
struct Curve {
  Vector2 a = Vector2::Zero(), b = Vector2::Zero();
  bool arc = false;
  Vector2 centre = Vector2::Zero();
  double radius = 0.0, start = 0.0, sweep = 0.0;

  Vector2 at(double t) const;  // t from 0 to 1 in equal lengths
  double length() const;
  double nearest(const Vector2& p) const;  // the place t of the closest point
  double distance(const Vector2& p) const { return (at(nearest(p)) - p).norm(); }
  Curve part(double from, double to) const;
};

Curve straight(const Vector2& a, const Vector2& b);
Curve arc_around(const Vector2& centre, double radius, double start, double sweep);

// Where two curves meet: points that lie on both within the tolerance.  Of curves that lie on each other the ends of the
// common part.
std::vector<Vector2> meetings(const Curve& one, const Curve& other, double tolerance);

inline double cross(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace sage::section
