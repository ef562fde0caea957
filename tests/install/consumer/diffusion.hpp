// An element of one's own with a third unknown: soil that swells with what diffuses through it (salt, moisture,
// heat).  A four-node quadrilateral whose nodes have a concentration c beside their displacement:
//
//   div(sigma' - beta c 1) + b = 0      sigma' = law(eps): effective stress, that of every output
//   S dc/dt - div(k grad c) = q         k = k0 (1 + a c)
//
// The law brings the constants of the second equation with it; the element alone knows what they are for.  This
// is the example of docs/manual/own_unknown.md.
#pragma once

#include <cmath>

#include "elements/solid_entry.hpp"
#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"

namespace own {

using namespace sage;

struct Diffusion {
  double k0 = 0.0, growth = 0.0;  // k = k0 (1 + growth c): flux per length of gradient
  double swelling = 0.0;          // beta: stress that a concentration of 1 puts on the skeleton, tension +
  double storage = 0.0;           // S
};

// Elastic skeleton.
class SwellingSoil final : public SolidLaw {
 public:
  explicit SwellingSoil(const Parameters& p)
      : elastic_(moduli_from_young(p.positive("youngs_modulus"), p.poissons_ratio("poissons_ratio"))),
        diffusion{p.positive("diffusivity"), p.number("growth"), p.number("swelling"), p.number("storage")} {}

  sage::LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override { return elastic_.update(in, out); }

 private:
  LinearElastic elastic_;

 public:
  const Diffusion diffusion;
};

class DiffusionQuad final : public Element {
 public:
  explicit DiffusionQuad(Geometry geometry)
      : quad_(solid_maker<Quad4, GaussSquare<2>>("quad4 full")(geometry)), traits_(quad_->traits()) {
    traits_.name = "diffusion quad";
    traits_.dofs = kDofs;
    traits_.symmetric = false;  // the concentration moves the soil, not the soil the concentration
    traits_.linear = false;     // k grows with c
    traits_.sees_unknowns = true;
  }

  const ElementTraits& traits() const override { return traits_; }

  // Strains are those of the quadrilateral: the rows of the concentration are zero in B^T.
  void geometry(const NodeCoordinates& x, std::span<double> geometry) const override {
    std::array<double, kPoints*(1 + 4 * kMoved)> own{};
    quad_->geometry(x, own);
    for (std::size_t p = 0; p < kPoints; ++p) {
      const double* from = own.data() + p * (1 + 4 * kMoved);
      double* to = geometry.data() + p * (1 + 4 * kDofs);
      to[0] = from[0];
      Bt::Map(to + 1).setZero();
      Bt::Map(to + 1).topRows<kMoved>() = Eigen::Matrix<double, kMoved, 4>::Map(from + 1);
    }
  }

  Outcome evaluate(const ElementIn& in, ElementOut& out) const override {
    const auto* law = dynamic_cast<const SwellingSoil*>(std::get<const SolidLaw*>(in.law));
    if (law == nullptr) throw AnalysisError("elements 'diffusion_quad' need a material of law swelling_soil");
    VectorOf f = VectorOf::Zero();
    MatrixOf K = MatrixOf::Zero();
    for (std::size_t p = 0; p < kPoints; ++p)
      if (add_point(*law, in, p, f, K, out) != Outcome::ok) return Outcome::cut_step;
    VectorOf::Map(out.f) = f;
    if (out.K != nullptr) MatrixOf::Map(out.K) = K;
    return Outcome::ok;
  }

