// An element that recomputes its geometry as it moves, with history of its own: a two-node truss bar under displacements
// of any size, which remembers its largest stretch.
//
//   eps = L / L0 - 1,   f = -+ N t,   K = D / L0 t t^T + N / L (1 - t t^T)
//
// L and the direction t are those of the moved nodes; N comes from a law of bars.
#pragma once

#include <algorithm>
#include <array>

#include "bar.hpp"

namespace own {

class MovingTruss final : public sage::Element {
 public:
  explicit MovingTruss(sage::Geometry geometry)
      : traits_{.name = "own_truss2",
                .geometry = geometry,
                .nodes = 2,
                .dofs = 4,
                .points = 1,
                .law_size = 1,
                .linear = false,
                .sees_unknowns = true,
                .sees_coordinates = true,
                .history = kHistory} {}

  const sage::ElementTraits& traits() const override { return traits_; }

  // For outputs: weight and operator of the bar where it has not moved.
  void geometry(const sage::NodeCoordinates& x, std::span<double> out) const override { bar_.geometry(x, out); }
  sage::Vector2 position(const sage::NodeCoordinates& x, int point) const override {
    return bar_.position(x, point);
  }
  std::span<const double> point_to_node(const sage::NodeCoordinates& x) const override {
    return bar_.point_to_node(x);
  }

  sage::Outcome evaluate(const sage::ElementIn& in, sage::ElementOut& out) const override {
    using sage::Vector2;
    const auto& law = *std::get<const sage::Law<1>*>(in.law);
    const std::size_t of_law = law.traits().history.size();
    const sage::Vector<4> x = sage::Vector<4>::Map(in.x), u0 = sage::Vector<4>::Map(in.u0),
                          u = u0 + sage::Vector<4>::Map(in.du);
    const auto along = [&](const sage::Vector<4>& v) {
      return Vector2(x.tail<2>() + v.tail<2>() - x.head<2>() - v.head<2>());
    };
    const double L0 = along(sage::Vector<4>::Zero()).norm(), before = along(u0).norm() / L0 - 1.0;
    const Vector2 now = along(u);
    const double L = now.norm(), stretch = L / L0 - 1.0;
    if (!(L > 1e-6 * L0)) return sage::Outcome::cut_step;

    sage::PointIn<1> point;
    point.sigma0[0] = in.sigma0[0];
    point.eps0[0] = in.eps0[0];
    point.deps[0] = stretch - before;
    point.h0 = {in.h0, of_law};
    sage::PointOut<1> answer;
    answer.h1 = {out.h1, of_law};
    if (law.update(point, answer) != sage::Outcome::ok) return sage::Outcome::cut_step;
    out.sigma1[0] = answer.sigma[0];
    out.eps1[0] = point.eps0[0] + point.deps[0];
    out.h1[of_law] = std::max(in.h0[of_law], stretch);
    out.status[0] = answer.status;

    const double N = answer.sigma[0];
    const Vector2 t = now / L;
    sage::Vector<4>::Map(out.f) << -N * t, N * t;
    if (out.K == nullptr) return sage::Outcome::ok;
    const sage::Matrix2 tt = t * t.transpose();
    const sage::Matrix2 k = answer.D(0, 0) / L0 * tt + N / L * (sage::Matrix2::Identity() - tt);
    sage::Matrix<4>::Map(out.K) << k, -k, -k, k;
    return sage::Outcome::ok;
  }

 private:
  static constexpr std::array<sage::Quantity, 1> kHistory{{{"largest_stretch"}}};
  sage::ElementTraits traits_;
  Bar2 bar_{sage::Geometry::plane_strain};
};

inline sage::ElementEntry truss2() {
  sage::ElementEntry entry = bar2();
  entry.name = "own_truss2";
  entry.summary = "two-node truss bar, displacements of any size";
  entry.make = [](sage::Geometry geometry, int formulation) -> std::unique_ptr<sage::Element> {
    if (formulation > 1) throw sage::ParameterError(-1, "an own_truss2 has no such formulation");
    return std::make_unique<MovingTruss>(geometry);
  };
  return entry;
}

}  // namespace own
