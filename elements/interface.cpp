#include "elements/interface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/edge_load.hpp"
#include "elements/extrapolation.hpp"
#include "elements/shape_check.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

// Pairs further apart than this times the element's size do not match.
constexpr double kPairTolerance = 1e-6;
// Smallest share of the area that row_sum may leave to a pair.
constexpr double kSmallestShare = 0.01;

std::string pair_name(int a, int b) {
  return "(" + std::to_string(a + 1) + ", " + std::to_string(b + 1) + ")";
}

// Throws with the order that would be right, or the pair that does not match.
void check_pairs(const NodeCoordinates& x, int pairs) {
  const double tolerance = kPairTolerance * extent(x);
  const auto apart = [&](int i, int j) { return (x.col(i) - x.col(j)).norm() > tolerance; };
  const std::string extra = pairs == 3 ? " 5 6" : "";
  for (int k = 0; k < pairs; ++k) {
    const int a = kBottomNodes[static_cast<std::size_t>(k)], b = kTopNodes[static_cast<std::size_t>(k)];
    if (!apart(a, b)) continue;
    if (!apart(0, 2) && !apart(1, 3))
      throw ElementShapeError(
          "interface: pairs (1, 3) and (2, 4) are together instead of (1, 4) and (2, 3): the second "
          "side must run back; node order 1 2 4 3" +
          extra + " would be right");
    if (!apart(0, 1) && !apart(2, 3))
      throw ElementShapeError(
          "interface: pairs (1, 2) and (3, 4) are together instead of (1, 4) and (2, 3): node order "
          "2 3 4 1" +
          extra + " would be right");
    throw ElementShapeError("interface: the nodes of pair " + pair_name(a, b) + " are " +
                            std::to_string((x.col(a) - x.col(b)).norm()) +
                            " apart; they must be at the same place");
  }
  if (!apart(0, 1))
    throw ElementShapeError("interface: zero length, local nodes 1 and 2 are at the same place");
}

}  // namespace

template <class Line, class Kinematics>
Interface<Line, Kinematics>::Interface(std::string_view name, InterfaceRule rule)
    : PointElement<2, kDofs, kPairs>({.name = name,
                                      .geometry = Kinematics::geometry,
                                      .nodes = 2 * kPairs,
                                      .dofs = kDofs,
                                      .points = kPairs,
                                      .law_size = 2}),
      rule_(rule) {
  std::vector<ParentPoint> gauss_at, nodal_at, nodes(2 * kPairs);
  for (std::size_t p = 0; p < kPairs; ++p) {
    const LinePoint& q = GaussLine<kPairs>::table[p];
    const double xi = Line::node_xi[p];
    const double w = newton_cotes_weight(kPairs, p);
    gauss_[p] = {Line::N(q.xi), Line::dN(q.xi), q.xi, q.w};
    nodal_[p] = {Line::N(xi), Line::dN(xi), xi, w};
    gauss_at.push_back({q.xi, 0.0});
    nodal_at.push_back({xi, 0.0});
    nodes[static_cast<std::size_t>(kBottomNodes[p])] =
        nodes[static_cast<std::size_t>(kTopNodes[p])] = {xi, 0.0};
  }
  const Basis basis = kPairs == 2 ? Basis::line_linear : Basis::line_quadratic;
  gauss_to_nodes_ = extrapolation_matrix(gauss_at, nodes, basis);
  nodal_to_nodes_ = extrapolation_matrix(nodal_at, nodes, basis);
}

// B = T N_RD, N_RD = [-N_1 -N_2 N_2 N_1], T = (1/J) [dx dy; -dy dx].               [chapter 7, Eq 7.17 to 7.23]
template <class Line, class Kinematics>
void Interface<Line, Kinematics>::geometry(const NodeCoordinates& x, std::span<double> geometry) const {
  assert(x.cols() == 2 * kPairs && static_cast<int>(geometry.size()) == this->traits().geometry_size());
  const MidLine line = mid_line(x);
  check(x);
  const bool lumped = rule_ == InterfaceRule::row_sum && !uses_gauss(line);
  const Vector<kPairs> sums = row_sums(line);
  double* block = geometry.data();
  int p = 0;
  for (const Point& point : points(line)) {
    const Vector2 d = line * point.dN;
    const double J = d.norm();
    const Matrix2 T = (Matrix2() << d.x(), d.y(), -d.y(), d.x()).finished() / J;
    *block = lumped ? sums(p) : point.w * J * Kinematics::measure(line.row(0).dot(point.N));
    Eigen::Map<Operator> Bt(block + 1);
    for (int k = 0; k < kPairs; ++k) {
      Bt.template middleRows<2>(2 * kBottomNodes[static_cast<std::size_t>(k)]) = -point.N(k) * T.transpose();
      Bt.template middleRows<2>(2 * kTopNodes[static_cast<std::size_t>(k)]) = point.N(k) * T.transpose();
    }
    block += kPointStride<2, kDofs>;
    ++p;
  }
}

