// Soil whose pore water can't leave: a law around that of the grains.
#pragma once

#include "sage/core/calls_in_order.hpp"
#include "sage/core/law.hpp"
#include "sage/core/law_remark.hpp"
#include "sage/core/start_adjustment.hpp"
#include "sage/model/law_table.hpp"

namespace sage {

// Behind the history of the grains' law three quantities: the excess pore pressure p, the bulk K of the water over
// the porosity, which is 0 while the group is drained, and e + p / K, e being the change of volume since it was
// shut in (tension +).  The stress that equilibrium sees is sigma' - p [1 1 1 0]; the grains' law sees sigma' alone.
// p grows by -K times the change of volume.  Water stiffer than 1e8 shear moduli (at zero stress, where the law has
// one) is held by a multiplier: p grows by -B (e + p / K) with B = 1e8 G, so that what is left of an increment's
// change of volume, (growth of p) / B, is taken out by the next one, and no digits are lost.
// docs/decisions/0029-stiff-water.md
class UndrainedLaw final : public SolidLaw,
                           public PathError<4>,
                           public StartAdjustment<4>,
                           public LawRemark,
                           public CallsInOrder,
                           public ChoosesLaw<4> {
 public:
  static constexpr std::size_t kOwn = 3;

  explicit UndrainedLaw(std::unique_ptr<SolidLaw> grains);

  LawTraits traits() const override {
    return {.history = quantities_,
            .symmetric = grains_->traits().symmetric,
            .wants_context = grains_->traits().wants_context};
  }
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const override;
  std::string caution() const override { return grains_->caution(); }
  std::string remark() const override { return remark_of(*grains_); }
  bool needs_order() const override { return sage::needs_order(*grains_); }
  // Of the effective stress; no excess pressure stands at the start.
  bool adjusts_start(const Vector4& sigma) const override { return sage::adjusts_start(*grains_, sigma); }
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  // Of the grains, at the effective stress; their law must be one that chooses.
  bool choose(int law, bool anew, const Vector4& sigma, std::span<double> h) const override;

  // Place of p in the history; those of the bulk and of e + p / K come next.
  std::size_t excess() const { return quantities_.size() - kOwn; }

 private:
  Vector4 effective(const Vector4& sigma, std::span<const double> h) const;

  std::unique_ptr<SolidLaw> grains_;
  std::vector<Quantity> quantities_;
  double stiffest_;  // B
};

// A solid's law within an UndrainedLaw where asked.
LawPtr with_water(LawPtr law, bool undrained);

// Bulk of water over porosity that gives an elastic law this undrained Poisson's ratio at zero stress (1/2: none that
// gives way); NaN where the law is no isotropic one or has no such ratio above its own.
double bulk_for(const SolidLaw& law, double nu_u);

}  // namespace sage
