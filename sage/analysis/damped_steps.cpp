#include "sage/analysis/damped_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/analysis/trials.hpp"

namespace sage {

// Whose dofs move the ground.  Frames without ground collapse by themselves.
void DampedSteps::open_stage() {
  const std::vector<GroupData>& groups = run_.assembly().groups();
  of_solids_.assign(run_.assembly().dof_map().displacements(), 0);
  stage_u_ = run_.state.u;
  has_walls_ = false;
  const bool ground =
      std::ranges::any_of(groups, [](const GroupData& data) { return data.active && data.group->solid(); });
  for (const GroupData& data : groups) {
    if (!data.active) continue;
    has_walls_ = has_walls_ || data.group->interface() || data.group->structure();
    if (!(ground ? data.group->solid() : data.group->structure())) continue;
    for (const int node : data.group->nodes)
      for (int c = 0; c < 2; ++c) of_solids_[DofMap::displacement(node, c)] = 1;
  }
}

bool DampedSteps::descends() const {
  return run_.settings.trials != nullptr && !is_trial_ && run_.settings.trials->descends();
}

bool DampedSteps::due(bool last_cut) const {
  if (run_.settings.trials == nullptr) return last_cut;
  return has_walls_ || !(descends() || proves());
}

bool DampedSteps::proves() const {
  return run_.settings.trials != nullptr && run_.settings.trials->proves();
}

// Whether a step that failed is tried once more with damped corrections.  Walls in joints lose their hold in single
// iterations, without a limit of the ground.
bool DampedSteps::suits(const NewtonStep& step, bool on_last_way) const {
  if (step.outcome == StepOutcome::converged || run_.tangent().linear() ||
      !run_.assembly().eliminated().dofs().empty() || run_.assembly().dof_map().displacements() == 0)
    return false;
  // These are tried again otherwise first.
  if (step.finished || stepper_.newton() == Stepper::Newton::finer ||
      (step.outcome == StepOutcome::singular && on_last_way))
    return false;
  if (run_.settings.trials == nullptr) return has_walls_;
  return has_walls_ || (!step.flows && step.outcome != StepOutcome::singular);
}

namespace {

// Whether ground that ran away shows a collapse.  At a collapse the loads exceed what the ground carries by little, since
// factors are tried from near; corrections that damping let go too early leave most forces without balance.
bool shows_collapse(const NewtonStep& step) {
  constexpr double kExcess = 0.01;  // of all forces
  return step.flows && !step.iterations.empty() && step.iterations.back().force <= kExcess;
}

double largest_of_solids(const Eigen::VectorXd& motion, const std::vector<char>& of_solids) {
  double most = 0.0;
  for (std::size_t i = 0; i < of_solids.size(); ++i) {
    const double moved = of_solids[i] != 0 ? std::abs(motion[i]) : 0.0;
    if (!(moved <= most)) most = moved;  // not a number counts
  }
  return most;
}

}  // namespace

// failed: Newton's attempt at the same step.
NewtonStep DampedSteps::attempt(StepReport& report, double from, double to, const NewtonStep& failed) {
  constexpr std::array<double, 3> kFalls{0.7, 0.9, 0.97};
  RunState& state = run_.state;
  NewtonStep step = failed;
  for (const double fall : kFalls) {
    report.total_iterations += static_cast<int>(step.iterations.size());
    state.path.policy->forget(SteppingPolicy::Past::last_step);
    run_.assembly().drop_step();
    state.du.setZero();
    run_.set_step_time(from, 0.0);
    ElasticMatrices& elastic = run_.tangent().elastic();
    run_.tangent().forget();
    if (!elastic.known()) {
      elastic.begin();
      elastic.end(evaluate_elastic(run_.assembly(), run_.tangent()));
      run_.tangent().forget();
    }
    if (!elastic.known()) return failed;
    step = stepper_.attempt_damped(from, to, {fall, &of_solids_});
    judge_motion(step);
    if (run_.settings.trials != nullptr && !descends() && !step.flows) step = creep(report, to, fall, step);
    if (!step.flows || shows_collapse(step)) break;
  }
  step.flows = step.moved = shows_collapse(step);
  const bool says_more = step.outcome == StepOutcome::converged || run_.settings.trials != nullptr;
  return says_more ? step : failed;
}

// A soft spring at a wall's tip may hold ground that has slipped by more than the equations of small strain can tell.  The
// motion counts from the start of the stage: in short steps each slips by little.
bool DampedSteps::is_far(const NewtonStep& step, double far) const {
  if (run_.settings.trials == nullptr || step.outcome != StepOutcome::converged) return false;
  const Eigen::VectorXd motion = run_.state.u + run_.state.du - stage_u_;
  return !(largest_of_solids(motion, of_solids_) <= far * run_.extent.size());
}

void DampedSteps::doubt(NewtonStep& step) const {
  constexpr double kFar = 1.0;  // of the model's size: soft ground that is elastic may settle by a tenth
  if (has_walls_ && is_far(step, kFar)) step.outcome = StepOutcome::not_converged;
}

void DampedSteps::judge_motion(NewtonStep& step) const {
  constexpr double kFar = 0.1;  // of the model's size
  if (!is_far(step, kFar)) return;
  step.outcome = StepOutcome::not_converged;
  step.flows = true;
}

// Where joints open and close in turns there may be no equilibrium with the history of the step's start, or none that
// corrections find.  Damped motion is slow motion through states whose imbalance the damping carries: here the history follows
// it, and what has opened stays so.  The damping carries nothing of an equilibrium that is found.
NewtonStep DampedSteps::creep(StepReport& report, double to, double damping_fall, const NewtonStep& shaken) {
  constexpr int kRounds = 10;
  constexpr int kMostIterations = 20000;  // of an increment
  if (shaken.outcome != StepOutcome::not_converged) return shaken;
  RunState& state = run_.state;
  const std::string start = run_.keep_state();
  const Eigen::VectorXd start_u = state.u;
  NewtonStep step = shaken;
  for (int round = 0; round < kRounds && report.total_iterations < kMostIterations; ++round) {
    if (step.outcome != StepOutcome::not_converged || step.flows) break;
    report.total_iterations += static_cast<int>(step.iterations.size());
    run_.assembly().commit(state.du);
    state.u += state.du;
    state.du.setZero();
    run_.tangent().forget();
    step = stepper_.attempt_damped(to, to, {damping_fall, &of_solids_});
  }
  step.crept = true;
  judge_motion(step);
  if (step.outcome == StepOutcome::converged) return step;
  const Eigen::VectorXd motion = state.u + state.du - start_u;
  run_.restore_state(start);
  state.du = motion;
  return step;
}

}  // namespace sage