template <class Line, class Kinematics>
Vector2 Interface<Line, Kinematics>::position(const NodeCoordinates& x, int point) const {
  const MidLine line = mid_line(x);
  return line * points(line)[point].N;
}

template <class Line, class Kinematics>
const std::vector<std::vector<int>>& Interface<Line, Kinematics>::edges() const {
  static const EdgeNodes edges = kPairs == 2 ? EdgeNodes{{0, 1}, {2, 3}} : EdgeNodes{{0, 1, 4}, {2, 3, 5}};
  return edges;
}

template <class Line, class Kinematics>
void Interface<Line, Kinematics>::edge_load(const NodeCoordinates& x, int edge, const Vector2& normal,
                                            const Vector2& shear, std::span<double> f) const {
  const std::vector<int>& nodes = edges().at(edge);
  MidLine ends;
  for (int i = 0; i < kPairs; ++i) ends.col(i) = x.col(nodes[i]);
  add_edge_load<Line, Kinematics>(ends, normal, shear, nodes, f);
}

template <class Line, class Kinematics>
std::span<const double> Interface<Line, Kinematics>::point_to_node(const NodeCoordinates& x) const {
  return uses_gauss(mid_line(x)) ? gauss_to_nodes_ : nodal_to_nodes_;
}

template <class Line, class Kinematics>
double Interface<Line, Kinematics>::shape_quality(const NodeCoordinates& x) const {
  const MidLine line = mid_line(x);
  const Vector2 chord = (line.col(1) - line.col(0)).normalized();
  double least = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const Points* rule : {&gauss_, &nodal_})
    for (const Point& point : *rule) {
      const double J = chord.dot(line * point.dN);
      least = std::min(least, J);
      sum += J;
    }
  return sum > 0.0 ? 2.0 * kPairs * least / sum : 0.0;
}

template <class Line, class Kinematics>
std::string Interface<Line, Kinematics>::caution(const NodeCoordinates& x) const {
  if (rule_ != InterfaceRule::newton_cotes || Kinematics::geometry != Geometry::axisymmetric) return {};
  for (std::size_t k = 0; k < 2; ++k)
    if (x(0, kBottomNodes[k]) <= kRadiusTolerance * extent(x))
      return "Newton-Cotes gives no area to the pair " + pair_name(kBottomNodes[k], kTopNodes[k]) +
             " at r = 0: nothing holds it together, and its stress is meaningless; formulation 1 (row-sum) or "
             "2 (Gauss) "
             "has no such pair";
  return {};
}

template <class Line, class Kinematics>
auto Interface<Line, Kinematics>::mid_line(const NodeCoordinates& x) -> MidLine {
  MidLine line;
  for (int k = 0; k < kPairs; ++k)
    line.col(k) = 0.5 * (x.col(kBottomNodes[static_cast<std::size_t>(k)]) +
                         x.col(kTopNodes[static_cast<std::size_t>(k)]));
  return line;
}

// integral N_i dA: L 2 pi (2 r1 + r2) / 6 and L 2 pi (r1 + 2 r2) / 6 for the linear element.
template <class Line, class Kinematics>
auto Interface<Line, Kinematics>::row_sums(const MidLine& line) -> Vector<kPairs> {
  Vector<kPairs> sums = Vector<kPairs>::Zero();
  for (const LinePoint& q : GaussLine<5>::table) {
    const Vector<kPairs> N = Line::N(q.xi);
    const double J = (line * Line::dN(q.xi)).norm();
    sums += q.w * J * Kinematics::measure(line.row(0).dot(N)) * N;
  }
  return sums;
}

template <class Line, class Kinematics>
void Interface<Line, Kinematics>::check(const NodeCoordinates& x) const {
  if (!x.allFinite()) throw ElementShapeError("interface: a coordinate is not a number");
  if (Kinematics::geometry == Geometry::axisymmetric) {
    check_radii(x);
    if (x.row(0).maxCoeff() <= kRadiusTolerance * extent(x))
      throw ElementShapeError("interface: it lies on the axis r = 0 and has no area");
  }
  check_pairs(x, kPairs);
  if (!(shape_quality(x) > kSmallestQuality))
    throw ElementShapeError("interface: the mid-side pair (5, 6) folds the element: keep it near the middle");
}

template <class Line, class Kinematics>
bool Interface<Line, Kinematics>::uses_gauss(const MidLine& line) const {
  if (rule_ == InterfaceRule::gauss) return true;
  if (rule_ == InterfaceRule::newton_cotes || kPairs == 2) return false;
  const Vector<kPairs> sums = row_sums(line);
  return sums.minCoeff() < kSmallestShare * sums.sum();
}

template class Interface<Line2, PlaneStrain>;
template class Interface<Line2, Axisymmetric>;
template class Interface<Line3, PlaneStrain>;
template class Interface<Line3, Axisymmetric>;

}  // namespace sage
