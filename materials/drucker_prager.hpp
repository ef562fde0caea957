// Drucker-Prager, elastic - perfectly plastic, any dilation.  Chapter 7, Equations 7.24 to 7.27.
// docs/theory/drucker_prager.md
#pragma once

#include <array>

#include "materials/linear_elastic.hpp"
#include "materials/parameters.hpp"
#include "materials/stress_measures.hpp"
#include "sage/core/law.hpp"

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
class DruckerPrager final : public SolidLaw {
 public:
  explicit DruckerPrager(const DruckerPragerParameters& parameters);
  // Sums of sqrt(2 de_p:de_p), the plastic shear gamma of simple shear, and of the plastic
  // volume strain (+ dilates).
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  std::span<const Quantity> history() const override { return kHistory; }
  bool symmetric() const override { return p_.cone.alpha == p_.beta && !p_.exact; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  bool takes_four() const override { return true; }
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override;
  // A cone that reaches beyond Mohr-Coulomb's tension limit in triaxial extension, or no strength at all.
  std::string caution() const override;
  // sqrt(J2D) / (alpha J1 + K) of the source chapter, J1 compression positive.
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;

 private:
  enum { kShear, kVolume };

  // The stress that tolerances are relative to, from |p| and q.
  template <class Real>
  Real scale(const Real& p, const Real& q) const {
    return p_.cone.k + 3.0 * p_.cone.alpha * p + q + 0.01 * p;  // the last: rounding of s
  }
  // Elastic predictor of four points.
  struct Trial {
    FourTensors stress;
    FourInvariants of;
    Four f, rounding;  // of the yield function
    FourMask elastic;  // points that stay inside
  };
  void predict(const FourPointsIn<4>& in, Trial& trial) const;
  void finish(const FourPointsIn<4>& in, const Trial& trial, FourPointsOut<4>& out) const;
  // Where the trial states end: on the cone all four, whether they should or not; then what is right for others.
  // here: the points that a branch is for; it leaves the others alone.
  void return_to_cone(const FourInvariants& trial, const Four& p, FourPointsOut<4>& out) const;
  void stay_elastic(const FourTensors& trial, const FourMask& here, FourPointsOut<4>& out) const;
  void drop_deviator(const FourInvariants& trial, const FourMask& here, FourPointsOut<4>& out) const;
  void return_to_cap(const FourInvariants& trial, const FourMask& here, FourPointsOut<4>& out) const;
  void take_exact_answers(const FourPointsIn<4>& in, const FourMask& here, FourPointsOut<4>& out) const;
  bool integrate_exactly(const PointIn<4>& in, PointOut<4>& out) const;

  DruckerPragerParameters p_;
  double p_max_;  // mean stress of the apex or of the tension limit
  Matrix4 D_elastic_;
};

MaterialEntry drucker_prager_entry();

}  // namespace sage
