#include "sage/analysis/step_iteration.hpp"

namespace sage {

bool IterationPolicy::begin(StepIteration& step, const Eigen::VectorXd& rate) {
  return step.predict(rate);
}

bool IterationPolicy::makes_K(const StepIteration& step, Pass /*pass*/) const {
  return step.full_newton();
}

bool IterationPolicy::needs_K(const StepIteration& step, double /*norm*/, double /*old_norm*/) const {
  return step.full_newton() && !step.K_is_here;
}

bool IterationPolicy::gives_up(const StepIteration& /*step*/) const {
  return false;
}

void IterationPolicy::end(StepIteration& /*step*/) {}

}  // namespace sage
