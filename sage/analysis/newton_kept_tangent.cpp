#include "sage/analysis/line_search.hpp"

namespace sage {

// With a tangent that is kept, corrections are small because they are many: a small residual may leave most of the change
// to come.  The tangent of the place reached tells how much, and Newton's method takes the rest.
void finish_with_newton(StepIteration& step) {
  constexpr int kMost = 10;
  constexpr double kRest = 3e-3;  // of the increment
  NewtonStep& result = step.result;
  result.finished = true;
  result.outcome = StepOutcome::not_converged;
  for (int i = 0; i < kMost; ++i) {
    if (step.form_tangent() == Outcome::cut_step) return;
    const double old_norm = step.residual_size();
    step.solve();
    step.advance();
    if (step.assemble(false) == Outcome::cut_step || !search_zero_slope(step, old_norm)) return;
    if (step.is_hopeless()) return;
    if (step.converged() && result.iterations.back().displacement * step.step_length <= kRest) return;
    result.outcome = StepOutcome::not_converged;
  }
}

}  // namespace sage
