#include "sage/analysis/newton.hpp"

#include "sage/analysis/acceleration.hpp"
#include "sage/analysis/line_search.hpp"
#include "sage/analysis/step_iteration.hpp"

namespace sage {

namespace {

// Corrections leave more unbalanced than there was, and a good part of all stress: no equilibrium is near.  The second rule
// is for steps that begin with as much.
bool flows(const StepIteration& step) {
  constexpr double kMuch = 0.4, kTimes = 3.0;
  constexpr std::size_t kPatience = 12;
  const std::vector<IterationRecord>& done = step.result.iterations;
  if (!step.settings.stop_at_flow || done.empty()) return false;
  const double first = done.front().force, last = done.back().force;
  return last > kMuch && (last > kTimes * first || (done.size() >= kPatience && last >= first));
}

void finish(StepIteration& step) {
  constexpr double kLoose = 1e-6;  // tolerance above which a kept tangent alone ends no step
  if (step.accelerated() && step.settings.tolerance > kLoose)
    finish_with_newton(step);
  else
    step.policy.end(step);
}

// Newton's method.  With a tangent that is not that of the iterate (modified Newton, initial stiffness) earlier corrections
// improve the next one; a correction that made things worse starts that anew.
void iterate(StepIteration& step) {
  Acceleration acceleration;
  double old_norm = step.residual_size();
  if (step.accelerated()) acceleration.improve(step.correction);
  for (int i = 1; i <= step.settings.max_iterations; ++i) {
    const bool with_K = step.policy.makes_K(step, IterationPolicy::Pass::correction);
    if (step.assemble(with_K) == Outcome::cut_step || !search_line(step, i, old_norm)) return;
    if (step.is_hopeless()) {
      step.result.flows = step.settings.stop_at_flow;
      return;
    }
    if (step.converged()) return finish(step);
    step.result.flows = flows(step);
    if (step.result.flows || step.policy.gives_up(step) || i == step.settings.max_iterations) break;
    const double norm = step.residual_size();
    if (step.policy.needs_K(step, norm, old_norm) && step.form_tangent() == Outcome::cut_step) return;
    step.solve();
    if (step.accelerated()) {
      if (norm > 2.0 * old_norm) acceleration.restart();
      acceleration.improve(step.correction);
    }
    old_norm = norm;
    step.advance();
  }
  step.result.outcome = StepOutcome::not_converged;
}

}  // namespace

NewtonStep newton_step(Assembly& assembly, Tangent& tangent, const Eigen::VectorXd& target,
                       const Eigen::VectorXd& rate, double rate_part, const NewtonSettings& settings,
                       WorkCounters& work, Eigen::VectorXd& du) {
  try {
    StepIteration step(assembly, tangent, target, rate_part, settings, work, du);
    if (!step.policy.begin(step, rate)) return step.result;
    if (settings.damping_fall > 0.0)
      iterate_damped(step);
    else if (settings.method == Method::dogleg)
      iterate_with_dogleg(step);
    else
      iterate(step);
    return step.result;
  } catch (const SingularMatrix& error) {
    NewtonStep result;
    result.outcome = StepOutcome::singular;
    result.singular_equation = error.equation();
    result.message = error.what();
    return result;
  }
}

}  // namespace sage
