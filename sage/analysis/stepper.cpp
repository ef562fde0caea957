#include "sage/analysis/stepper.hpp"

#include <algorithm>

namespace sage {

namespace {

constexpr int kDampedIterations = 200;  // of a damped attempt, at least
// What is put in comes out to ten digits.
constexpr double kWaterBalance = 1e-11;
constexpr int kManyHeads = 20000;  // their rounding errors have one sign and add up

}  // namespace

bool Stepper::contracts() const {
  return run_.settings.skips.contraction && run_.stage().method == Method::newton &&
         !run_.tangent().constant() && is_large(run_.assembly().equations());
}

bool Stepper::predicts() const {
  return run_.settings.skips.prediction && run_.stage().method == Method::newton && !run_.tangent().linear() &&
         run_.assembly().condensation() == nullptr && run_.assembly().dof_map().only_displacement();
}

bool Stepper::starts_from_last_step(double size) const {
  const StagePath& path = run_.state.path;
  return path.prediction.due() && predicts() && !path.repeats.due(size);
}

// In a small linear scene a correction with kept factors costs little, and removes the rounding of the steps before, which
// a repetition keeps.
bool Stepper::can_repeat(double size) const {
  const Method method = run_.stage().method;
  const bool newton = method == Method::newton || method == Method::dogleg;
  const bool pays = !run_.tangent().constant() || (!flow_alone_ && is_large(run_.assembly().equations()));
  const bool flows = run_.stage().pores == PoreWater::flows;  // whatever loads do
  return run_.settings.skips.repeats && !flows && newton && pays && run_.state.path.repeats.due(size);
}

NewtonSettings Stepper::settings() const {
  constexpr int kShort = 50;  // iterations of a finer attempt
  const Stage& stage = run_.stage();
  NewtonSettings newton{newton_ != Newton::by_stage ? Method::newton : stage.method, stage.max_iterations,
                        stage.tolerance, run_.settings.line_search};
  if (newton_ == Newton::finer) {
    newton.tolerance *= 0.01;
    newton.max_iterations = std::min(newton.max_iterations, kShort);
  }
  newton.pulse = run_.settings.pulse;
  newton.committed = &run_.state.u;
  newton.unknowns = &run_.model.unknowns;
  newton.size = run_.extent.size();
  if (flow_alone_ && run_.state.easing == 1.0) {
    newton.tolerance = std::min(stage.tolerance, kWaterBalance);
    newton.refine = run_.assembly().equations() >= kManyHeads;
  }
  return newton;
}

NewtonStep Stepper::attempt(double from, double to, Begin begin) {
  const double size = to - from;
  StagePath& path = run_.state.path;
  NewtonSettings newton = settings();
  if (begin == Begin::here) newton.start = NewtonStart::nearby;
  if (begin == Begin::committed && starts_from_last_step(size)) {
    newton.start = NewtonStart::last_way;
    run_.state.du *= size / path.last_size;
  }
  if (can_repeat(size)) newton.repeat = path.repeats.limit(newton.tolerance, run_.tangent().constant());
  newton.contract = contracts();
  newton.stop_at_flow = run_.settings.trials != nullptr;
  return solve(from, to, newton);
}

NewtonStep Stepper::attempt_damped(double from, double to, const Damping& damping) {
  NewtonSettings newton = settings();
  newton.start = NewtonStart::nearby;
  newton.damping_fall = damping.fall;
  newton.of_solids = damping.of_solids;
  newton.max_iterations = std::max(kDampedIterations, 5 * run_.stage().max_iterations);
  return solve(from, to, newton);
}

NewtonStep Stepper::attempt_near(double at) {
  constexpr int kFew = 10;  // iterations
  NewtonSettings newton = settings();
  newton.method = Method::newton;
  newton.max_iterations = kFew;
  return solve(at, at, newton);
}

NewtonStep Stepper::solve(double from, double to, const NewtonSettings& settings) {
  RunState& state = run_.state;
  state.target = run_.loads_at(to);
  run_.set_step_time(to, to - from);
  NewtonSettings newton = settings;
  if (state.path.u_start.size() > 0) newton.so_far = {from, &state.path.u_start, &state.u};
  const Profile::Scope scope(run_.profile(), phase::kIteration);
  return newton_step(run_.assembly(), run_.tangent(), state.target, run_.system.rate(), to - from, newton,
                     run_.result.work, state.du);
}

}  // namespace sage
