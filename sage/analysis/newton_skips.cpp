#include "sage/analysis/newton_skips.hpp"

#include <cmath>

namespace sage {

bool repeat_step(StepIteration& step) {
  if (!step.tangent.current()) return false;
  const double most = step.settings.repeat;
  step.measures.take_start();
  step.form_residual();
  step.start_residual = step.residual;
  step.start_known = true;
  if (const Condensation* region = step.assembly.condensation())
    for (const int dof : region->condensed_dofs()) step.du[dof] = 0.0;  // complete() recovers their motion
  if (step.assemble(false) == Outcome::cut_step) return false;
  step.correction.setZero(step.assembly.equations());
  IterationRecord record = step.measure();
  if (!(record.force <= most)) return false;
  if (!step.pass.wait(step.du, step.residual.norm(), most)) record = step.measure_whole();
  if (!(record.force <= most)) return false;
  step.result.iterations.push_back(record);
  step.result.worst = step.measures.worst(step.residual);
  step.result.outcome = StepOutcome::converged;
  step.result.repeated = true;
  ++step.work.repeats;
  return true;
}

// Quadratic convergence leaves less than the tolerance then: the next step starts with its own K, and the factors at hand
// are still those of the K that the solver holds.
bool ends_with_next_correction(const StepIteration& step) {
  const std::vector<IterationRecord>& done = step.result.iterations;
  return step.settings.start == NewtonStart::last_way && !done.empty() &&
         done.back().force <= std::sqrt(step.settings.tolerance);
}

bool strays(const StepIteration& step) {
  constexpr std::size_t kPatience = 5;
  constexpr double kNearer = 0.1;
  const std::vector<IterationRecord>& done = step.result.iterations;
  if (step.settings.start != NewtonStart::last_way || done.size() % kPatience != 0) return false;
  return !(done.back().force <= kNearer * done[done.size() - kPatience].force);
}

// Some iterations from there end just within the tolerance, where those from the committed state jump far below it.  One
// more correction makes them as good: where factors are at hand for a solution and a force pass.
void polish(StepIteration& step) {
  const double far = (step.tangent.factorised() ? 1e-3 : 1e-2) * step.settings.tolerance;
  if (step.settings.start != NewtonStart::last_way || step.result.iterations.back().force <= far) return;
  const double old_norm = step.residual_size();
  step.solve();
  for (const double way : {1.0, -1.0}) {  // back again, if it helps nothing
    step.move(way);
    if (step.assemble(false) == Outcome::ok && step.residual_size() <= old_norm) break;
  }
  step.converged();
}

}  // namespace sage
