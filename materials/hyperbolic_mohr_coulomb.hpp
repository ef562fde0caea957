// Hyperbolic moduli inside a Mohr-Coulomb surface, after the idea of Morrison (1995): the hyperbola bends
// towards its strength, and plasticity keeps it from overshooting.  docs/theory/hyperbolic_mohr_coulomb.md
#pragma once

#include <array>

#include "materials/hyperbolic_steps.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Each substep: trial with the mean tangent moduli (E_t or E_ur, B) of its two ends, then return to the
// envelope sigma_1 = sigma_3 + (sigma_1 - sigma_3)_f with those moduli frozen and flow of the dilation angle.
class HyperbolicMohrCoulomb final : public SolidLaw, public PathError<4> {
 public:
  explicit HyperbolicMohrCoulomb(const HyperbolicSteps& steps) : steps_(steps) {}
  static constexpr std::array<Quantity, 1> kHistory{{{"largest_stress_state", Dimension::none, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory}; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const override {
    return sage::path_error(steps_, in, sigma, in.h0[kMemory], h[kMemory]);
  }
  // (sigma_1 - sigma_3) / (sigma_1 - sigma_3)_f
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;

 private:
  enum { kMemory };
  HyperbolicSteps steps_;
};

MaterialEntry hyperbolic_mohr_coulomb_entry();

}  // namespace sage
