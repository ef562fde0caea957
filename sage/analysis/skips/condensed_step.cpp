#include "sage/analysis/skips/condensed_step.hpp"

#include <cmath>

#include "sage/analysis/step_iteration.hpp"

namespace sage {

CondensedStep::CondensedStep(CondensedAssembly& assembly, const Eigen::VectorXd& target, double rate_part,
                             const StageSoFar& so_far)
    : IteratedStep(assembly), all_(assembly), region_(*assembly.condensation_) {
  const Profile::Scope scope(all_.work_->profile, phase::kCondensation);
  all_.region_step_ = CondensedAssembly::RegionStep::open;
  if (!region_.predictor().is_behind()) all_.take_constant_force();
  region_.begin_step(rate_part, so_far, target, all_.constant_force_, kRegionRounding * all_.force_scale(0));
  all_.internal_ = all_.changing_.forces();
  region_.add_start_forces(all_.internal_);
}

Outcome CondensedStep::iterate(const Eigen::VectorXd& du, Tangent* tangent) {
  return all_.evaluate_with_border(du, tangent);
}

void CondensedStep::complete(Eigen::VectorXd& du) {
  const Profile::Scope scope(all_.work_->profile, phase::kCondensation);
  all_.fill_in(du, all_.internal_);
  region_.set_base(all_.internal_, all_.changing_.forces(), du);
  all_.region_step_ = CondensedAssembly::RegionStep::filled_in;
}

bool CondensedStep::must_fill_in() const {
  const bool is_filled_in = all_.region_step_ == CondensedAssembly::RegionStep::filled_in;
  return is_filled_in || !all_.skips_.states || !region_.predictor().may_wait();
}

bool CondensedStep::wait(const Eigen::VectorXd& du, double out_of_balance, double limit) {
  constexpr double kFarBelow = 1e-3;
  if (must_fill_in()) return false;
  const double most = limit * std::sqrt(all_.changing_.sums()[0] + region_.predictor().least_force_squares());
  if (!(out_of_balance <= most) || !(region_.rounding(du) <= kFarBelow * most)) return false;
  all_.region_step_ = CondensedAssembly::RegionStep::waits;
  return true;
}

IterationRecord CondensedStep::measure_whole(StepIteration& step) {
  complete(step.du);
  step.form_residual();
  IterationRecord record = step.measure();
  const double size = region_.step_norm(step.du), tolerance = step.settings.tolerance;
  // The displacement counts where the energy does not decide.
  if (record.energy > tolerance * tolerance && size > 0.0)
    record.displacement = region_.whole_norm(step.correction) / size;
  return record;
}

IterationRecord CondensedStep::measure(StepIteration& step) {
  // The scale of a condensed region's forces is that of an earlier step, or of what was before the stage.
  const double rough = region_.predictor().begins_stage() ? 10.0 : 2.5;
  const double tolerance = step.settings.tolerance;
  const IterationRecord record = step.measure();
  const bool balanced = step.is_in_equilibrium(record);
  const bool near = must_fill_in() && record.force <= rough * tolerance;
  const bool proved = balanced && wait(step.du, step.residual.norm(), tolerance);
  return (balanced || near) && !proved ? measure_whole(step) : record;
}

}  // namespace sage
