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
MovingLine<Contact<Line, Kinematics>::kNodes> Contact<Line, Kinematics>::parts_at(const LinePoint& at) {
  MovingLine<kNodes> parts;
  parts.place.template head<kEdge>() = Line::N(at.xi);
  parts.tangent.template head<kEdge>() = Line::dN(at.xi);
  parts.point = parts.place;
  parts.point(kEdge) = parts.line(kEdge) = -1.0;
  parts.line(kEdge + 1) = 1.0;
  parts.w = at.w;
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
    parts_[p] = parts_at(at);
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
    const Place place(parts_[p], x, Place::Coordinates::Zero());
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
  const auto add = [&](std::size_t p, const Place& before, const Place& now, SlipForces<kNodes>& sums) {
    return add_point(p, in, out, before, now, sums);
  };
  return sum_over_points<kNodes, Kinematics>(parts_, in, out, add);
}

template <class Line, class Kinematics>
Outcome Contact<Line, Kinematics>::add_point(std::size_t p, const ElementIn& in, ElementOut& out,
                                             const Place& before, const Place& now,
                                             SlipForces<kNodes>& sums) const {
  if (!touches(now)) {
    leave_open(p, in, out, now.gap);
    return Outcome::ok;
  }
  const bool held = touches(before);
  PointOut<2> answer;
  const Outcome outcome =
      held ? update_point(p, in, out, Vector2::Map(in.sigma0 + 2 * p), {in.eps0[2 * p], before.gap},
                          {now.slid - before.slid, now.gap - before.gap}, answer)
           : update_point(p, in, out, Vector2::Zero(), Vector2::Zero(), {0.0, now.gap}, answer);
  if (outcome != Outcome::ok) return outcome;
  if (!held) answer.D.col(0).setZero();  // no slip in the step that makes contact
  now.add(answer.sigma, answer.D, out.K != nullptr, sums);
  return Outcome::ok;
}

// Without traction, and with the law's first history.
template <class Line, class Kinematics>
void Contact<Line, Kinematics>::leave_open(std::size_t p, const ElementIn& in, ElementOut& out, double gap) {
  const std::span<const Quantity> history = std::get<const InterfaceLaw*>(in.law)->traits().history;
  Vector2::Map(out.sigma1 + 2 * p).setZero();
  Vector2::Map(out.eps1 + 2 * p) << 0.0, gap;
  for (std::size_t i = 0; i < history.size(); ++i) out.h1[p * history.size() + i] = history[i].initial;
  out.status[p] = PointStatus::open;
}

template class Contact<Line2, PlaneStrain>;
template class Contact<Line2, Axisymmetric>;
template class Contact<Line3, PlaneStrain>;
template class Contact<Line3, Axisymmetric>;

}  // namespace sage
