#include "elements/bar.hpp"

#include <string>

#include "elements/extrapolation.hpp"

namespace sage {

template <class Line, class Kinematics>
Bar<Line, Kinematics>::Bar(std::string_view name)
    : PointElement<1, 2 * kNodes, kPoints>({.name = name,
                                            .geometry = Kinematics::geometry,
                                            .nodes = kNodes,
                                            .dofs = 2 * kNodes,
                                            .points = kPoints,
                                            .degree = Line::nodes - 1,
                                            .law_size = 1}) {
  if (kPoints == 1) {
    to_nodes_.assign(2, 1.0);
    return;
  }
  std::vector<ParentPoint> points, nodes;
  for (const LinePoint& q : GaussLine<kPoints>::table) points.push_back({q.xi, 0.0});
  for (const double xi : Line::node_xi) nodes.push_back({xi, 0.0});
  to_nodes_ = extrapolation_matrix(points, nodes, Basis::line_linear);
}

template <class Line, class Kinematics>
void Bar<Line, Kinematics>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  check_line<Line, Kinematics>(x, "bar");
  double* block = out.data();
  for (const LinePoint& q : GaussLine<kPoints>::table) {
    const Nodes nodes = x;
    const Vector<kNodes> dN = Line::dN(q.xi);
    const LineFrame frame(nodes * dN);
    *block = q.w * frame.J * Kinematics::measure(nodes.row(0).dot(Line::N(q.xi)));
    Eigen::Map<OperatorT<1, 2 * kNodes>> Bt(block + 1);
    for (int i = 0; i < kNodes; ++i) Bt.template segment<2>(2 * i) = dN(i) / frame.J * frame.t;
    block += kPointStride<1, 2 * kNodes>;
  }
}

template <class Line, class Kinematics>
void Bar<Line, Kinematics>::body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const {
  const Nodes nodes = x;
  for (const LinePoint& q : GaussLine<5>::table) {
    const Vector<kNodes> N = Line::N(q.xi);
    const double w = q.w * (nodes * Line::dN(q.xi)).norm() * Kinematics::measure(nodes.row(0).dot(N));
    for (std::size_t i = 0; i < kNodes; ++i)
      for (std::size_t c = 0; c < 2; ++c)
        f[2 * i + c] += w * N(static_cast<Eigen::Index>(i)) * b(static_cast<Eigen::Index>(c));
  }
}

template <class Line, class Kinematics>
const std::vector<std::vector<int>>& Bar<Line, Kinematics>::edges() const {
  static const EdgeNodes edges = kNodes == 2 ? EdgeNodes{{0, 1}} : EdgeNodes{{0, 1, 2}};
  return edges;
}

template <class Line, class Kinematics>
void Bar<Line, Kinematics>::edge_load(const NodeCoordinates& x, int edge, const Vector2& normal,
                                      const Vector2& shear, std::span<double> f) const {
  add_edge_load<Line, Kinematics>(Nodes(x), normal, shear, edges().at(edge), f);
}

template class Bar<Line2, PlaneStrain>;
template class Bar<Line2, Axisymmetric>;
template class Bar<Line3, PlaneStrain>;
template class Bar<Line3, Axisymmetric>;

template <class Kinematics>
void Spring<Kinematics>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  check_line<Line2, Kinematics>(x, "spring");
  const LineFrame frame(x.col(1) - x.col(0));
  const std::array<double, 5> all{Kinematics::measure(0.5 * (x(0, 0) + x(0, 1))), -frame.t.x(), -frame.t.y(),
                                  frame.t.x(), frame.t.y()};
  std::copy(all.begin(), all.end(), out.begin());
}

template class Spring<PlaneStrain>;
template class Spring<Axisymmetric>;

void Ring::geometry(const NodeCoordinates& x, std::span<double> out) const {
  if (!x.allFinite()) throw ElementShapeError("ring: a coordinate is not a number");
  const double r = x(0, 0);
  if (!(r > 0.0))
    throw ElementShapeError("ring: its node has the radius " + std::to_string(r) +
                            "; a ring needs one above 0");
  const std::array<double, 3> all{Axisymmetric::measure(r), 1.0 / r, 0.0};
  std::copy(all.begin(), all.end(), out.begin());
}

void Ring::body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const {
  for (std::size_t c = 0; c < 2; ++c) f[c] += Axisymmetric::measure(x(0, 0)) * b(static_cast<Eigen::Index>(c));
}

}  // namespace sage
