// The update of drucker_prager.hpp for four points side by side, to the last bit.  Every branch is computed for those
// points that need it; the order of operations is that of DruckerPrager::update.
#pragma once

#include "materials/drucker_prager.hpp"
#include "sage/core/four_at_a_time.hpp"

namespace sage {

class DruckerPragerFour final : public DruckerPrager, public FourPointLaw<4> {
 public:
  using DruckerPrager::DruckerPrager;
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override;

 private:
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
};

}  // namespace sage
