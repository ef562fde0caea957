// Mohr-Coulomb whose cohesion, friction and dilation change with plastic shear strain.
// docs/theory/mohr_coulomb_softening.md
#pragma once

#include <array>
#include <cstddef>

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
  // Length: of the band whose strains these are; strain over which the strength falls goes with this over the size of the
  // element, so that a band one element wide spends the same energy in every mesh.  0 = the strains hold in elements of any size.
  double band_width = 0.0;

  // The planes at a plastic shear strain kappa >= 0.
  MovingPlanes at(double kappa) const;
  // Whether cohesion or friction falls on the way to value 1 or 2.
  bool falls_to(std::size_t value) const { return c[value] < c[value - 1] || phi[value] < phi[value - 1]; }
  bool softens() const { return falls_to(1) || falls_to(2); }
  // Plastic shear strain of a point of an element of this size (0 = the band's), where the strength is that of kappa.
  ValueAndSlope strain_at(double kappa, double size) const;
};

class MohrCoulombSoftening final : public ElasticShear {
 public:
  MohrCoulombSoftening(const ElasticModuli& elastic, const StrengthPath& path)
      : elastic_(elastic), path_(path), D_elastic_(elastic_matrix(elastic)) {}
  // Sums of sqrt(2 de_p:de_p), which the strength depends on, and of the plastic volume strain (+ dilates).
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  // With a band width the strength depends on its own strain in place of the first.
  static constexpr std::array<Quantity, 3> kHistoryOfBand{
      {kHistory[0], kHistory[1], {"softening_strain", Dimension::none, 0.0}}};
  LawTraits traits() const override {
    if (path_.band_width > 0.0) return {.history = kHistoryOfBand, .wants_context = true};
    return {.history = kHistory};
  }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  std::string caution() const override;
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return elastic_.G;
  }

 private:
  enum { kShear, kVolume, kOfBand };
  std::size_t strength_index() const { return path_.band_width > 0.0 ? kOfBand : kShear; }
  // A return for a trial kappa, and what kappa lacks to be the one that the return makes.
  struct Attempt {
    MovedReturn moved;
    Vector4 direction;  // d(sqrt J2 of the stress taken off)/d(that stress)
    ValueAndSlope lack;
  };
  // strain: of kappa, less that of the committed state, with its slope.
  Attempt attempt(const ValueAndSlope& strain, const Vector4& trial, double kappa) const;

  ElasticModuli elastic_;
  StrengthPath path_;
  Matrix4 D_elastic_;
};

MaterialEntry mohr_coulomb_softening_entry();

}  // namespace sage
