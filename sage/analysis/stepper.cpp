#include "sage/analysis/stepper.hpp"

#include <algorithm>

#include "sage/analysis/dogleg.hpp"
#include "sage/analysis/load_control.hpp"

namespace sage {

namespace {

constexpr int kDampedIterations = 200;  // of a damped attempt, at least
// What is put in comes out to ten digits.
constexpr double kWaterBalance = 1e-11;
constexpr int kManyHeads = 20000;  // their rounding errors have one sign and add up

}  // namespace

NewtonSettings Stepper::settings() const {
  constexpr int kShort = 50;  // iterations of a finer attempt
  const Stage& stage = run_.stage();
  NewtonSettings newton{newton_ != Newton::by_stage ? Method::newton : stage.method, stage.max_iterations,
                        stage.tolerance, run_.settings.line_search};
  if (newton_ == Newton::finer) {
    newton.tolerance *= 0.01;
    newton.max_iterations = std::min(newton.max_iterations, kShort);
  }
  newton.tolerance = held_tolerance(newton.method, newton.tolerance);
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
  NewtonSettings newton = settings();
  newton.stop_at_flow = run_.settings.trials != nullptr;
  if (run_.stage().has_histories()) run_.state.path.policy->forget(SteppingPolicy::Past::last_step);
  if (begin == Begin::here) newton.start = NewtonStart::nearby;
  if (!run_.stage().is_controlled()) run_.state.path.policy->prepare(run_, to - from, newton);
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
  if (run_.stage().is_controlled()) return solve_controlled(from, to, settings);
  state.target = run_.loads_at(to);
  if (to > from && run_.stage().has_histories()) run_.system.take_histories(run_.stage(), from, to);
  run_.set_step_time(to, to - from);
  NewtonSettings newton = settings;
  if (state.path.u_start.size() > 0) newton.so_far = {from, &state.path.u_start, &state.u};
  const Profile::Scope scope(run_.profile(), phase::kIteration);
  return newton_step(run_.assembly(), run_.tangent(), state.target, run_.system.rate(), to - from, newton,
                     run_.result.work, state.du);
}

// A shorter correction would neither have the displacement that is given nor the load that goes with it.
NewtonStep Stepper::solve_controlled(double from, double to, const NewtonSettings& settings) {
  RunState& state = run_.state;
  state.target = run_.loads_at(state.path.load_share);
  ControlledLoad control(run_, to, state.target);
  NewtonSettings newton = settings;
  newton.control = &control;
  newton.line_search = false;
  run_.set_step_time(to, to - from);
  const Profile::Scope scope(run_.profile(), phase::kIteration);
  NewtonStep step = newton_step(run_.assembly(), run_.tangent(), state.target, run_.system.rate(), to - from,
                                newton, run_.result.work, state.du);
  load_share_ = state.path.load_share + control.change();
  return step;
}

}  // namespace sage
