// Sides of elements that follow circles (Mesh::arcs): what divides them, or puts nodes inside them, puts these on the circle.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "sage/core/types.hpp"

namespace sage {

struct Mesh;
struct Model;

// On the circle through a and z, by equal angles; t from a to z, the shorter way round.  Between different radii the
// radius changes evenly.
Vector2 along_arc(const Vector2& a, const Vector2& z, const Vector2& centre, double t);

class ArcSides {
 public:
  explicit ArcSides(const Mesh& mesh);

  bool contains(int a, int z) const { return centre(a, z) != nullptr; }
  // A place on the side from node a to node z, which lie at x_a and x_z: on its circle, else as along_edge().
  Vector2 along(int a, int z, const Vector2& x_a, const Vector2& x_z, const std::optional<Vector2>& middle,
                double t) const;

 private:
  const Vector2* centre(int a, int z) const;

  std::map<std::pair<int, int>, Vector2> centres_;  // by the nodes at the ends, smaller first
};

// Whether a middle node lies off the straight line on a side of the outline or between two groups.
bool has_curved_sides(const Model& model);
// The same of sides that follow no circle: they are parabolas in every mesh that is made of this one.
bool has_parabolic_sides(const Model& model);

}  // namespace sage
