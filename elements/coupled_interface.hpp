// An interface between two bodies of soil with pore water (docs/theory/consolidation.md).  Nodes as in interface.hpp, three
// pairs; excess pressures p at the four end nodes, linear along each side.
//
//   total traction = [shear, normal](law) - [0, p], p = (p_bottom + p_top) / 2, normal tension positive
//   q = integral of C (p_bottom - p_top) dt crosses from the bottom to the top; the gap w_n fills with water from both sides:
//   f_p(bottom) = -integral N (w_n / 2 + q) dA,  f_p(top) = -integral N (w_n / 2 - q) dA
//
// C = conductance / gamma_w (second law, pore_joint): 0 tight, large open.
#pragma once

#include <array>

#include "elements/interface.hpp"

namespace sage {

inline constexpr std::array<Quantity, 1> kCrossingQuantities{{{"water_crossing", Dimension::length}}};

template <class Kinematics>
class CoupledInterface final : public Element {
  static constexpr int kU = 12, kP = 4, kDofs = kU + kP, kPoints = 3;
  using Joint = Interface<Line3, Kinematics>;
  using Operator = OperatorT<2, kU>;
  using Sides = Vector<kP>;  // of the pressures: shapes along the bottom (nodes 1, 2) and the top (4, 3)

 public:
  CoupledInterface(std::string_view name, InterfaceRule rule)
      : traits_{.name = name,
                .geometry = Kinematics::geometry,
                .nodes = 6,
                .dofs = kDofs,
                .points = kPoints,
                .law_size = 2,
                .linear = false,
                .sees_unknowns = true,
                .linear_in_step = true,
                .second_law_size = 1,
                .own_doubles = kPoints * 2,
                .history = kCrossingQuantities},
        joint_(name, rule) {}

  const ElementTraits& traits() const override { return traits_; }

  void geometry(const NodeCoordinates& x, std::span<double> out) const override {
    std::array<double, kPoints * kPointStride<2, kU>> own;
    joint_.geometry(x, own);
    for (int p = 0; p < kPoints; ++p) {
      const double* const from = own.data() + p * kPointStride<2, kU>;
      double* const to = out.data() + p * kPointStride<2, kDofs>;
      to[0] = from[0];
      Eigen::Map<OperatorT<2, kDofs>> Bt(to + 1);
      Bt.template topRows<kU>() = Eigen::Map<const Operator>(from + 1);
      Bt.template bottomRows<kP>().setZero();
      const Vector<2> N = Line2::N(joint_.parent_of(x, p));
      Eigen::Map<Vector<2>>(out.data() + shapes_of(p)) = N;
    }
  }

  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;

  Vector2 position(const NodeCoordinates& x, int point) const override { return joint_.position(x, point); }
  void body_load(const NodeCoordinates&, const Vector2&, std::span<double>) const override {}
  const std::vector<std::vector<int>>& edges() const override { return joint_.edges(); }
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    joint_.edge_load(x, edge, normal, shear, f.first(kU));
  }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return joint_.point_to_node(x);
  }
  double shape_quality(const NodeCoordinates& x) const override { return joint_.shape_quality(x); }
  std::string caution(const NodeCoordinates& x) const override { return joint_.caution(x); }

 private:
  static constexpr int shapes_of(int p) { return kPoints * kPointStride<2, kDofs> + 2 * p; }

  ElementTraits traits_;
  Joint joint_;
};

template <class Kinematics>
Outcome CoupledInterface<Kinematics>::evaluate(const ElementIn& in, ElementOut& out) const {
  const InterfaceLaw& law = *std::get<const InterfaceLaw*>(in.law);
  const std::size_t of_law = law.traits().history.size(), history = of_law + kCrossingQuantities.size();
  const Eigen::Map<const Vector<kU>> du(in.du);
  const Eigen::Map<const Sides> p0(in.u0 + kU), dp(in.du + kU);
  Vector<kU> f = Vector<kU>::Zero();
  Sides f_p = Sides::Zero();
  Eigen::Map<Matrix<kDofs>> K(out.K);
  if (out.K != nullptr) K.setZero();
  for (int p = 0; p < kPoints; ++p) {
    const double* const geometry = in.geometry + p * kPointStride<2, kDofs>;
    const double w = *geometry;
    const Operator Bt = Eigen::Map<const OperatorT<2, kDofs>>(geometry + 1).template topRows<kU>();
    const Eigen::Map<const Vector<2>> N(in.geometry + shapes_of(p));
    Sides mean, drop;
    mean << 0.5 * N[0], 0.5 * N[1], 0.5 * N[1], 0.5 * N[0];
    drop << N[0], N[1], -N[1], -N[0];
    const std::size_t h = static_cast<std::size_t>(p) * history;
    PointIn<2> point;
    PointOut<2> result;
    point.sigma0 = Vector<2>::Map(in.sigma0 + 2 * p);
    point.eps0 = Vector<2>::Map(in.eps0 + 2 * p);
    point.deps = Bt.transpose().lazyProduct(du);
    point.h0 = {in.h0 + h, of_law};
    result.h1 = {out.h1 + h, of_law};
    point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
    PointIn<1> flow;
    PointOut<1> crossing;
    flow.sigma0.setZero();
    flow.eps0.setZero();
    flow.deps[0] = drop.dot(p0 + in.theta * dp);
    if (law.update(point, result) != Outcome::ok ||
        std::get<const Law<1>*>(in.second_law)->update(flow, crossing) != Outcome::ok)
      return Outcome::cut_step;
    Vector<2>::Map(out.sigma1 + 2 * p) = result.sigma;
    Vector<2>::Map(out.eps1 + 2 * p) = point.eps0 + point.deps;
    out.status[p] = result.status;
    const double crossed = in.h0[h + of_law] + in.flow_dt * crossing.sigma[0];
    out.h1[h + of_law] = crossed;
    Vector<2> total = result.sigma;
    total[1] -= mean.dot(p0 + dp);
    f += Bt.lazyProduct(w * total);
    f_p -= w * ((point.eps0[1] + point.deps[1]) * mean + crossed * drop);
    if (out.K == nullptr) continue;
    const Eigen::Matrix<double, kU, kP> Q = (w * Bt.col(1)).lazyProduct(mean.transpose());
    const double slope = w * in.flow_dt * in.theta * crossing.D(0, 0);
    K.template topLeftCorner<kU, kU>() += (w * Bt).lazyProduct(result.D).lazyProduct(Bt.transpose());
    K.template topRightCorner<kU, kP>() -= Q;
    K.template bottomLeftCorner<kP, kU>() -= Q.transpose();
    K.template bottomRightCorner<kP, kP>() -= slope * drop.lazyProduct(drop.transpose());
  }
  Eigen::Map<Vector<kU>>(out.f) = f;
  Eigen::Map<Sides>(out.f + kU) = f_p;
  return Outcome::ok;
}

}  // namespace sage
