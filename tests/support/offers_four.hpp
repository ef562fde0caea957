// An element that offers to be evaluated four at a time, one by one in truth, whatever its size.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "sage/core/four_at_a_time.hpp"

namespace sage::test {

class OffersFour final : public Element, public FourElements {
 public:
  explicit OffersFour(std::shared_ptr<const Element> own) : own_(std::move(own)) {}
  const ElementTraits& traits() const override { return own_->traits(); }
  void geometry(const NodeCoordinates& x, std::span<double> geometry) const override {
    own_->geometry(x, geometry);
  }
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override { return own_->evaluate(in, out); }
  int four_geometry_size() const override { return traits().geometry_size(); }
  void place_among_four(std::span<const double> geometry, double* among_four) const override {
    for (std::size_t i = 0; i < geometry.size(); ++i) among_four[i * kAbreast] = geometry[i];
  }
  Outcome evaluate_four(const FourElementsIn& in, FourElementsOut& out) const override {
    const auto size = static_cast<std::size_t>(traits().geometry_size());
    const auto dofs = static_cast<std::size_t>(traits().dofs);
    std::vector<double> geometry(size), du(dofs);
    for (std::size_t l = 0; l < kAbreast; ++l) {
      for (std::size_t i = 0; i < size; ++i) geometry[i] = in.geometry[i * kAbreast + l];
      for (std::size_t i = 0; i < dofs; ++i) du[i] = in.du[i * kAbreast + l];
      ElementOut one{out.K[l], out.f[l], out.sigma1[l], out.eps1[l], out.h1[l], out.status[l]};
      const LawRef law = dynamic_cast<const SolidLaw*>(in.law);
      if (own_->evaluate({geometry.data(), du.data(), law, in.sigma0[l], in.eps0[l], in.h0[l]}, one) !=
          Outcome::ok)
        return Outcome::cut_step;
    }
    out.changed = true;
    return Outcome::ok;
  }
  Vector2 position(const NodeCoordinates& x, int point) const override { return own_->position(x, point); }
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override {
    own_->body_load(x, b, f);
  }
  const std::vector<std::vector<int>>& edges() const override { return own_->edges(); }
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override {
    own_->edge_load(x, edge, normal, shear, f);
  }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return own_->point_to_node(x);
  }
  bool shape_functions(const Vector2& parent, std::span<double> N, std::span<double> dN) const override {
    return own_->shape_functions(parent, N, dN);
  }
  double shape_quality(const NodeCoordinates& x) const override { return own_->shape_quality(x); }

 private:
  std::shared_ptr<const Element> own_;
};

}  // namespace sage::test
