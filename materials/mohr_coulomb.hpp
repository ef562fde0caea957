// Mohr-Coulomb, elastic - perfectly plastic, any dilation, optional tension cut-off.
// docs/theory/mohr_coulomb.md
#pragma once

#include <array>

#include "materials/linear_elastic.hpp"
#include "materials/mohr_coulomb_return.hpp"
#include "materials/parameters.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"

namespace sage {

// Angles in radians.  T: tension cut-off, infinite for none.  phi = 0 is Tresca.
MohrCoulombPlanes mohr_coulomb_planes(double c, double phi, double psi, double T);

// (s1 - s3) / (2 c cos phi - (s1 + s3) sin phi), tension positive, or s1/T if that is larger; 1 at the apex.
double mohr_coulomb_level(const MohrCoulombPlanes& planes, const Vector4& sigma);

class MohrCoulomb final : public ElasticShear {
 public:
  MohrCoulomb(const ElasticModuli& elastic, const MohrCoulombPlanes& planes)
      : elastic_(elastic), planes_(planes), D_elastic_(elastic_matrix(elastic)) {}
  // Sums of sqrt(2 de_p:de_p) and of the plastic volume strain (+ dilates).
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = planes_.N == planes_.M}; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  std::string caution() const override {
    if (planes_.Y > 0.0 || planes_.N > 1.0) return {};
    return "cohesion and friction are zero: the material has no shear strength, any shear makes it a mechanism";
  }
  double stress_level(const Vector4& sigma, std::span<const double> /*h*/) const override {
    return mohr_coulomb_level(planes_, sigma);
  }
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return elastic_.G;
  }

 private:
  enum { kShear, kVolume };
  ElasticModuli elastic_;
  MohrCoulombPlanes planes_;
  Matrix4 D_elastic_;
};

MaterialEntry mohr_coulomb_entry();

}  // namespace sage
