// A policy around another one: it passes on what it does not change.
#pragma once

#include "sage/analysis/step_iteration.hpp"

namespace sage {

class WrappedPolicy : public IterationPolicy {
 public:
  // It must outlive the step.
  void wrap(IterationPolicy& inner) { inner_ = &inner; }

  bool begin(StepIteration& step, const Eigen::VectorXd& rate) override { return inner_->begin(step, rate); }
  bool makes_K(const StepIteration& step, Pass pass) const override { return inner_->makes_K(step, pass); }
  bool needs_K(const StepIteration& step, double norm, double old_norm) const override {
    return inner_->needs_K(step, norm, old_norm);
  }
  bool gives_up(const StepIteration& step) const override { return inner_->gives_up(step); }
  void end(StepIteration& step) override { inner_->end(step); }

 private:
  IterationPolicy* inner_ = nullptr;
};

}  // namespace sage
