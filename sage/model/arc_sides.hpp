// Sides of elements that follow circles (Mesh::arcs): what divides them, or puts nodes inside them, puts these on the circle.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "sage/core/types.hpp"

namespace sage {

struct Mesh;
struct Model;

class ArcSides {
 public:
  explicit ArcSides(const Mesh& mesh);

  // Of the circle that the side between two nodes follows; nothing where it follows none.
  std::optional<Vector2> centre(int a, int z) const;

 private:
  std::map<std::pair<int, int>, Vector2> centres_;  // by the nodes at the ends, smaller first
};

// Whether a middle node lies off the straight line on a side of the outline or between two groups.
bool has_curved_sides(const Model& model);
// The same of sides that follow no circle: they are parabolas in every mesh that is made of this one.
bool has_parabolic_sides(const Model& model);

}  // namespace sage
