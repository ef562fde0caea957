// Zero-thickness interface (Goodman, Taylor & Brekke 1968; isoparametric after Beer 1985),
// docs/theory/elements.md. Nodes: 1 2 along one side, 3 4 back along the other; pairs (1,4) (2,3). Quadratic: 5
// between 1 and 2, 6 between 3 and 4; pair (5,6). w = T (u_top - u_bottom) = [shear, normal]; top = side of 3
// and 4; normal > 0 opens.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "elements/kinematics.hpp"
#include "elements/point_kernel.hpp"
#include "elements/shapes.hpp"

namespace sage {

// Local nodes of each pair of an interface.
inline constexpr std::array<int, 3> kBottomNodes{0, 1, 4}, kTopNodes{3, 2, 5};

// Trapezoid 1 1, Simpson 1/3 1/3 4/3 (the middle is the last pair).
constexpr double newton_cotes_weight(int pairs, std::size_t pair) {
  if (pairs == 2) return 1.0;
  return pair == 2 ? 4.0 / 3.0 : 1.0 / 3.0;
}

// row_sum: points at the pairs, weight = integral N_i dA with r inside.  No pair acts on another, and no pair
// of a
//   linear element has zero weight.  Where a pair would get less than 1/100 of the area (a quadratic element at
//   r = 0), the element uses Gauss.
// gauss: 2 or 3 points.
// newton_cotes: points at the pairs, trapezoid or Simpson, r of the point.  A pair at r = 0 has no weight.
enum class InterfaceRule { row_sum, gauss, newton_cotes };

template <class Line, class Kinematics>
class Interface final : public PointElement<2, 4 * Line::nodes, Line::nodes> {
  static constexpr int kPairs = Line::nodes;
  static constexpr int kDofs = 4 * kPairs;
  using MidLine = Eigen::Matrix<double, 2, kPairs>;  // one column a pair
  using Operator = OperatorT<2, kDofs>;

  // N and dN/dxi of the pairs at a point, and the weight of the rule.
  struct Point {
    Vector<kPairs> N, dN;
    double xi, w;
  };
  using Points = std::array<Point, kPairs>;

 public:
  Interface(std::string_view name, InterfaceRule rule);

  void geometry(const NodeCoordinates& x, std::span<double> geometry) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override;

  // No volume, no load.
  void body_load(const NodeCoordinates&, const Vector2&, std::span<double>) const override {}

  // The two sides: {1, 2[, 5]} and {3, 4[, 6]}.
  const std::vector<std::vector<int>>& edges() const override;
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override;

  std::span<const double> point_to_node(const NodeCoordinates& x) const override;

  // Smallest over mean J = |dx/dxi| at the points and ends.
  double shape_quality(const NodeCoordinates& x) const override;

  std::string caution(const NodeCoordinates& x) const override;

  // Coordinate of a point along the element, -1 to 1.
  double parent_of(const NodeCoordinates& x, int point) const { return points(mid_line(x))[point].xi; }

 private:
  static MidLine mid_line(const NodeCoordinates& x);
  static Vector<kPairs> row_sums(const MidLine& line);
  void check(const NodeCoordinates& x) const;
  bool uses_gauss(const MidLine& line) const;
  const Points& points(const MidLine& line) const { return uses_gauss(line) ? gauss_ : nodal_; }

  InterfaceRule rule_;
  Points gauss_, nodal_;
  std::vector<double> gauss_to_nodes_, nodal_to_nodes_;
};

}  // namespace sage
