// Hyperbolic nonlinear elasticity: Duncan & Chang (1970) and Duncan, Byrne, Wong & Mabry (1980).
// docs/theory/hyperbolic.md
#pragma once

#include <array>

#include "materials/hyperbolic_steps.hpp"
#include "sage/core/law.hpp"

namespace sage {

enum class HyperbolicTangent {
  consistent,  // derivative of the computed stress; unsymmetric, quadratic Newton
  isotropic,   // mean stiffness of the step; symmetric, linear convergence
};

// d sigma = D(E, B or nu) d eps with stress-dependent moduli.  No yield surface: the stress level may pass 1,
// with the stiffness that is left there (use hyperbolic_mohr_coulomb to bound it).
class DuncanChang final : public SolidLaw, public PathError<4> {
 public:
  DuncanChang(const HyperbolicSteps& steps, HyperbolicTangent tangent) : steps_(steps), tangent_(tangent) {}
  static constexpr std::array<Quantity, 1> kHistory{{{"largest_stress_state", Dimension::none, 0.0}}};
  LawTraits traits() const override {
    return {.history = kHistory, .symmetric = tangent_ == HyperbolicTangent::isotropic};
  }
  // False above the strength.
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const override {
    return sage::path_error(steps_, in, sigma, in.h0[kMemory], h[kMemory]);
  }
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;

 private:
  enum { kMemory };
  HyperbolicSteps steps_;
  HyperbolicTangent tangent_;
};

// Rows of a law of this kind, and the law; hyperbolic_rows and what DuncanChang and its steps add.
std::vector<Parameter> duncan_chang_rows(VolumeRule volume);
LawPtr make_duncan_chang(VolumeRule volume, std::span<const double> values, const UnitSystem& units);

MaterialEntry duncan_chang_1970_entry();
MaterialEntry duncan_chang_eb_entry();

}  // namespace sage
