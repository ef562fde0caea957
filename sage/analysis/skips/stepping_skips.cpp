#include "sage/analysis/skips/stepping_skips.hpp"

#include "sage/analysis/run_parts.hpp"

namespace sage {

bool SteppingSkips::contracts(const RunParts& run) const {
  return skips_.contraction && run.stage().method == Method::newton && !run.tangent().constant() &&
         is_large(run.assembly().equations()) && !linear_in_step(run.assembly());
}

bool SteppingSkips::predicts(const RunParts& run) const {
  return skips_.prediction && run.stage().method == Method::newton && !run.tangent().linear() &&
         run.assembly().eliminated().dofs().empty() && run.assembly().dof_map().only_displacement();
}

bool SteppingSkips::begins_elsewhere(const RunParts& run, double size) const {
  return prediction_.due() && predicts(run) && !repeats_.due(size);
}

// In a small linear scene a correction with kept factors costs little, and removes the rounding of the steps before, which
// a repetition keeps.
bool SteppingSkips::can_repeat(const RunParts& run, double size) const {
  const Method method = run.stage().method;
  const bool newton = method == Method::newton || method == Method::dogleg;
  const bool flows = run.stage().pores == PoreWater::flows;  // whatever loads do
  if (!skips_.repeats || flows || !newton || !repeats_.due(size)) return false;
  return !run.tangent().constant() || (!is_flow_alone(run.model) && is_large(run.assembly().equations()));
}

void SteppingSkips::prepare(const RunParts& run, double size, NewtonSettings& settings) {
  IterationPolicy* policy = &plain_;
  const auto wrap = [&](WrappedPolicy& outer) {
    outer.wrap(*policy);
    policy = &outer;
  };
  repeated_.forget();
  if (contracts(run)) wrap(contracting_);
  if (settings.start == NewtonStart::committed && begins_elsewhere(run, size)) {
    run.state.du *= size / run.state.path.last_size;
    wrap(predicted_);
  }
  if (can_repeat(run, size)) {
    repeated_.set_limit(repeats_.limit(settings.tolerance, run.tangent().constant()));
    wrap(repeated_);
  }
  settings.policy = policy;
}

void SteppingSkips::accept(const RunParts& run, const NewtonStep& step, double size, bool cut) {
  // Factors that were kept are behind the step: the next one starts with K of its end.
  if (contracts(run) && !predicts(run)) run.assembly().evaluate(run.state.du, &run.tangent());
  const bool same_K = run.tangent().constant() || !run.tangent().changed();
  const bool linear = step.iterations.size() == 1 && same_K;
  if (!repeated_.done()) repeats_.take(linear, size, step.iterations.back().force);
  prediction_.take(cut);
}

void SteppingSkips::forget(Past past) {
  repeated_.forget();
  repeats_.forget();
  if (past == Past::stage)
    prediction_ = {};
  else
    prediction_.forget();
}

void SteppingSkips::exchange(Archive& archive) {
  repeats_.exchange(archive);
  prediction_.exchange(archive);
}

}  // namespace sage
