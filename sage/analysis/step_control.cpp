#include "sage/analysis/step_control.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/load_control.hpp"
#include "sage/analysis/trials.hpp"

namespace sage {

namespace {

// Behind a step that had to be relaxed, Newton's method finds some steps and not others.  The ones that it finds lie on another
// path: loads that alternate between the two swing more than those of either.
// refused_at: load factor from which no motion came to rest.
bool stays_relaxed(const RunParts& run, double refused_at) {
  return run.settings.trials == nullptr && run.state.path.relaxed > 0 && refused_at != run.state.reached;
}

}  // namespace

StepControl::StepControl(const RunParts& run)
    : run_(run),
      stepper_(run),
      damped_(run, stepper_),
      search_(run, stepper_),
      pore_steps_(run),
      stiffness_(run),
      max_cuts_(run.settings.max_cuts) {}

void StepControl::open_stage() {
  damped_.open_stage();
  refused_at_ = -1.0;
  on_last_way_ = false;
  if (run_.stage().is_controlled()) run_.state.path.control_start = controlled_displacement(run_);
  if (!run_.tangent().constant()) stiffness_.set_committed(run_.state.path.force_start);
}

void StepControl::resume() {
  StagePath& path = run_.state.path;
  PoreSteps::resume(run_);
  damped_.open_stage();
  last_du_ = run_.state.du;
  stiffness_.set_committed(run_.assembly().internal_force());
  if (path.own_tangent) run_.tangent().set_aside();
  if (!run_.assembly().eliminated().dofs().empty())
    run_.assembly().set_stage_loads(path.force_end - path.force_start);
}

// Dofs are eliminated for loads that grow along one line: the rest of the stage does without that.
void StepControl::take_loads() {
  StagePath& path = run_.state.path;
  path.forget_steps();
  path.u_start.resize(0);
  on_last_way_ = false;
  if (run_.assembly().eliminated().dofs().empty()) return;
  run_.system.renumber();
  run_.state.du.setZero();
  run_.set_step_time(run_.state.reached, 0.0);
  run_.assembly().evaluate(run_.state.du, nullptr);
}

void StepControl::begin_trial(int max_cuts) {
  is_trial_ = true;
  damped_.begin_trial();
  max_cuts_ = max_cuts;
}

bool StepControl::take_increment(StepReport& report) {
  const double end = run_.end_of({report.stage, report.increment});
  const bool equal =
      run_.settings.time_scheme == nullptr && run_.stage().grading == 1.0 && run_.stage().ends.empty();
  const double whole =
      equal ? 1.0 / report.increments : end - run_.end_of({report.stage, report.increment - 1});
  report.substeps = 0;
  run_.state.place = {report.stage, report.increment};
  return pore_steps_.chooses() ? advance_by_error(report, end) : advance(report, end, whole);
}

// Each step in the two parts of its method; one whose error is too large is taken back.
bool StepControl::advance_by_error(StepReport& report, double end) {
  RunState& state = run_.state;
  if (!run_.assembly().eliminated().dofs().empty()) take_loads();
  pore_steps_.begin_increment();
  while (state.reached < end && !state.path.pores.ended) {
    const double from = state.reached, size = pore_steps_.next(end);
    const double to = size >= end - from ? end : from + size;
    const std::string start = run_.keep_state();
    for (const PoreSteps::Part part : {PoreSteps::Part::first, PoreSteps::Part::second}) {
      pore_steps_.begin_part(part, to - from);
      const double part_end = part == PoreSteps::Part::first ? from + state.path.pores.theta_share : to;
      if (!advance(report, part_end, part_end - state.reached)) return false;
    }
    if (!pore_steps_.accept(to - from))
      pore_steps_.go_back(start, from);
    else
      pore_steps_.measure();
  }
  return true;
}

// whole: of which a step is 2^-max_cuts at least.
bool StepControl::advance(StepReport& report, double end, double whole) {
  constexpr int kMostAttempts = 3;  // of a trial, of so many iterations each at most
  constexpr std::size_t kEasy = 6;  // iterations
  RunState& state = run_.state;
  double size = end - state.reached;
  int iterations = 0;  // of Newton's attempts
  while (state.reached < end) {
    const double to = size >= end - state.reached - 1e-12 * whole ? end : state.reached + size;
    const double tried = to - state.reached;
    run_.show_progress(report, state.reached);
    if (stays_relaxed(run_, refused_at_)) {
      if (relax(report, end)) {
        size = end - state.reached;
        continue;
      }
      reject(0.0);
    }
    const bool went_on = state.path.policy->begins_elsewhere(run_, tried);
    NewtonStep step = search_.attempt(state.reached, to);
    damped_.doubt(step);
    iterations += static_cast<int>(step.iterations.size());
    const bool last_cut = tried < 1.001 * std::ldexp(whole, -max_cuts_);
    if (damped_.due(last_cut) && !went_on && damped_.suits(step, on_last_way_)) {
      on_last_way_ = false;
      step = damped_.attempt(report, state.reached, to, step);
    }
    if (run_.stage().is_controlled() && drops_off(run_, stepper_.load_share()))
      step.outcome = StepOutcome::not_converged;
    if (record(report, step, tried)) {
      const double error = run_.assembly().path_error();
      if (error > kPathTolerance && tried > 1.001 * kSmallestPart * whole) {
        size = tried * std::clamp(0.9 * std::cbrt(kPathTolerance / error), 0.25, 0.75);
        size = std::max(size, kSmallestPart * whole);
        reject(0.0);
        continue;
      }
      state.path.path_error = std::max(state.path.path_error, error);
      accept(report, step, to);
      if (!pore_steps_.chooses() && pore_steps_.measure()) return true;
      if (step.iterations.size() <= kEasy && 8.0 * error <= kPathTolerance) size *= 2.0;
      continue;
    }
    if (tries_otherwise(step, went_on, tried)) continue;
    report.points = run_.assembly().count_points();
    report.failed_at = to;  // beyond `reached`, which may have passed an earlier failure
    const bool given_up =
        is_trial_ && (step.flows || iterations >= kMostAttempts * run_.stage().max_iterations);
    const bool last = given_up || last_cut || run_.tangent().linear();
    if (can_relax(step, last)) {
      if (relax(report, end)) {
        size = end - state.reached;
        continue;
      }
      if (run_.settings.trials != nullptr) return fail(report, relaxed_, tried);
    }
    if (last) return fail(report, step, tried);
    ++report.cuts;
    size = 0.5 * tried;
    reject(size);
  }
  return true;
}

// True where the step may be committed.
bool StepControl::record(StepReport& report, const NewtonStep& step, double size) const {
  report.iterations = step.iterations;
  report.total_iterations += static_cast<int>(step.iterations.size());
  report.worst = step.worst;
  const double refused = refused_motion(size, step);
  if (refused > 0.0) report.refused = refused;
  return step.outcome == StepOutcome::converged && refused == 0.0;
}

void StepControl::accept(StepReport& report, const NewtonStep& step, double to) {
  StagePath& path = run_.state.path;
  const double size = to - run_.state.reached;
  force_left_ = step.force_left;
  path.own_tangent = path.own_tangent || step.finished;
  stepper_.set_newton(Stepper::Newton::by_stage);
  const bool modified = run_.stage().method == Method::modified_newton && !path.own_tangent;
  // The tangent at the end of a step serves the next one.  It must be evaluated with the step still in hand: at du = 0 a law on
  // its yield surface answers elastically.
  if (modified && !run_.tangent().constant()) run_.assembly().evaluate(run_.state.du, &run_.tangent());
  if (!run_.stage().is_controlled()) path.policy->accept(run_, step, size, report.cuts > 0);
  on_last_way_ = false;
  if (path.own_tangent) run_.tangent().set_aside();
  if (!step.crept) stiffness_.measure(size);
  move_to(to);
  keep_step(size);
  report.load_factor = run_.load_share();
  ++report.substeps;
}

bool StepControl::fail(StepReport& report, const NewtonStep& step, double size) {
  report.stiffness_share = stiffness_.share(size, step);
  report.converged = false;
  report.flows = step.flows || (step.outcome == StepOutcome::singular && !damped_.has_walls());
  report.proved = report.flows && step.moved;
  report.spares_ground = step.spares_ground;
  failed_ = step;
  return false;
}

void StepControl::move_to(double load_factor) {
  RunState& state = run_.state;
  Assembly& assembly = run_.assembly();
  assembly.commit(state.du);
  if (sees_unknowns(assembly)) state.u_before = state.u;
  state.u += state.du;
  state.reached = load_factor;
  if (run_.stage().is_controlled()) {
    state.path.load_share = stepper_.load_share();
    state.path.largest_share = std::max(state.path.largest_share, std::abs(state.path.load_share));
  }
  const double share = run_.load_share();
  state.external = (1.0 - share) * state.path.external_start + share * state.path.force_end;
  run_.add_histories(load_factor, state.external);
  run_.collect_at_exits();
  if (!state.path.pore_end.empty()) run_.set_water(share);
  if (!assembly.is_behind()) run_.result.motion = std::max(run_.result.motion, run_.extent.motion(state.u));
}

void StepControl::drop_step() {
  RunState& state = run_.state;
  run_.assembly().drop_step();
  if (!run_.assembly().is_behind()) return;
  state.target = run_.loads_at(state.reached);
  run_.assembly().catch_up(state.target, state.reached, state.path.u_start, state.u);
  run_.result.motion = std::max(run_.result.motion, run_.extent.motion(state.u));
}

// Back to the committed state, with its own internal forces.  The next attempt starts with the tangent in the middle of the
// last step.  At du = 0 points on their yield surfaces answer elastically: from there a cut step would have to find the
// whole plastic zone anew, however short it is.
// next: share of the stage of the next attempt; 0 = it starts at the committed state all the same.
void StepControl::reject(double next) {
  RunState& state = run_.state;
  state.path.policy->forget(SteppingPolicy::Past::last_step);
  on_last_way_ = false;
  drop_step();
  const bool keep_K = run_.tangent().constant() || run_.stage().method == Method::initial_stiffness;
  if (!keep_K) {
    run_.tangent().set_aside();
    run_.set_step_time(state.reached + next, next);
    if (next > 0.0) start_on_last_way(next);
  }
  state.du.setZero();
  run_.set_step_time(state.reached, 0.0);
  run_.assembly().evaluate(state.du, nullptr);
}

// Linear scenes cut no step.
void StepControl::keep_step(double size) {
  if (run_.tangent().linear()) return;
  last_du_ = run_.state.du;
  run_.state.path.last_size = size;
  stiffness_.set_committed(run_.assembly().internal_force());
}

// K in the middle of the last step, taken once more in its direction, for a step of this share of the stage.
void StepControl::start_on_last_way(double size) {
  RunState& state = run_.state;
  if (!(state.path.last_size > 0.0)) return;
  state.du = (0.5 * size / state.path.last_size) * last_du_;
  on_last_way_ = run_.assembly().evaluate(state.du, &run_.tangent()) == Outcome::ok;
}

// Newton's method stops near an equilibrium where the set of yielding points cycles; associated flow leaves it no cycles.  Where no motion is prescribed, a failure at the shortest step is a limit
// load as a rule, and remains one.
bool StepControl::can_relax(const NewtonStep& step, bool last) const {
  constexpr double kNear = 1e-2;  // relative residual around which corrections that cycle stay
  const Assembly& assembly = run_.assembly();
  if (run_.stage().is_controlled() || run_.tangent().linear() || !Relaxation::suits(run_.model) ||
      assembly.dof_map().displacements() == 0)
    return false;
  if (run_.settings.trials != nullptr) return damped_.proves() && !damped_.has_walls();
  const bool fails_here = refused_at_ == run_.state.reached && !last;
  const bool cycles = step.outcome == StepOutcome::not_converged && !step.iterations.empty() &&
                      step.iterations.back().force <= kNear;
  const bool due = (last && cycles) || run_.state.path.relaxed > 0;
  return due && !fails_here && !assembly.scene().symmetric && !run_.system.rate().isZero(0.0);
}

// Takes the rest of the increment, or a part of it, by dynamic relaxation.  False: none of it; then nothing has changed.
bool StepControl::relax(StepReport& report, double end) {
  RunState& state = run_.state;
  const double begin = state.reached;
  drop_step();
  if (!run_.assembly().eliminated().dofs().empty()) take_loads();
  while (state.reached < end) {
    double to = end;
    Relaxation relaxation(run_, damped_.of_solids());
    relaxed_ = relax_step(relaxation, report, state.reached, to);
    if (relaxed_.outcome != StepOutcome::converged && run_.settings.trials == nullptr) break;
    if (!record(report, relaxed_, to - state.reached)) break;
    accept(report, relaxed_, to);
    relaxation.show_strength();
    state.path.policy->forget(SteppingPolicy::Past::last_step);
    ++state.path.relaxed;
  }
  if (state.reached == begin) refused_at_ = begin;
  return state.reached > begin;
}

// to: in, the end that is wanted; out, that of the step.  Once the motion has nearly come to rest, Newton's method finds the
// end of it as a rule; else the motion goes on.
NewtonStep StepControl::relax_step(Relaxation& relaxation, StepReport& report, double from, double& to) {
  constexpr double kFirst = 1e-5, kFiner = 0.1,
                   kLast = 1e-3;  // residuals; of the last one, times the tolerance
  RunState& state = run_.state;
  const std::string start = run_.keep_state();
  const Eigen::VectorXd start_u = state.u, failed_du = state.du;
  const double tolerance = run_.stage().tolerance;
  Relaxation::End end = Relaxation::End::rest;
  NewtonStep step;
  to = relaxation.start(from, to);
  const double first = run_.settings.trials != nullptr ? tolerance : std::min(kFirst, tolerance);
  for (double goal = first; goal > 0.99 * kLast * tolerance; goal *= kFiner) {
    end = relaxation.settle(goal);
    if (end != Relaxation::End::rest) break;
    run_.tangent().forget();
    step = stepper_.attempt_near(to);
    if (step.outcome == StepOutcome::converged) break;
    state.du.setZero();
    run_.tangent().forget();
  }
  const bool found = end == Relaxation::End::rest && step.outcome == StepOutcome::converged;
  if (found || run_.settings.trials != nullptr) report.total_iterations += relaxation.passes();
  step.crept = true;
  if (found) return step;
  const Eigen::VectorXd motion = state.u + state.du - start_u;
  run_.restore_state(start);
  step = {};
  step.flows = step.moved = end == Relaxation::End::flow;
  step.iterations.push_back({relaxation.residual(), 0.0, 0.0, 1.0});
  state.du = run_.settings.trials != nullptr ? motion : failed_du;
  run_.assembly().evaluate(state.du, nullptr);
  return step;
}

// Whether a step that failed is tried once more in another way before it is cut.
bool StepControl::tries_otherwise(const NewtonStep& step, bool went_on, double size) {
  StagePath& path = run_.state.path;
  // The direction of the last step may lead nowhere where the start from the committed state does not.
  if (went_on) {
    path.policy->fail();
    reject(size);
    return true;
  }
  // The tangent of a step whose ground flows everywhere is too soft for points that stop to flow in the next one.
  if (run_.stage().method == Method::modified_newton && !path.own_tangent && !run_.tangent().linear()) {
    path.own_tangent = true;
    reject(0.0);
    return true;
  }
  // From a place that a kept tangent has reached Newton's method may find nothing where it does from the start.
  // It comes nearer than the stage requires, if it can.
  const Stepper::Newton tried = stepper_.newton();
  if ((step.finished && tried == Stepper::Newton::by_stage) || tried == Stepper::Newton::finer) {
    stepper_.set_newton(tried == Stepper::Newton::finer ? Stepper::Newton::yes : Stepper::Newton::finer);
    reject(0.0);
    return true;
  }
  stepper_.set_newton(Stepper::Newton::by_stage);
  // Half way along a collapse mechanism the matrix may be singular where the committed state's is not.
  if (step.outcome == StepOutcome::singular && on_last_way_) {
    reject(0.0);
    return true;
  }
  return false;
}

// A step that moves a node by a thousand times the model's size while hardly anything resists is flow at a
// limit load: an equilibrium far away that rounding and the mesh's own faults give (reduced integration, nu
// near 1/2). Returns its motion as a share of that size; 0 = the step may be committed.
double StepControl::refused_motion(double size, const NewtonStep& step) const {
  constexpr double kFar = 1e3;    // model's sizes
  constexpr double kSoft = 0.01;  // of the stage's largest stiffness, or prescribed motion over the largest
  if (step.outcome != StepOutcome::converged || run_.tangent().linear()) return 0.0;
  const int n = run_.assembly().dof_map().displacements();
  const double motion = n > 0 ? run_.state.du.head(n).lpNorm<Eigen::Infinity>() : 0.0;
  const double extent = run_.extent.size();
  if (!(motion > kFar * extent) || !(extent > 0.0)) return 0.0;
  const double prescribed = size * run_.system.rate().head(n).lpNorm<Eigen::Infinity>();
  const double share = prescribed > 0.0 ? prescribed / motion : stiffness_.share(size, step);
  return share >= 0.0 && share < kSoft ? motion / extent : 0.0;
}

}  // namespace sage
