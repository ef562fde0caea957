#include "elements/large_interface.hpp"

#include <variant>

#include "sage/math/quadrature.hpp"

namespace sage {

namespace {

// Local nodes of each pair.
constexpr std::array<int, 3> kBottom{0, 1, 4};
constexpr std::array<int, 3> kTop{3, 2, 5};

// Tractions act on the middle line, which the slip is measured along.
template <class Line>
MovingLine<2 * Line::nodes> parts_at(double xi) {
  MovingLine<2 * Line::nodes> parts;
  const auto N = Line::N(xi), dN = Line::dN(xi);
  for (int k = 0; k < Line::nodes; ++k) {
    const int bottom = kBottom[static_cast<std::size_t>(k)], top = kTop[static_cast<std::size_t>(k)];
    parts.point(bottom) = -N(k);
    parts.point(top) = N(k);
    parts.place(bottom) = parts.place(top) = 0.5 * N(k);
    parts.line(bottom) = parts.line(top) = 0.5 * dN(k);
  }
  parts.tangent = parts.line;
  return parts;
}

}  // namespace

template <class Line, class Kinematics>
LargeInterface<Line, Kinematics>::LargeInterface(std::string_view name, InterfaceRule rule)
    : small_(name, rule),
      traits_{.name = name,
              .geometry = Kinematics::geometry,
              .nodes = kNodes,
              .dofs = kDofs,
              .points = kPairs,
              .degree = small_.traits().degree,
              .law_size = 2,
              .symmetric = false,
              .linear = false,
              .sees_unknowns = true,
              .sees_coordinates = true} {
  for (std::size_t p = 0; p < kPairs; ++p) {
    const bool gauss = rule == InterfaceRule::gauss;
    const LinePoint& at = GaussLine<kPairs>::table[p];
    parts_[p] = parts_at<Line>(gauss ? at.xi : Line::node_xi[p]);
    // Trapezoid 1 1, Simpson 1/3 1/3 4/3 (the middle is the last pair).
    weights_[p] = gauss ? at.w : kPairs == 2 ? 1.0 : p == 2 ? 4.0 / 3.0 : 1.0 / 3.0;
  }
}

template <class Line, class Kinematics>
Outcome LargeInterface<Line, Kinematics>::evaluate(const ElementIn& in, ElementOut& out) const {
  const Coordinates mesh = Coordinates::Map(in.x), before = Coordinates::Map(in.u0);
  const Coordinates now = before + Coordinates::Map(in.du);
  SlipForces<kNodes> sums;
  for (std::size_t p = 0; p < kPairs; ++p) {
    const Outcome outcome = add_point(p, in, out, Place(parts_[p], mesh, before, weights_[p]),
                                      Place(parts_[p], mesh, now, weights_[p]), sums);
    if (outcome != Outcome::ok) return outcome;
  }
  Dofs::Map(out.f) = sums.f;
  if (out.K != nullptr) Matrix<kDofs>::Map(out.K) = sums.K;
  return Outcome::ok;
}

template <class Line, class Kinematics>
Outcome LargeInterface<Line, Kinematics>::add_point(std::size_t p, const ElementIn& in, ElementOut& out,
                                                    const Place& before, const Place& now,
                                                    SlipForces<kNodes>& sums) const {
  const InterfaceLaw& law = *std::get<const InterfaceLaw*>(in.law);
  const std::size_t history = law.traits().history.size();
  PointIn<2> point;
  point.sigma0 = Vector2::Map(in.sigma0 + 2 * p);
  point.eps0 = Vector2::Map(in.eps0 + 2 * p);
  point.deps = Vector2(now.slid - before.slid, now.gap - before.gap);
  point.h0 = {in.h0 + p * history, history};
  point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
  PointOut<2> answer;
  answer.h1 = {out.h1 + p * history, history};
  const Outcome outcome = law.update(point, answer);
  if (outcome != Outcome::ok) return outcome;
  Vector2::Map(out.sigma1 + 2 * p) = answer.sigma;
  Vector2::Map(out.eps1 + 2 * p) = point.eps0 + point.deps;
  out.status[p] = answer.status;
  now.add(answer.sigma, answer.D, out.K != nullptr, sums);
  return Outcome::ok;
}

template class LargeInterface<Line2, PlaneStrain>;
template class LargeInterface<Line2, Axisymmetric>;
template class LargeInterface<Line3, PlaneStrain>;
template class LargeInterface<Line3, Axisymmetric>;

}  // namespace sage
