// Mohr-Coulomb whose cohesion, friction and dilation change with plastic shear strain.
// docs/theory/mohr_coulomb_softening.md
#pragma once

#include <array>

#include "materials/linear_elastic.hpp"
#include "materials/mohr_coulomb_return.hpp"
#include "materials/rising_zero.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Values at no plastic shear strain, at strain[0] and at strain[1]; straight between the first two, then straight
// to the third and constant, or towards it as exp(-(kappa - strain[0])/(strain[1] - strain[0])).
struct StrengthPath {
  std::array<double, 3> c, phi, psi;  // [stress], radians
  std::array<double, 2> strain;       // 0 <= strain[0] < strain[1], unless nothing changes beyond strain[0]
  bool exponential;
  double T;  // tension cut-off, infinite for none

  // The planes at a plastic shear strain kappa >= 0.
  MovingPlanes at(double kappa) const;
  bool softens() const;  // cohesion or friction falls somewhere
};

class MohrCoulombSoftening final : public SolidLaw, public ElasticShear {
 public:
  MohrCoulombSoftening(const ElasticModuli& elastic, const StrengthPath& path)
      : elastic_(elastic), path_(path), D_elastic_(elastic_matrix(elastic)) {}
  // Sums of sqrt(2 de_p:de_p), which the strength depends on, and of the plastic volume strain (+ dilates).
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  LawTraits traits() const override { return {.history = kHistory}; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  std::string caution() const override;
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return elastic_.G;
  }

 private:
  enum { kShear, kVolume };
  // A return for a trial kappa, and what kappa lacks to be the one that the return makes.
  struct Attempt {
    MovedReturn moved;
    Vector4 direction;  // d(sqrt J2 of the stress taken off)/d(that stress)
    ValueAndSlope lack;
  };
  Attempt attempt(double kappa0, const Vector4& trial, double kappa) const;

  ElasticModuli elastic_;
  StrengthPath path_;
  Matrix4 D_elastic_;
};

MaterialEntry mohr_coulomb_softening_entry();

}  // namespace sage
