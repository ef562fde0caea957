// The skip 'contraction': in large systems Newton keeps its factors while they contract well.
#pragma once

#include "sage/analysis/skips/wrapped_policy.hpp"

namespace sage {

class ContractingIteration final : public WrappedPolicy {
 public:
  bool makes_K(const StepIteration& /*step*/, Pass /*pass*/) const override { return false; }
  bool needs_K(const StepIteration& /*step*/, double norm, double old_norm) const override {
    constexpr double kGoodContraction = 0.2;
    return norm > kGoodContraction * old_norm;
  }
};

}  // namespace sage
