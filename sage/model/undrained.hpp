// Soil whose pore water can't leave: a law around that of the grains.
#pragma once

#include "sage/core/law.hpp"

namespace sage {

// Behind the history of the grains' law two quantities: the excess pore pressure p and the bulk of the water over
// the porosity, which is 0 while the group is drained.  The stress that equilibrium sees is sigma' - p [1 1 1 0];
// the grains' law sees sigma' alone.  p grows by -bulk times the change of volume (tension +).
class UndrainedLaw final : public SolidLaw {
 public:
  static constexpr std::size_t kOwn = 2;

  explicit UndrainedLaw(std::unique_ptr<SolidLaw> grains);

  std::span<const Quantity> history() const override { return quantities_; }
  bool symmetric() const override { return grains_->symmetric(); }
  bool wants_context() const override { return grains_->wants_context(); }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const override;
  std::string caution() const override { return grains_->caution(); }
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;

  // Place of p in the history; that of the bulk comes next.
  std::size_t excess() const { return quantities_.size() - kOwn; }

 private:
  Vector4 effective(const Vector4& sigma, std::span<const double> h) const;

  std::unique_ptr<SolidLaw> grains_;
  std::vector<Quantity> quantities_;
};

// A solid's law within an UndrainedLaw where asked.
LawPtr with_water(LawPtr law, bool undrained);

// Shear modulus of a law at zero stress; NaN where it has none there.
double shear_modulus(const SolidLaw& law);

// Bulk of water over porosity that gives an elastic law this undrained Poisson's ratio at zero stress; NaN where the
// law is no isotropic one or has no such ratio above its own.
double bulk_for(const SolidLaw& law, double nu_u);

}  // namespace sage