  Vector2 position(const NodeCoordinates& x, int point) const override { return quad_->position(x, point); }
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override {
    quad_->body_load(x, b, f.first(kMoved));
  }
  const std::vector<std::vector<int>>& edges() const override { return quad_->edges(); }
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    quad_->edge_load(x, edge, normal, shear, f.first(kMoved));
  }
  std::span<const double> point_to_node(const sage::NodeCoordinates& x) const override {
    return quad_->point_to_node(x);
  }
  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    return quad_->shape_functions(parent, N, dN);
  }
  double shape_quality(const NodeCoordinates& x) const override { return quad_->shape_quality(x); }

 private:
  static constexpr int kMoved = 8, kDofs = 12;  // u1 v1 ... u4 v4, then c1 ... c4
  static constexpr std::size_t kPoints = 4;
  using VectorOf = Vector<kDofs>;
  using MatrixOf = Matrix<kDofs>;
  using Bt = Eigen::Matrix<double, kDofs, 4>;

  Outcome add_point(const SwellingSoil& law, const ElementIn& in, std::size_t p, VectorOf& f, MatrixOf& K,
                    ElementOut& out) const {
    const double* const block = in.geometry + p * (1 + 4 * kDofs);
    const double w = block[0];
    const auto B = Eigen::Matrix<double, kDofs, 4>::Map(block + 1).topRows<kMoved>().eval();
    const Vector4 N = shape_at(p);
    Eigen::Matrix<double, 4, 2> grad;  // dN/dx, dN/dy: the normal strains of the displacements alone
    for (int a = 0; a < 4; ++a) grad.row(a) << B(2 * a, 0), B(2 * a + 1, 1);

    const std::size_t at = 4 * p;
    PointIn<4> point{Vector4::Map(in.sigma0 + at),
                     Vector4::Map(in.eps0 + at),
                     B.transpose() * Vector<kMoved>::Map(in.du),
                     {}};
    PointOut<4> answer;
    if (law.update(point, answer) != Outcome::ok) return Outcome::cut_step;
    Vector4::Map(out.sigma1 + at) = answer.sigma;
    Vector4::Map(out.eps1 + at) = point.eps0 + point.deps;
    out.status[p] = answer.status;

    const Diffusion& d = law.diffusion;
    const Vector4 dc = Vector4::Map(in.du + kMoved), nodal_c = Vector4::Map(in.u0 + kMoved) + dc;
    const Vector4 one(1.0, 1.0, 1.0, 0.0);
    const Vector2 slope = grad.transpose() * nodal_c;
    const double c = N.dot(nodal_c), k = d.k0 * (1.0 + d.growth * c),
                 per_time = in.dt > 0.0 ? d.storage / in.dt : 0.0;
    f.head<kMoved>() += w * B * (answer.sigma - d.swelling * c * one);
    f.tail<4>() += w * (k * grad * slope + per_time * N.dot(dc) * N);
    K.topLeftCorner<kMoved, kMoved>() += w * B * answer.D * B.transpose();
    K.topRightCorner<kMoved, 4>() -= w * d.swelling * B * one * N.transpose();
    K.bottomRightCorner<4, 4>() +=
        w * (k * grad * grad.transpose() + d.k0 * d.growth * grad * slope * N.transpose() +
             per_time * N * N.transpose());
    return Outcome::ok;
  }

  static Vector4 shape_at(std::size_t point) {
    const auto& q = GaussSquare<2>::table[point];
    return Quad4::N({q.xi, q.eta});
  }

  std::unique_ptr<Element> quad_;
  ElementTraits traits_;
};

inline UnknownField concentration() {
  return {.name = "concentration", .load = "flux", .balanced = false};
}

inline ElementEntry diffusion_quad() {
  ElementEntry entry =
      with_shape<Quad4>({.name = "diffusion_quad", .summary = "four-node, with a concentration"});
  entry.vtk = {9, {}};
  entry.gmsh = {3, {}};
  entry.unknowns = {{displacement_field()}, {concentration()}};
  return element_entry(entry, {{{1, "full", "2x2 Gauss", 4}, [](Geometry geometry) -> std::unique_ptr<Element> {
                                  return std::make_unique<DiffusionQuad>(geometry);
                                }}});
}

inline MaterialEntry swelling_soil() {
  static const std::vector<Parameter> rows = {
      required("youngs_modulus", Dimension::stress, "E", ParameterRole::youngs_modulus),
      required("poissons_ratio", Dimension::none, "nu", ParameterRole::poissons_ratio),
      required("diffusivity", Dimension::none, "k0: flux for a gradient of 1"),
      optional("growth", Dimension::none, "a: k = k0 (1 + a c)", 0.0),
      optional("swelling", Dimension::stress, "beta: stress for a concentration of 1", 0.0),
      optional("storage", Dimension::none, "S", 0.0)};
  return {"swelling_soil", "elastic soil that swells with a concentration", 4, rows,
          [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            return std::make_unique<SwellingSoil>(Parameters(rows, values, units));
          }};
}

}  // namespace own
