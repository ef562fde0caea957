#include <limits>

#include "sage/analysis/dogleg.hpp"
#include "sage/analysis/step_iteration.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// A rejected correction leaves K and its factors as they were: only the residual is computed anew.
void iterate_with_dogleg(StepIteration& step) {
  const KeptMatrix* const K = step.tangent.sizes().matrix();
  if (K == nullptr)
    throw AnalysisError("the solver " + std::string(step.tangent.solver().traits().name) +
                        " keeps no matrix, which method 3 (dogleg) needs");
  Dogleg dogleg;
  if (step.assemble(step.full_newton()) == Outcome::cut_step) return;
  Eigen::VectorXd newton(step.residual.size()), old_residual(step.residual.size());
  for (int i = 1; i <= step.settings.max_iterations; ++i) {
    if (step.is_hopeless() || step.converged()) return;
    step.solve();
    newton = step.correction;
    step.measures.take_energy(newton, step.residual);
    old_residual = step.residual;
    dogleg.choose(*K, step.residual, newton, step.correction);
    step.step_length = dogleg.step_length();
    step.move(1.0);
    const bool computed = step.assemble(false) == Outcome::ok;
    const double new_norm = computed ? step.residual.norm() : std::numeric_limits<double>::infinity();
    if (!dogleg.accept(old_residual.norm(), new_norm)) {
      step.move(-1.0);
      step.residual = old_residual;
      continue;
    }
    if (step.full_newton() && step.form_tangent() == Outcome::cut_step) return;
  }
  step.result.outcome = StepOutcome::not_converged;
}

}  // namespace sage
