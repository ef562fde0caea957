#include "elements/large_interface.hpp"

#include "sage/math/quadrature.hpp"

namespace sage {

namespace {

// Tractions act on the middle line, which the slip is measured along.
template <class Line>
MovingLine<2 * Line::nodes> parts_at(double xi) {
  MovingLine<2 * Line::nodes> parts;
  const auto N = Line::N(xi), dN = Line::dN(xi);
  for (int k = 0; k < Line::nodes; ++k) {
    const int bottom = kBottomNodes[static_cast<std::size_t>(k)], top = kTopNodes[static_cast<std::size_t>(k)];
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
    parts_[p].w = gauss ? at.w : newton_cotes_weight(kPairs, p);
  }
}

template <class Line, class Kinematics>
Outcome LargeInterface<Line, Kinematics>::evaluate(const ElementIn& in, ElementOut& out) const {
  using Place = SlipPoint<kNodes, Kinematics>;
  const auto add = [&](std::size_t p, const Place& before, const Place& now, SlipForces<kNodes>& sums) {
    const Vector2 sigma0 = Vector2::Map(in.sigma0 + 2 * p), eps0 = Vector2::Map(in.eps0 + 2 * p);
    PointOut<2> answer;
    const Outcome outcome =
        update_point(p, in, out, sigma0, eps0, {now.slid - before.slid, now.gap - before.gap}, answer);
    if (outcome == Outcome::ok) now.add(answer.sigma, answer.D, out.K != nullptr, sums);
    return outcome;
  };
  return sum_over_points<kNodes, Kinematics>(parts_, in, out, add);
}

template class LargeInterface<Line2, PlaneStrain>;
template class LargeInterface<Line2, Axisymmetric>;
template class LargeInterface<Line3, PlaneStrain>;
template class LargeInterface<Line3, Axisymmetric>;

}  // namespace sage
