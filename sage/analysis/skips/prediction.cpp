#include "sage/analysis/skips/prediction.hpp"

#include <cmath>

namespace sage {

// As StepIteration::predict() for a step that is near by, but all is measured by what the last step was.
bool PredictedIteration::begin(StepIteration& step, const Eigen::VectorXd& rate) {
  if (!step.start_known) step.measures.take_start();
  step.take_prescribed(rate);
  if (step.form_tangent() == Outcome::cut_step) return false;
  step.form_residual();
  step.solve();
  if (step.tangent.sizes().norm1() >= 0.0) {  // the solver keeps K
    const Eigen::VectorXd way = step.free_part_of_du();
    step.result.predicted_work = step.measures.take_first(way, step.tangent.sizes().times(way));
  } else {
    step.result.predicted_work = step.measures.take_first(step.correction, step.residual);
  }
  step.measures.take_prescribed(rate, step.rate_part);
  step.move(1.0);
  return true;
}

namespace {

// Quadratic convergence leaves less than the tolerance then: the next step starts with its own K, and the factors at hand
// are still those of the K that the solver holds.
bool ends_with_next_correction(const StepIteration& step) {
  const std::vector<IterationRecord>& done = step.result.iterations;
  return !done.empty() && done.back().force <= std::sqrt(step.settings.tolerance);
}

}  // namespace

bool PredictedIteration::makes_K(const StepIteration& step, Pass pass) const {
  const bool ends = pass == Pass::correction && ends_with_next_correction(step);
  return !ends && WrappedPolicy::makes_K(step, pass);
}

// The direction leads nowhere: the residual does not become ten times smaller in five corrections.
bool PredictedIteration::gives_up(const StepIteration& step) const {
  constexpr std::size_t kPatience = 5;
  constexpr double kNearer = 0.1;
  const std::vector<IterationRecord>& done = step.result.iterations;
  if (done.size() % kPatience != 0) return false;
  return !(done.back().force <= kNearer * done[done.size() - kPatience].force);
}

// Some iterations from there end just within the tolerance, where those from the committed state jump far below it.  One
// more correction makes them as good: where factors are at hand for a solution and a force pass.
void PredictedIteration::end(StepIteration& step) {
  const double far = (step.tangent.factorised() ? 1e-3 : 1e-2) * step.settings.tolerance;
  if (step.result.iterations.back().force <= far) return;
  const double old_norm = step.residual_size();
  step.solve();
  for (const double way : {1.0, -1.0}) {  // back again, if it helps nothing
    step.move(way);
    if (step.assemble(false) == Outcome::ok && step.residual_size() <= old_norm) break;
  }
  step.converged();
}

}  // namespace sage
