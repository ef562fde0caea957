// Soil and the water in its pores (Biot 1941): displacements of a solid, and the excess pore pressure p of its corners.
//
//   div(sigma' - p 1) + b = 0     sigma' = skeleton(eps)              law of the group
//   d(zeta)/dt + div v = 0        zeta = eps_v + S p, v = -k grad p   second law of the group
//
// p is compression positive, eps tension positive; zeta is the water that a volume of soil has taken up, and W = integral
// of v dt.  Both are kept at every point, so that the equation of a pressure is a balance of volumes since the beginning:
//
//   f_u = sum w B^T (sigma' - m p),   f_p = -sum w (N zeta - grad N . W) = what has left at the node
//
// With the theta method W1 = W0 - dt k grad((1 - theta) p0 + theta p1).  K is symmetric where the skeleton's D is; in a
// time of 0 no water moves, which is the undrained state without any small number.  docs/theory/consolidation.md
#pragma once

#include <array>

#include "elements/solid.hpp"

namespace sage {

// What a point of them remembers, behind the history of its law.
inline constexpr std::array<Quantity, 4> kPoreQuantities{{{"excess_pore_pressure", Dimension::stress},
                                                          {"water_content_change"},
                                                          {"water_displacement_x", Dimension::length},
                                                          {"water_displacement_y", Dimension::length}}};

// Pressure: the shape of the pressures, whose nodes are the first of Shape's.  It is one degree lower, so that the pair
// satisfies the inf-sup condition.
template <class Shape, class Pressure, class Kinematics, class Rule>
class Coupled final : public Element {
  static constexpr int kU = 2 * Shape::nodes, kP = Pressure::nodes, kDofs = kU + kP;
  static constexpr int kPoints = static_cast<int>(Rule::points);
  static constexpr int kStride = kPointStride<4, kDofs>, kSolidStride = kPointStride<4, kU>;
  using Solids = Solid<Shape, Kinematics, Rule>;
  using PressureRows = Eigen::Matrix<double, 3, kP>;  // N,x N,y N of a point

 public:
  Coupled(std::string_view name, bool reduced, bool locks, bool loses_order)
      : traits_{.name = name,
                .geometry = Kinematics::geometry,
                .nodes = Shape::nodes,
                .dofs = kDofs,
                .points = kPoints,
                .degree = Shape::degree,
                .law_size = 4,
                .reduced = reduced,
                .locks = locks,
                .linear = false,
                .sees_unknowns = true,
                .linear_in_step = true,
                .second_law_size = 3,
                .loses_order = loses_order,
                .own_doubles = kPoints * 3 * kP,
                .history = kPoreQuantities,
                .pressure_history = 0},
        solid_(name, reduced, locks, loses_order) {}

  const ElementTraits& traits() const override { return traits_; }

  // B^T of a point has rows of zeros for the pressures.
  void geometry(const NodeCoordinates& x, std::span<double> out) const override {
    std::array<double, kPoints * kSolidStride> own;
    solid_.geometry(x, own);
    for (int p = 0; p < kPoints; ++p) {
      const double* const from = own.data() + p * kSolidStride;
      double* const to = out.data() + p * kStride;
      to[0] = from[0];
      Eigen::Map<OperatorT<4, kDofs>> Bt(to + 1);
      Bt.template topRows<kU>() = Eigen::Map<const OperatorT<4, kU>>(from + 1);
      Bt.template bottomRows<kP>().setZero();
      Eigen::Map<PressureRows>(out.data() + rows_of(p)) = rows_at(x, Rule::table[p]);
    }
  }

  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;

  Vector2 position(const NodeCoordinates& x, int point) const override { return solid_.position(x, point); }
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override {
    solid_.body_load(x, b, f.first(kU));
  }
  const std::vector<std::vector<int>>& edges() const override { return solid_.edges(); }
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    solid_.edge_load(x, edge, normal, shear, f.first(kU));
  }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return solid_.point_to_node(x);
  }
  std::span<const double> point_to_sample() const override { return solid_.point_to_sample(); }
  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    return solid_.shape_functions(parent, N, dN);
  }
  double shape_quality(const NodeCoordinates& x) const override { return solid_.shape_quality(x); }

 private:
  // Water at a point: what flows in the step, and what its tangent is per pressure of a node.
  struct Water {
    double pressure, content, displaced_x, displaced_y;
    PressureRows slope;  // of [displaced_x, displaced_y, content]
  };

  // Behind the points.
  static constexpr int rows_of(int p) { return kPoints * kStride + p * 3 * kP; }
  static PressureRows rows_at(const NodeCoordinates& nodes, const RulePoint& q) {
    const ParentPoint at{q.xi, q.eta};
    const Eigen::Matrix<double, 2, Shape::nodes> x = nodes;
    const Matrix2 J = x.lazyProduct(Shape::dN(at));
    const Matrix2 inverse = (Matrix2() << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0)).finished() / determinant(J);
    PressureRows rows;
    rows.template topRows<2>() = Pressure::dN(at).lazyProduct(inverse).transpose();
    rows.row(2) = Pressure::N(at).transpose();
    return rows;
  }
  static Outcome flow(const ElementIn& in, const PressureRows& rows, const double* h0, double volume,
                      bool wants_slope, Water& water);

  ElementTraits traits_;
  Solids solid_;
};

