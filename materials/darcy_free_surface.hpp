// Darcy's law in soil that falls dry above a free surface: v = -k_r(p) k grad h, p = h - y the pressure head.
// docs/theory/seepage.md
#pragma once

#include "materials/darcy.hpp"

namespace sage {

// k_r of a pressure head and its slope.  It falls from 1 to `least` within `ramp`, half of it on either side of p = 0,
// with a continuous slope.
struct RelativePermeability {
  double value = 1.0, slope = 0.0;  // [-], [1/length]
};
RelativePermeability relative_permeability(double pressure_head, double ramp, double least);

class DarcyFreeSurface final : public Law<3> {
 public:
  // k: saturated permeability.  ramp > 0: height over which it falls; 0 = the element's size.
  // least: what is left of it where the soil is dry, 0 < least < 1.
  DarcyFreeSurface(const Matrix2& k, double ramp, double least);

  LawTraits traits() const override;
  Outcome update(const PointIn<3>& in, PointOut<3>& out) const override;

 private:
  Matrix2 k_;
  double ramp_, least_;
};

MaterialEntry darcy_free_surface_entry();

}  // namespace sage
