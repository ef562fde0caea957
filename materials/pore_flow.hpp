// Darcy's law of the water in the pores of a soil, for elements that solve for its excess pressure p:
//   v = -(k / gamma_w) grad p,  and p stores S p of water in a volume of soil, S = n / K_w.  docs/theory/consolidation.md
#pragma once

#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Strain [p,x  p,y  change of p], stress [-v_x  -v_y  change of what is stored].
class PoreFlow final : public Law<3> {
 public:
  // mobility: k / gamma_w, symmetric and positive definite.  storage: S, 0 = incompressible.    [1/stress]
  PoreFlow(const Matrix2& mobility, double storage);
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

// Water that crosses an interface: strain = drop of p, stress = volume per area and time.
class PoreJoint final : public Law<1> {
 public:
  // conductance: over gamma_w, not negative.                                     [length / (stress time)]
  explicit PoreJoint(double conductance) : conductance_(conductance) {}
  LawTraits traits() const override { return {.symmetric = true, .linear = true}; }
  Outcome update(const PointIn<1>& in, PointOut<1>& out) const override {
    out.sigma = in.sigma0 + conductance_ * in.deps;
    out.D(0, 0) = conductance_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  double conductance_;
};

MaterialEntry pore_flow_entry();
MaterialEntry pore_joint_entry();

}  // namespace sage