// volume: change of eps_v in the step.
template <class Shape, class Pressure, class Kinematics, class Rule>
Outcome Coupled<Shape, Pressure, Kinematics, Rule>::flow(const ElementIn& in, const PressureRows& rows,
                                                         const double* h0, double volume, bool wants_slope,
                                                         Water& water) {
  const Eigen::Map<const Vector<kP>> p0(in.u0 + kU), dp(in.du + kU);
  const double dt = in.flow_dt, theta = in.theta;
  PointIn<3> point;
  point.sigma0.setZero();
  point.eps0.setZero();
  point.deps.template head<2>() = rows.template topRows<2>().lazyProduct(p0 + theta * dp);
  point.deps[2] = rows.row(2).dot(dp);
  PointOut<3> result;
  if (std::get<const Law<3>*>(in.second_law)->update(point, result) != Outcome::ok) return Outcome::cut_step;
  water.pressure = rows.row(2).dot(p0 + dp);
  water.displaced_x = h0[2] - dt * result.sigma[0];
  water.displaced_y = h0[3] - dt * result.sigma[1];
  water.content = h0[1] + volume + result.sigma[2];
  if (wants_slope) {
    PressureRows changes = rows;
    changes.template topRows<2>() *= theta;
    water.slope = result.D.lazyProduct(changes);
    water.slope.template topRows<2>() *= -dt;
  }
  return Outcome::ok;
}

template <class Shape, class Pressure, class Kinematics, class Rule>
Outcome Coupled<Shape, Pressure, Kinematics, Rule>::evaluate(const ElementIn& in, ElementOut& out) const {
  const SolidLaw& law = *std::get<const SolidLaw*>(in.law);
  const std::size_t of_law = law.traits().history.size(), history = of_law + kPoreQuantities.size();
  const Eigen::Map<const Vector<kU>> du(in.du);
  Vector<kU> f = Vector<kU>::Zero();
  Vector<kP> f_p = Vector<kP>::Zero();
  Eigen::Matrix<double, kU, kP> Q;
  Matrix<kP> C;
  if (out.K != nullptr) Q.setZero(), C.setZero();
  constexpr int kTogether = points_together(kPoints);
  StackedOperators<4, kU, kTogether> some;
  Matrix<kU> K;
  PointIn<4> point;
  for (int p = 0; p < kPoints; ++p) {
    const double* const geometry = in.geometry + p * kStride;
    const double w = *geometry;
    const OperatorT<4, kU> Bt = Eigen::Map<const OperatorT<4, kDofs>>(geometry + 1).template topRows<kU>();
    const PressureRows rows = Eigen::Map<const PressureRows>(in.geometry + rows_of(p));
    const std::size_t h = static_cast<std::size_t>(p) * history;
    PointOut<4> result;
    point.sigma0 = Vector4::Map(in.sigma0 + 4 * p);
    point.eps0 = Vector4::Map(in.eps0 + 4 * p);
    point.deps.noalias() = Bt.transpose().lazyProduct(du);
    point.h0 = {in.h0 + h, of_law};
    result.h1 = {out.h1 + h, of_law};
    point.context = in.contexts != nullptr ? in.contexts + p : nullptr;
    Water water;
    if (law.update(point, result) != Outcome::ok ||
        flow(in, rows, in.h0 + h + of_law, point.deps.template head<3>().sum(), out.K != nullptr, water) !=
            Outcome::ok)
      return Outcome::cut_step;
    Vector4::Map(out.sigma1 + 4 * p) = result.sigma;
    Vector4::Map(out.eps1 + 4 * p) = point.eps0 + point.deps;
    out.status[p] = result.status;
    Vector4::Map(out.h1 + h + of_law) << water.pressure, water.content, water.displaced_x, water.displaced_y;

    Vector4 total = result.sigma;
    total.template head<3>().array() -= water.pressure;
    f.noalias() += Bt.lazyProduct(w * total);
    f_p += w * (water.displaced_x * rows.row(0) + water.displaced_y * rows.row(1) - water.content * rows.row(2))
                   .transpose();
    if (out.K == nullptr) continue;
    some.set(p % kTogether, Eigen::Map<const OperatorT<4, kU>>(Bt.data()), w * result.D);
    if ((p + 1) % kTogether == 0) sum_stiffness(some, p < kTogether, Eigen::Map<Matrix<kU>>(K.data()));
    Q.noalias() += (w * Bt.template leftCols<3>().rowwise().sum()).lazyProduct(rows.row(2));
    C.noalias() += w * (rows.template topRows<2>().transpose().lazyProduct(water.slope.template topRows<2>()) -
                        rows.row(2).transpose().lazyProduct(water.slope.row(2)));
  }
  Eigen::Map<Vector<kU>>(out.f) = f;
  Eigen::Map<Vector<kP>>(out.f + kU) = f_p;
  if (out.K == nullptr) return Outcome::ok;
  Eigen::Map<Matrix<kDofs>> whole(out.K);
  whole.template topLeftCorner<kU, kU>() = K;
  whole.template topRightCorner<kU, kP>() = -Q;
  whole.template bottomLeftCorner<kP, kU>() = -Q.transpose();
  whole.template bottomRightCorner<kP, kP>() = C;
  return Outcome::ok;
}

}  // namespace sage
