// A point and a line that both move with nodes: slip along the line and gap to its left, their derivatives, and the forces that
// a law of interfaces makes of them (docs/theory/large_strain.md).
#pragma once

#include <array>
#include <variant>

#include "elements/kinematics.hpp"
#include "elements/shapes.hpp"

namespace sage {

// What the nodes' places are multiplied by, and the weight of the rule.
template <int Nodes>
struct MovingLine {
  Vector<Nodes> point = Vector<Nodes>::Zero();    // the point less the start of the line
  Vector<Nodes> line = Vector<Nodes>::Zero();     // the line's vector
  Vector<Nodes> tangent = Vector<Nodes>::Zero();  // dx/dxi along the surface that the tractions act on
  Vector<Nodes> place = Vector<Nodes>::Zero();    // where they act
  double w = 0.0;
};

// Sums over the points of an element.
template <int Nodes>
struct SlipForces {
  Vector<2 * Nodes> f = Vector<2 * Nodes>::Zero();
  Matrix<2 * Nodes> K = Matrix<2 * Nodes>::Zero();
};

// With the nodes displaced by u.  What changes is computed of displacements, so that small ones keep their digits beside a penalty.
template <int Nodes, class Kinematics>
class SlipPoint {
 public:
  static constexpr int kDofs = 2 * Nodes;
  using Coordinates = Eigen::Matrix<double, 2, Nodes>;
  using Dofs = Vector<kDofs>;

  SlipPoint(const MovingLine<Nodes>& parts, const Coordinates& mesh, const Coordinates& u) : parts_(&parts) {
    const Vector2 line0 = mesh * parts.line, turn_by = u * parts.line;
    const double length0 = line0.norm();
    length_ = (line0 + turn_by).norm();
    const Vector2 t0 = line0 / length0, n0 = left_of(t0);
    const Vector2 turn =
        (turn_by - t0 * ((2.0 * line0 + turn_by).dot(turn_by) / (length_ + length0))) / length_;
    t_ = t0 + turn;
    n_ = left_of(t_);
    const Vector2 d0 = mesh * parts.point, moved = u * parts.point, d = d0 + moved;
    slid = t0.dot(moved) + turn.dot(d);
    gap = n0.dot(d0) + (n0.dot(moved) + left_of(turn).dot(d));
    share = (t0.dot(d0) + slid) / length_;
    tangent_ = (mesh + u) * parts.tangent;
    J = tangent_.norm();
    radius_ = ((mesh + u) * parts.place).x();
    weight = parts.w * J * Kinematics::measure(radius_);
  }

  double slid = 0.0;   // along the line, since the mesh
  double gap = 0.0;    // > 0: to the left of the line
  double share = 0.0;  // place along the line, over its length
  double J = 0.0, weight = 0.0;

  // Derivatives by the displacements.
  Dofs of_slip() const { return along(parts_->point, t_) + gap / length_ * along(parts_->line, n_); }
  Dofs of_gap() const { return along(parts_->point, n_) - share * along(parts_->line, n_); }

  // Tractions [shear, normal] and their derivatives by slip and gap.
  void add(const Vector2& sigma, const Matrix2& D, bool with_K, SlipForces<Nodes>& sums) const {
    const Dofs slip = of_slip(), opening = of_gap();
    const Dofs force = sigma[0] * slip + sigma[1] * opening;
    sums.f += weight * force;
    if (!with_K) return;
    sums.K += weight * (slip * (D(0, 0) * slip + D(0, 1) * opening).transpose() +
                        opening * (D(1, 0) * slip + D(1, 1) * opening).transpose() + curvature(sigma));
    sums.K += force * of_weight().transpose();
  }

 private:
  static Vector2 left_of(const Vector2& direction) { return {-direction.y(), direction.x()}; }
  static Dofs along(const Vector<Nodes>& coefficients, const Vector2& direction) {
    Dofs row;
    for (int i = 0; i < Nodes; ++i) row.template segment<2>(2 * i) = coefficients(i) * direction;
    return row;
  }
  Dofs of_weight() const {
    Dofs row = parts_->w * Kinematics::measure(radius_) / J * along(parts_->tangent, tangent_);
    if (Kinematics::geometry == Geometry::axisymmetric)
      for (int i = 0; i < Nodes; ++i) row(2 * i) += parts_->w * J * 2.0 * kPi * parts_->place(i);
    return row;
  }
  // Second derivatives of slip and gap, times the tractions.
  Matrix<kDofs> curvature(const Vector2& sigma) const {
    const Dofs across = along(parts_->line, n_), stretch = along(parts_->line, t_),
               off = along(parts_->point, n_), slide = along(parts_->point, t_) - share * stretch;
    const double tilt = gap / length_;
    const Matrix<kDofs> of_gap =
        across * slide.transpose() + slide * across.transpose() + tilt * across * across.transpose();
    const Matrix<kDofs> of_slip = across * off.transpose() + off * across.transpose() -
                                  share * across * across.transpose() -
                                  tilt * (stretch * across.transpose() + across * stretch.transpose());
    return (sigma[0] * of_slip - sigma[1] * of_gap) / length_;
  }

  const MovingLine<Nodes>* parts_;
  double length_ = 0.0, radius_ = 0.0;
  Vector2 t_, n_, tangent_;
};

// Sums over the points of an element.  add(p, before, now, sums) adds those of one, at the committed places of its nodes and at
// those of the step, and returns what its law returned.
template <int Nodes, class Kinematics, std::size_t Points, class Add>
Outcome sum_over_points(const std::array<MovingLine<Nodes>, Points>& parts, const ElementIn& in,
                        ElementOut& out, const Add& add) {
  using Place = SlipPoint<Nodes, Kinematics>;
  using Coordinates = typename Place::Coordinates;
  const Coordinates mesh = Coordinates::Map(in.x), before = Coordinates::Map(in.u0);
  const Coordinates now = before + Coordinates::Map(in.du);
  SlipForces<Nodes> sums;
  for (std::size_t p = 0; p < Points; ++p) {
    const Outcome outcome = add(p, Place(parts[p], mesh, before), Place(parts[p], mesh, now), sums);
    if (outcome != Outcome::ok) return outcome;
  }
  Vector<2 * Nodes>::Map(out.f) = sums.f;
  if (out.K != nullptr) Matrix<2 * Nodes>::Map(out.K) = sums.K;
  return Outcome::ok;
}

// Calls the element's law at point p for an increment of slip and gap, from this stress and strain, and writes the state.
inline Outcome update_point(std::size_t p, const ElementIn& in, ElementOut& out, const Vector2& sigma0,
                            const Vector2& eps0, const Vector2& deps, PointOut<2>& answer) {
  const InterfaceLaw& law = *std::get<const InterfaceLaw*>(in.law);
  const std::size_t history = law.traits().history.size();
  PointIn<2> point;
  point.sigma0 = sigma0;
  point.eps0 = eps0;
  point.deps = deps;
  point.h0 = {in.h0 + p * history, history};
  point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
  answer.h1 = {out.h1 + p * history, history};
  const Outcome outcome = law.update(point, answer);
  if (outcome != Outcome::ok) return outcome;
  Vector2::Map(out.sigma1 + 2 * p) = answer.sigma;
  Vector2::Map(out.eps1 + 2 * p) = eps0 + deps;
  out.status[p] = answer.status;
  return Outcome::ok;
}

}  // namespace sage
