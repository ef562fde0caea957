// Which elements that fill an area hold a place, and where it lies in their parent shape.
#pragma once

#include <vector>

#include "sage/model/arc_sides.hpp"
#include "sage/model/model.hpp"

namespace sage {

struct Location {
  std::size_t group = 0;
  int element = 0;                   // index within the group
  Vector2 parent = Vector2::Zero();  // place in the parent shape
  std::vector<double> N;             // shape functions there, one a node
};

// The place in the parent shape of an element with nodes at x (2 x nodes) that is mapped to `place`, and the shape
// functions there.  False where there is none within ten times the element, or the element has no shape functions.
bool find_parent(const Group& group, const Eigen::Matrix2Xd& x, const Vector2& place, Vector2& parent,
                 std::vector<double>& N);

class Locator {
 public:
  // Among the solids, or the elements of flow.  The model must outlive the locator.
  explicit Locator(const Model& model, ElementKind kind = ElementKind::solid);

  // Every such element that holds the place, in the order of groups and elements; its edges belong to it (to
  // 1e-6 of its size).  Of a group without one: those whose edge is nearest, at the nearest place there, if
  // that is within the mesh's reach, or between a side of the element and the circle that it follows.  So what the deck's
  // mesh or its drawing holds is held by every mesh that is made of it.
  std::vector<Location> at(const Vector2& place) const;

 private:
  struct Box {
    std::size_t group = 0;
    int element = 0;
    Vector2 low, high;
  };
  bool inside(const Box& box, const Vector2& place, Location& found) const;
  bool before_circle(const Box& box, std::size_t side, const Vector2& place) const;
  std::size_t strip_at(double x) const;
  double nearest(const Box& box, const Vector2& place, Location& found) const;

  const Model* model_;
  ArcSides arcs_;
  std::vector<Box> boxes_;
  // Boxes by strips along x, each in the order of boxes_.
  std::vector<std::vector<int>> strips_;
  double left_ = 0.0, strip_ = 1.0;
};

// What point reports show: the solids, or the elements of flow where the model has no solid.
ElementKind kind_at_points(const Model& model);

// Of a mesh as the deck has it: the most by which a place that Locator::at gives to an element lies outside.
double reach_of(const Model& model);

// Groups whose stress is one field: of one material, and born at the same time.  A number for every group.
std::vector<int> zones_of(const Model& model);

// Of `found`, those that one body answers with: the elements that share a node with the first of an active
// group (`group`, or any where that is negative) and belong to its zone.  Empty where no active element is
// left. `active` by group; empty = all are.
std::vector<Location> one_body(const Model& model, std::vector<Location> found, const std::vector<char>& active,
                               int group);

}  // namespace sage
