// Joint with Coulomb slip that dilates until it has slid far enough; opens and closes.
// docs/theory/dilating_joint.md
#pragma once

#include <array>

#include "materials/dual.hpp"
#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

struct DilatingJointParameters {
  double k_s, k_n;             // stiffness of contact                              [stress/length]
  double c, tan_phi, tan_psi;  // cohesion, slopes of friction and dilation         [stress], [-]
  double slip_limit;           // plastic slip after which it dilates no more        [length], infinite for none
};

// With sigma_n compression positive: |tau| <= c + sigma_n tan phi; slip lambda opens the joint by lambda tan psi.
// Apart by a gap g there is no normal stress, and |tau| <= c - k_n g: cohesion is gone at g = c/k_n.
class DilatingJoint final : public InterfaceLaw {
 public:
  explicit DilatingJoint(const DilatingJointParameters& parameters) : p_(parameters) {}
  static constexpr std::array<Quantity, 3> kHistory{{{"gap", Dimension::length, 0.0},
                                                     {"plastic_slip", Dimension::length, 0.0},
                                                     {"plastic_opening", Dimension::length, 0.0}}};
  LawTraits traits() const override { return {.history = kHistory}; }
  bool initialise(const Vector2& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector2& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<2>& in, PointOut<2>& out) const override;
  std::string caution() const override;
  double stress_level(const Vector2& sigma, std::span<const double> h) const override;

 private:
  using Real = Dual<2>;  // derivatives with respect to the two increments [shear, normal]
  enum { kGap, kSlip, kOpening };
  struct Slip {
    Real slip, opening;  // plastic, of the increment
  };
  // Back to a strength that falls with this slope over the normal stress, if the trial is outside.
  struct Return {
    Real tau, sigma;
    Slip slip;
    bool slips;
  };
  Return return_to(double slope, const Real& tau, const Real& sigma, double slip0) const;
  Slip slip_of(const Real& excess, double slope, double slip0) const;
  double strength(double sigma, double gap) const;  // sigma: tension positive

  DilatingJointParameters p_;
};

MaterialEntry dilating_joint_entry();

}  // namespace sage
