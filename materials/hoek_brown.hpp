// Hoek-Brown, elastic - perfectly plastic, generalised criterion, optional tension cut-off.
// docs/theory/hoek_brown.md
#pragma once

#include <array>

#include "materials/linear_elastic.hpp"
#include "materials/mohr_coulomb_return.hpp"
#include "materials/rising_zero.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"

namespace sage {

// With s1 >= s2 >= s3, tension positive:  f = s1 - s3 - sigma_ci (s - m s1/sigma_ci)^a <= 0.
struct HoekBrownStrength {
  double sigma_ci;  // uniaxial compressive strength of the intact rock           [stress]
  double m, s, a;   // of the rock mass; m > 0, s >= 0, .5 <= a <= 1              [-]
  double flow;      // 0 no plastic volume change, 1 associated                   [-]
  double T;         // tension cut-off, at most tip()                             [stress]

  double tip() const { return s * sigma_ci / m; }  // the strength in even tension
  // x = (s - m s1/sigma_ci)^a says which point of the criterion: s1 - s3 = sigma_ci x.
  double place(double s1) const;
  // The planes of Mohr and Coulomb that touch the criterion at x > 0, and their change with x, in stresses that
  // count from the tip.
  MovingPlanes touching(double x) const;
};

class HoekBrown final : public ElasticShear {
 public:
  HoekBrown(const ElasticModuli& elastic, const HoekBrownStrength& strength)
      : elastic_(elastic), strength_(strength), D_elastic_(elastic_matrix(elastic)) {}
  // As those of Mohr-Coulomb.
  static constexpr std::array<Quantity, 2> kHistory{
      {{"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  LawTraits traits() const override { return {.history = kHistory, .symmetric = strength_.flow == 1.0}; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  double shear_modulus(const Vector4& /*sigma*/, std::span<const double> /*h*/) const override {
    return elastic_.G;
  }

 private:
  enum { kShear, kVolume };
  struct Attempt {
    MovedReturn moved;
    ValueAndSlope lack;  // of the place x: s1 of the return less that of the place
  };
  Attempt attempt(const Vector4& trial, double x) const;
  void return_to_tip(const Vector4& trial, PointOut<4>& out) const;

  ElasticModuli elastic_;
  HoekBrownStrength strength_;
  Matrix4 D_elastic_;
};

MaterialEntry hoek_brown_entry();

}  // namespace sage
