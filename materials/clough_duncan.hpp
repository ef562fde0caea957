// Clough & Duncan (1969, 1971): hyperbolic interface with Coulomb slip, opening and closing.
// docs/theory/clough_duncan.md
#pragma once

#include <array>

#include "materials/dual.hpp"
#include "materials/parameters.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Where in an increment the shear stiffness is taken.
enum class ShearRule {
  tangent,   // at its start: tau1 = tau0 + k_s,t(start) dw, the rule of the source chapter; first order
  midpoint,  // at its middle, implicit; second order
  exact,     // the hyperbola itself, with sigma_n of the middle; exact for constant sigma_n
};

struct CloughDuncanParameters {
  double c, tan_phi;        // adhesion, tangent of the friction angle   [stress], [-]
  double sigma_t;           // tensile strength, lost once broken        [stress]
  double R_f;               // failure ratio                             [-]
  double k_unit;            // k_j gamma_w                               [stress/length]
  double n;                 // exponent                                  [-]
  double k_nc, k_nt, k_sf;  // compression, tension, after slip          [stress/length]
  double p_a;               // atmospheric pressure, 1 if not needed     [stress]
  double floor;             // k_s sees at least sigma_n = floor * p_a   [-]
  double nothing;           // an opening that so little would close is none [stress]
  ShearRule rule;
  bool memory;  // reloading is linear up to the largest |tau| so far
  // Share of k_s in the tangent of a joint that slips, not in its stress; above 0 an open one keeps a trace too.
  double slip_tangent = 0.0;
};

// In compression-positive sigma_n:                                          [Clough & Duncan 1971; chapter 7]
//   k_s,i = k_j gamma_w (sigma_n/p_a)^n,  tau_f = c + sigma_n tan phi,  k_s,t = k_s,i (1 - R_f tau/tau_f)^2.
// Unloading and reloading with k_s,i.  Slip returns |tau| to tau_f plus k_sf times the displacement since slip.
class CloughDuncan final : public InterfaceLaw {
 public:
  explicit CloughDuncan(const CloughDuncanParameters& parameters) : p_(parameters) {}
  static constexpr std::array<Quantity, 5> kHistory{{{"gap", Dimension::length, 0.0},
                                                     {"tension_broken", Dimension::none, 0.0},
                                                     {"largest_shear_stress", Dimension::stress, 0.0},
                                                     {"stress_above_strength", Dimension::stress, 0.0},
                                                     {"plastic_slip", Dimension::length, 0.0}}};
  // Symmetric without friction and without shear stiffness ("free ends") or any strength: shear never meets normal.
  LawTraits traits() const override {
    return {.history = kHistory,
            .symmetric = p_.tan_phi == 0.0 && (p_.k_unit == 0.0 || (p_.c == 0.0 && p_.k_sf == 0.0))};
  }
  bool initialise(const Vector2& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector2& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<2>& in, PointOut<2>& out) const override;
  std::string caution() const override {
    if (p_.k_unit == 0.0) return "no shear resistance: the stiffness number k_j is zero";
    if (p_.c == 0.0 && p_.tan_phi == 0.0 && p_.k_sf == 0.0)
      return "no shear resistance: adhesion and friction are zero, and so is the stiffness after slip";
    return {};
  }
  double stress_level(const Vector2& sigma, std::span<const double> h) const override;

 private:
  using Real = Dual<2>;  // derivatives with respect to the two increments [shear, normal]
  enum { kGap, kBroken, kMemory, kHardening, kSlip };
  struct Normal {
    Real sigma;    // tension positive
    Real sliding;  // share of the increment that found the joint in contact
    double gap = 0.0;
    bool open = false;
    Real lost;  // of the strength: over a gap so small that adhesion acts across it
  };
  struct Shear {
    Real tau;        // in the direction of the increment
    Real stiffness;  // secant stiffness of the last branch
    bool unloading = false;
  };
  Normal normal_response(const PointIn<2>& in) const;
  // Gap at which adhesion, and what hardening has added to it, is gone.
  double reach(std::span<const double> h) const { return (p_.c + h[kHardening]) / p_.k_nc; }
  Shear shear_trial(const PointIn<2>& in, const Real& sigma_n, const Real& w, double direction) const;
  Shear primary(const Real& tau0, const Real& w, const Real& k_i, const Real& tau_f) const;
  Real strength(const Real& sigma_n) const;
  double limit(double sigma_n, std::span<const double> h) const;  // of |tau|, at a state
  Real initial_stiffness(const Real& sigma_n) const;

  CloughDuncanParameters p_;
};

MaterialEntry clough_duncan_entry();

}  // namespace sage
