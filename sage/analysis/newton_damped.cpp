#include <algorithm>

#include "sage/analysis/creep.hpp"
#include "sage/analysis/step_iteration.hpp"

namespace sage {

namespace {

constexpr double kLeastDamping = 1e-13;

double damping_growth(const StepIteration& step, const Eigen::VectorXd& old_residual, double old_norm) {
  constexpr double kGrows = 1.5, kJump = 4.0, kBeyond = 0.5, kStays = 0.95, kTurned = 0.9;
  const Eigen::VectorXd& residual = step.residual;
  const double norm = step.residual_size(), ratio = old_norm > 0.0 ? norm / old_norm : 1.0;
  const bool turned = residual.dot(old_residual) < kTurned * residual.norm() * old_residual.norm();
  const bool beyond = step.work_left() < -kBeyond * step.slope;
  if (beyond && turned && ratio > kStays) return kJump;
  return ratio > kGrows ? std::min(ratio, kJump) : std::min(ratio, step.settings.damping_fall);
}

// A law may have no answer so far away.
bool assemble_or_halve(StepIteration& step) {
  constexpr int kTrials = 6;
  step.step_length = 1.0;
  for (int trial = 0; step.assemble(true) == Outcome::cut_step; ++trial) {
    if (trial == kTrials) return false;
    step.move(-0.5 * step.step_length);
    step.step_length *= 0.5;
  }
  return true;
}

}  // namespace

// The elastic stiffness is above every tangent: corrections held back by all of it lead towards equilibrium where Newton's
// own jump to and fro between states of joints, or find a matrix without stiffness in a direction.  Its share falls as
// long as corrections go on in one direction, so that they end as Newton's; what nothing holds runs away with it.  It
// grows where the residual grows by half, or turns while a correction goes too far.
void iterate_damped(StepIteration& step) {
  Creep creep(*step.settings.of_solids, step.settings.size);
  creep.take(step.du, step.residual_size());
  step.slope = step.work_left();
  for (int i = 1; i <= step.settings.max_iterations; ++i) {
    const double old_norm = step.residual_size();
    const Eigen::VectorXd old_residual = step.residual;
    if (!assemble_or_halve(step)) return;
    if (i > 1) step.damping *= damping_growth(step, old_residual, old_norm);
    step.damping = std::clamp(step.damping, kLeastDamping, 1.0);
    creep.take(step.du, step.residual_size());
    step.result.flows = step.is_hopeless() || creep.flows();
    if (!step.result.flows && step.converged()) return;
    if (step.result.flows || creep.is_shaken() || i == step.settings.max_iterations) break;
    step.solve();
    step.advance();
  }
  step.result.spares_ground = creep.spares_ground();
  step.result.outcome = StepOutcome::not_converged;
}

}  // namespace sage
