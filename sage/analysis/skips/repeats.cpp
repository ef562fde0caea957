#include "sage/analysis/skips/repeats.hpp"

#include "sage/analysis/skips/condensed_step.hpp"

namespace sage {

bool RepeatedStep::begin(StepIteration& step, const Eigen::VectorXd& rate) {
  done_ = try_it(step);
  return !done_ && WrappedPolicy::begin(step, rate);
}

// It costs one force pass.
bool RepeatedStep::try_it(StepIteration& step) const {
  if (!step.tangent.current()) return false;
  step.measures.take_start();
  step.form_residual();
  step.start_residual = step.residual;
  step.start_known = true;
  auto* const condensed = dynamic_cast<CondensedStep*>(step.pass.get());
  for (const int dof : step.assembly.eliminated().dofs())
    step.du[dof] = 0.0;  // complete() recovers their motion
  if (step.assemble(false) == Outcome::cut_step) return false;
  step.correction.setZero(step.assembly.equations());
  IterationRecord record = step.measure();
  if (!(record.force <= limit_)) return false;
  if (condensed != nullptr && !condensed->wait(step.du, step.residual.norm(), limit_))
    record = condensed->measure_whole(step);
  if (!(record.force <= limit_)) return false;
  step.result.iterations.push_back(record);
  step.result.worst = step.measures.worst(step.residual);
  step.result.outcome = StepOutcome::converged;
  step.result.force_left = record.force;
  ++step.work.repeats;
  return true;
}

}  // namespace sage
