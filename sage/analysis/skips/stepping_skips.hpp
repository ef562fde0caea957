// The skips 'repeats', 'prediction' and 'contraction' from step to step: which of them wrap the iterations of an attempt.
#pragma once

#include "sage/analysis/skips/contraction.hpp"
#include "sage/analysis/skips/prediction.hpp"
#include "sage/analysis/skips/repeats.hpp"
#include "sage/analysis/stepping_policy.hpp"

namespace sage {

class SteppingSkips final : public SteppingPolicy {
 public:
  explicit SteppingSkips(const Skips& skips) : skips_(skips) {}

  void prepare(const RunParts& run, double size, NewtonSettings& settings) override;
  bool begins_elsewhere(const RunParts& run, double size) const override;
  void accept(const RunParts& run, const NewtonStep& step, double size, bool cut) override;
  void fail() override { prediction_.fail(); }
  void forget(Past past) override;
  void exchange(Archive& archive) override;

 private:
  bool contracts(const RunParts& run) const;
  bool predicts(const RunParts& run) const;
  bool can_repeat(const RunParts& run, double size) const;

  Skips skips_;
  Repeats repeats_;
  Prediction prediction_;  // the last step is RunState::du
  IterationPolicy plain_;
  ContractingIteration contracting_;
  PredictedIteration predicted_;
  RepeatedStep repeated_;
};

}  // namespace sage
