#include "elements/shape_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

std::string number(int local) {
  return std::to_string(local + 1);
}

// "4 3 2 1 7 6 5 8": corners backwards, then each edge's inner nodes backwards, then the nodes inside.
std::string reversed_order(int nodes, int corners, const EdgeNodes& edges) {
  std::string text;
  for (int c = corners - 1; c >= 0; --c) text += (text.empty() ? "" : " ") + number(c);
  int outside = corners;
  for (int e = 0; e < corners; ++e) {
    const auto& edge = edges[(2 * corners - 2 - e) % corners];
    for (std::size_t i = edge.size(); i > 2; --i, ++outside) text += " " + number(edge[i - 1]);
  }
  for (int i = nodes - 1; i >= outside; --i) text += " " + number(i);
  return text;
}

// Twice the signed area of the triangle at corner c of the polygon of corners.
double turn(const NodeCoordinates& x, int c, int corners) {
  const Vector2 in = x.col(c) - x.col((c + corners - 1) % corners);
  const Vector2 out = x.col((c + 1) % corners) - x.col(c);
  return in.x() * out.y() - in.y() * out.x();
}

double polygon_area(const NodeCoordinates& x, int corners) {
  double twice = 0.0;
  for (int c = 0; c < corners; ++c) {
    const int d = (c + 1) % corners;
    twice += x(0, c) * x(1, d) - x(0, d) * x(1, c);
  }
  return 0.5 * twice;
}

void reject_bad_numbers(const NodeCoordinates& x) {
  for (int i = 0; i < x.cols(); ++i)
    if (!std::isfinite(x(0, i)) || !std::isfinite(x(1, i)))
      throw ElementShapeError("a coordinate of local node " + number(i) + " is not a number");
}

void reject_coincident_nodes(const NodeCoordinates& x, double size) {
  for (int i = 0; i < x.cols(); ++i)
    for (int j = i + 1; j < x.cols(); ++j)
      if ((x.col(i) - x.col(j)).norm() <= 1e-9 * size)
        throw ElementShapeError("local nodes " + number(i) + " and " + number(j) + " are at the same place" +
                                (x.cols() == 4 ? "; a triangle needs the three-node element" : ""));
}

}  // namespace

double extent(const NodeCoordinates& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

void check_radii(const NodeCoordinates& x) {
  int i = 0;
  const double least = x.row(0).minCoeff(&i);
  if (!(least < -kRadiusTolerance * extent(x))) return;  // nor what is not a number: reject_shape says that
  throw ElementShapeError("node on negative radius: local node " + number(i) +
                          " has r = " + std::to_string(least) + "; the axis of symmetry is r = 0");
}

void reject_shape(const NodeCoordinates& x, int corners, const EdgeNodes& edges) {
  reject_bad_numbers(x);
  const double size = extent(x);
  reject_coincident_nodes(x, size);

  std::vector<int> left, right;  // corners that turn the right way (counter-clockwise) and the wrong way
  for (int c = 0; c < corners; ++c) (turn(x, c, corners) > 1e-9 * size * size ? left : right).push_back(c);
  const double area = polygon_area(x, corners);
  const bool flat = std::all_of(right.begin(), right.end(),
                                [&](int c) { return std::abs(turn(x, c, corners)) <= 1e-9 * size * size; });
  if (left.empty() && flat) throw ElementShapeError("zero area: all corners lie on one line");
  if (corners == 4 && left.size() == 2 && !flat)
    throw ElementShapeError(
        "crossed (bow-tie) nodes: two edges cut each other; corners must follow one another "
        "counter-clockwise");
  if (area < 0.0)
    throw ElementShapeError("clockwise: node order " +
                            reversed_order(static_cast<int>(x.cols()), corners, edges) + " would be right");
  if (!right.empty())
    throw ElementShapeError("re-entrant corner at local node " + number(right.front()) +
                            ": the inner angle must be less than 180 degrees");
  throw ElementShapeError(
      "mid-side nodes fold the element (detJ <= 0): keep them near the middle of their edges");
}

}  // namespace sage
