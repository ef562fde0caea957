// Drucker-Prager, elastic - perfectly plastic, any dilation.  Chapter 7, Equations 7.24 to 7.27.
// docs/theory/drucker_prager.md
#pragma once

#include <array>

#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"
#include "materials/stress_measures.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

// How the cone is matched to Mohr-Coulomb.  The numbers are the deck's codes.
enum class ConeMatch {
  triaxial_compression = 1,  // Equations 7.26 and 7.27
  triaxial_extension = 2,
  plane_strain_associated = 3,  // exact in plane strain collapse for psi = phi
  plane_strain_deviatoric = 4,  // exact in plane strain collapse for flow without volume change
  inner = 5,                    // largest cone inside Mohr-Coulomb; the same cone as 3
};

struct Cone {
  double alpha, k;  // sqrt(J2D) + alpha I1 - k = 0, I1 tension positive     [-], [stress]
};
Cone match_cone(ConeMatch match, double phi, double c);

struct DruckerPragerParameters {
  ElasticModuli elastic;
  Cone cone;
  double beta;          // flow potential sqrt(J2D) + beta I1               [-]
  double mean_tension;  // largest mean stress; infinite = only the apex    [stress]
  bool exact;           // constant-rate integration instead of radial return; needs beta = 0
  bool free_mean;       // beyond the apex the mean stress stays elastic; needs beta = 0
};

// f = sqrt(J2D) + alpha I1 - k,  g = sqrt(J2D) + beta I1.  Beyond the apex, or beyond the mean tension limit,
// the mean stress is held there and the deviator is what the cone leaves: zero at the apex, whatever beta is.
// With free_mean the flow stays without volume change there too: only the deviator goes, the mean stress may be
// tensile.  That is what a program does which knows no apex, the source chapter's among them.
class DruckerPrager : public ElasticShear {
 public:
  explicit DruckerPrager(const DruckerPragerParameters& parameters);
  // Sums of sqrt(2 de_p:de_p), the plastic shear gamma of simple shear, and of the plastic
  // volume strain (+ dilates).
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  LawTraits traits() const override {
    return {.history = kHistory, .symmetric = p_.cone.alpha == p_.beta && !p_.exact};
  }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  // A cone that reaches beyond Mohr-Coulomb's tension limit in triaxial extension, or no strength at all.
  std::string caution() const override;
  // sqrt(J2D) / (alpha J1 + K) of the source chapter, J1 compression positive.
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return p_.elastic.G;
  }

 protected:
  enum { kShear, kVolume };
  static constexpr double kRounding = rounding::kResult;  // relative to scale()
  // Share of D_elastic left in the tangent where the true one is singular.
  static constexpr double kApexStiffness = 1e-7;
  // unit_tensor() and deviatoric_projection(), as constants that loops over their terms fold.
  static constexpr double kUnit[4] = {1.0, 1.0, 1.0, 0.0};
  static constexpr double kThird = 1.0 / 3.0;
  static constexpr double kProjection[4][4] = {{2.0 * kThird, -kThird, -kThird, 0.0},
                                               {-kThird, 2.0 * kThird, -kThird, 0.0},
                                               {-kThird, -kThird, 2.0 * kThird, 0.0},
                                               {0.0, 0.0, 0.0, 0.5}};

  // The stress that tolerances are relative to, from |p| and q.
  template <class Real>
  Real scale(const Real& p, const Real& q) const {
    return p_.cone.k + 3.0 * p_.cone.alpha * p + q + 0.01 * p;  // the last: rounding of s
  }
  // False where the formula does not apply; out.h1 is left alone.
  bool integrate_exactly(const PointIn<4>& in, PointOut<4>& out) const;

  DruckerPragerParameters p_;
  double p_max_;  // mean stress of the apex or of the tension limit
  Matrix4 D_elastic_;

 private:
  using Trial = StressInvariants;  // of the elastic predictor
  void return_to_cone(const Trial& trial, double p, PointOut<4>& out) const;
  void drop_deviator(const Trial& trial, PointOut<4>& out) const;
  void return_to_cap(const Trial& trial, PointOut<4>& out) const;
};

MaterialEntry drucker_prager_entry();

}  // namespace sage
