#include "elements/contact.hpp"

#include <algorithm>
#include <variant>

#include "elements/extrapolation.hpp"
#include "elements/shape_check.hpp"
#include "sage/math/quadrature.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

// Of the size of the element: an edge in the mesh may lie that far beyond the line.
constexpr double kBeyond = 1e-6;

}  // namespace

template <class Line, class Kinematics>
MovingLine<Contact<Line, Kinematics>::kNodes> Contact<Line, Kinematics>::parts_at(double xi) {
  MovingLine<kNodes> parts;
  parts.place.template head<kEdge>() = Line::N(xi);
  parts.tangent.template head<kEdge>() = Line::dN(xi);
  parts.point = parts.place;
  parts.point(kEdge) = parts.line(kEdge) = -1.0;
  parts.line(kEdge + 1) = 1.0;
  return parts;
}

template <class Line, class Kinematics>
Contact<Line, Kinematics>::Contact(std::string_view name)
    : traits_{.name = name,
              .geometry = Kinematics::geometry,
              .nodes = kNodes,
              .dofs = kDofs,
              .points = kPoints,
              .degree = kEdge - 1,
              .law_size = 2,
              .symmetric = false,
              .linear = false,
              .sees_unknowns = true,
              .sees_coordinates = true} {
  std::vector<ParentPoint> points, nodes;
  for (std::size_t p = 0; p < kPoints; ++p) {
    const LinePoint& at = GaussLine<kPoints>::table[p];
    points.push_back({at.xi, 0.0});
    parts_[p] = parts_at(at.xi);
  }
  for (const double xi : Line::node_xi) nodes.push_back({xi, 0.0});
  to_nodes_ = extrapolation_matrix(points, nodes, kEdge == 2 ? Basis::line_linear : Basis::line_quadratic);
  to_nodes_.insert(to_nodes_.end(), 2 * kPoints, 1.0 / kPoints);
}

template <class Line, class Kinematics>
void Contact<Line, Kinematics>::geometry(const NodeCoordinates& x, std::span<double> out) const {
  if (!x.allFinite()) throw ElementShapeError("contact: a coordinate is not a number");
  const double size = extent(x.leftCols(kEdge));
  if (Kinematics::geometry == Geometry::axisymmetric) check_radii(x);
  if (!(size > 0.0) || !((x.col(kEdge + 1) - x.col(kEdge)).norm() > 1e-12 * size))
    throw ElementShapeError("contact: the edge or the line has no length");
  double* block = out.data();
  for (std::size_t p = 0; p < kPoints; ++p) {
    const Place place(parts_[p], x, Coordinates::Zero(), GaussLine<kPoints>::table[p].w);
    if (!(place.J > 0.0)) throw ElementShapeError("contact: the middle node folds the edge");
    if (place.gap < -kBeyond * size && is_beside(place))
      throw ElementShapeError(
          "contact: the edge lies beyond the line, by " + std::to_string(-place.gap) +
          "; the body must be to the left of the way from the line's first node to its second: "
          "exchange the two");
    *block = place.weight;
    Eigen::Map<Eigen::Matrix<double, kDofs, 2>> Bt(block + 1);
    Bt.col(0) = place.of_slip();
    Bt.col(1) = place.of_gap();
    block += 1 + 2 * kDofs;
  }
}

template <class Line, class Kinematics>
Vector2 Contact<Line, Kinematics>::position(const NodeCoordinates& x, int point) const {
  return x.leftCols(kEdge) * Line::N(GaussLine<kPoints>::table[point].xi);
}

template <class Line, class Kinematics>
Outcome Contact<Line, Kinematics>::evaluate(const ElementIn& in, ElementOut& out) const {
  const Coordinates mesh = Coordinates::Map(in.x), before = Coordinates::Map(in.u0);
  const Coordinates now = before + Coordinates::Map(in.du);
  SlipForces<kNodes> sums;
  for (std::size_t p = 0; p < kPoints; ++p) {
    const double w = GaussLine<kPoints>::table[p].w;
    const Outcome outcome =
        add_point(p, in, out, Place(parts_[p], mesh, before, w), Place(parts_[p], mesh, now, w), sums);
    if (outcome != Outcome::ok) return outcome;
  }
  Dofs::Map(out.f) = sums.f;
  if (out.K != nullptr) Matrix<kDofs>::Map(out.K) = sums.K;
  return Outcome::ok;
}

template <class Line, class Kinematics>
Outcome Contact<Line, Kinematics>::add_point(std::size_t p, const ElementIn& in, ElementOut& out,
                                             const Place& before, const Place& now,
                                             SlipForces<kNodes>& sums) const {
  const InterfaceLaw& law = *std::get<const InterfaceLaw*>(in.law);
  const std::span<const Quantity> history = law.traits().history;
  const std::span<double> h1{out.h1 + p * history.size(), history.size()};
  Eigen::Map<Vector2> sigma1(out.sigma1 + 2 * p), eps1(out.eps1 + 2 * p);
  if (!touches(now)) {
    sigma1.setZero();
    eps1 << 0.0, now.gap;
    for (std::size_t i = 0; i < h1.size(); ++i) h1[i] = history[i].initial;
    out.status[p] = PointStatus::open;
    return Outcome::ok;
  }
  const bool held = touches(before);
  PointIn<2> point;
  point.sigma0 = held ? Vector2(Vector2::Map(in.sigma0 + 2 * p)) : Vector2(Vector2::Zero());
  point.eps0 = held ? Vector2(in.eps0[2 * p], before.gap) : Vector2(Vector2::Zero());
  point.deps = held ? Vector2(now.slid - before.slid, now.gap - before.gap) : Vector2(0.0, now.gap);
  point.h0 = {in.h0 + p * history.size(), history.size()};
  point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
  PointOut<2> answer;
  answer.h1 = h1;
  const Outcome outcome = law.update(point, answer);
  if (outcome != Outcome::ok) return outcome;
  sigma1 = answer.sigma;
  eps1 = point.eps0 + point.deps;
  out.status[p] = answer.status;
  Matrix2 D = answer.D;
  if (!held) D.col(0).setZero();  // no slip in the step that makes contact
  now.add(answer.sigma, D, out.K != nullptr, sums);
  return Outcome::ok;
}

template class Contact<Line2, PlaneStrain>;
template class Contact<Line2, Axisymmetric>;
template class Contact<Line3, PlaneStrain>;
template class Contact<Line3, Axisymmetric>;

}  // namespace sage
