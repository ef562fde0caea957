// An element with two laws whose matrix is constant for a given step size: a two-node bar of soil whose water flows along
// it (Biot 1941 in one dimension).
//
//   d(sigma' - p)/ds + b = 0     sigma' = skeleton(eps)           law of the group
//   d(eps)/dt + d(v)/ds  = q     v = -flow(dp/ds)                 second law of the group
//
// p is the excess pressure of the water, a third unknown of the nodes; backward Euler in time.
#pragma once

#include "bar.hpp"

namespace own {

class ConsolidatingBar final : public sage::Element {
 public:
  explicit ConsolidatingBar(sage::Geometry geometry)
      : traits_{.name = "own_consolidation2",
                .geometry = geometry,
                .nodes = 2,
                .dofs = 6,  // u1 v1 u2 v2, then p1 p2
                .points = 1,
                .law_size = 1,
                .symmetric = false,
                .linear = false,
                .sees_unknowns = true,
                .linear_in_step = true,
                .second_law_size = 1} {}

  const sage::ElementTraits& traits() const override { return traits_; }

  // w and B of the bar; the rows of the pressures are zero in B^T.
  void geometry(const sage::NodeCoordinates& x, std::span<double> out) const override {
    std::fill(out.begin(), out.end(), 0.0);
    bar_.geometry(x, out.first(5));
  }
  sage::Vector2 position(const sage::NodeCoordinates& x, int point) const override {
    return bar_.position(x, point);
  }
  std::span<const double> point_to_node(const sage::NodeCoordinates& x) const override {
    return bar_.point_to_node(x);
  }

  sage::Outcome evaluate(const sage::ElementIn& in, sage::ElementOut& out) const override {
    using sage::Vector;
    const double L = in.geometry[0], rate = in.dt > 0.0 ? 1.0 / in.dt : 0.0;
    const auto B = Vector<4>::Map(in.geometry + 1);
    const auto du = Vector<4>::Map(in.du);
    const double p1 = in.u0[4] + in.du[4], p2 = in.u0[5] + in.du[5];
    sage::PointOut<1> skeleton, flow;
    if (ask(in.law, in.sigma0[0], in.eps0[0], B.dot(du), skeleton) != sage::Outcome::ok ||
        ask(in.second_law, 0.0, 0.0, (p2 - p1) / L, flow) != sage::Outcome::ok)
      return sage::Outcome::cut_step;
    out.sigma1[0] = skeleton.sigma[0];
    out.eps1[0] = in.eps0[0] + B.dot(du);
    out.status[0] = skeleton.status;

    auto f = Vector<6>::Map(out.f);
    f.head<4>() = L * (skeleton.sigma[0] - 0.5 * (p1 + p2)) * B;
    const double stored = 0.5 * L * rate * B.dot(du);  // half of the element's change of volume to each node
    f.tail<2>() << stored - flow.sigma[0], stored + flow.sigma[0];
    if (out.K == nullptr) return sage::Outcome::ok;
    auto K = sage::Matrix<6>::Map(out.K);
    K.topLeftCorner<4, 4>() = L * skeleton.D(0, 0) * B * B.transpose();
    K.topRightCorner<4, 2>() = -0.5 * L * B * Vector<2>::Ones().transpose();
    K.bottomLeftCorner<2, 4>() = 0.5 * L * rate * Vector<2>::Ones() * B.transpose();
    const double k = flow.D(0, 0) / L;
    K.bottomRightCorner<2, 2>() << k, -k, -k, k;
    return sage::Outcome::ok;
  }

 private:
  static sage::Outcome ask(const sage::LawRef& law, double sigma0, double eps0, double deps,
                           sage::PointOut<1>& out) {
    sage::PointIn<1> in;
    in.sigma0[0] = sigma0;
    in.eps0[0] = eps0;
    in.deps[0] = deps;
    return std::get<const sage::Law<1>*>(law)->update(in, out);
  }

  sage::ElementTraits traits_;
  Bar2 bar_{sage::Geometry::plane_strain};
};

inline sage::ElementEntry consolidation2() {
  sage::ElementEntry entry = bar2();
  entry.name = "own_consolidation2";
  entry.summary = "two-node bar of soil and its pore water";
  entry.unknowns = {{sage::displacement_field()}, {{.name = "pressure", .load = "inflow", .balanced = false}}};
  entry.make = [](sage::Geometry geometry, int formulation) -> std::unique_ptr<sage::Element> {
    if (formulation > 1) throw sage::ParameterError(-1, "an own_consolidation2 has no such formulation");
    return std::make_unique<ConsolidatingBar>(geometry);
  };
  return entry;
}

}  // namespace own
