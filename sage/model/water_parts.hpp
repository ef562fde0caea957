// What the files about water share: mapping, quadrature and edges.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "sage/model/solid_edges.hpp"
#include "sage/model/water.hpp"

namespace sage::water {

// Shape functions of an element at a place of the parent shape, and what they make of its nodes.
struct Mapped {
  std::vector<double> N;
  Eigen::MatrixX2d dN_parent, dN;  // one row a node; dN: along x and y
  Matrix2 J = Matrix2::Zero();     // d(x, y) / d(parent)
  Vector2 place = Vector2::Zero();

  void take(const Element& element, const Eigen::Matrix2Xd& x, const Vector2& parent) {
    N.resize(x.cols());
    dN_parent.resize(x.cols(), 2);
    element.shape_functions(parent, N, {dN_parent.data(), static_cast<std::size_t>(dN_parent.size())});
    place = x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
    J = x * dN_parent;
  }
  double det() const { return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0); }
  void take_derivatives() {
    Matrix2 inverse;
    inverse << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0);
    dN = dN_parent * inverse / det();
  }
};

// Gauss points and weights of (-1, 1).
struct GaussRule {
  std::vector<double> x, w;
  explicit GaussRule(int n);
};

// Place on the parent shape, and the weight there.
struct RulePlace {
  Vector2 parent;
  double weight;
};
// Exact for the products that a straight-sided element of that degree has in the forces of water.
std::vector<RulePlace> rule_for(bool triangle, int degree);

// Of a solid.
std::vector<Vector2> corners_of(const Model& model, const Group& group, int element);

// 1, or 2 pi r.
double measure(const Model& model, const Vector2& place);

// An edge by its end nodes, in either order.
inline std::pair<int, int> edge_key(int a, int b) {
  return std::minmax(a, b);
}

SolidEdges edges_of_active(const Model& model, const std::vector<char>& groups);

// dy/dx of a phreatic line; 0 beyond its ends.
double slope_at(const WaterCard& card, double x);

// Part of the hydrostatic pressure at a depth below a line: all of it, or by the card cos^2 of the line's slope, as in
// seepage along a slope, whose lines of equal head stand at right angles to it.
double share_of_depth(const WaterCard& card, double x);

}  // namespace sage::water
