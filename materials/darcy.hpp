// Darcy's law: v = -k grad h, with a permeability that may differ along two directions at right angles.
// docs/theory/seepage.md
#pragma once

#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

// What Law<3> is to water stands at PointIn in sage/core/law.hpp.
class Darcy final : public Law<3> {
 public:
  // k: permeability along x and y, symmetric and positive definite.                     [length/time]
  explicit Darcy(const Matrix2& k);
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<3>& in, PointOut<3>& out) const override {
    out.sigma.noalias() = in.sigma0 + D_ * in.deps;
    out.D = D_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  Matrix<3> D_;
};

// Permeability k1 along a direction `angle` (radians, counter-clockwise from +x) and k2 across it.
Matrix2 turned_permeability(double k1, double k2, double angle);

// Of a card with k1, k2 (0 = k1) and the direction of k1 in degrees.  Throws ParameterError.
Matrix2 permeability_of(const Parameters& p);

MaterialEntry darcy_entry();

}  // namespace sage
