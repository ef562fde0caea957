#include "sage/analysis/trial_run.hpp"

#include "sage/analysis/dissipation.hpp"
#include "sage/analysis/explain.hpp"

namespace sage {

void TrialRun::run() {
  Trials& trials = *run_.settings.trials;
  run_.assembly().recover_states();
  std::string kept = run_.keep_state();
  bool more = trials.next(nullptr, run_.solution());
  while (more) {
    control_.begin_trial(trials.max_cuts());
    run_.assembly().take_laws();
    TrialResult result = try_stage();
    if (result.equilibrium) {
      kept = run_.keep_state();
    } else {
      run_.restore_state(kept);
      result.dissipation = dissipation(run_, result.motion);
      run_.assembly().drop_step();
    }
    more = trials.next(&result, run_.solution());
    stop_if_asked(run_.settings.stop_asked);
  }
}

// A law or a solver that gives up is an answer, too.
TrialResult TrialRun::try_stage() {
  TrialResult trial;
  start_u_ = run_.state.u;
  start_strain_.clear();
  for (const GroupData& data : run_.assembly().groups()) start_strain_.push_back(data.state.committed.eps);
  try {
    run_stage(trial);
  } catch (const AnalysisError& error) {
    trial.outcome = StepOutcome::law_cut;
    trial.reason = error.what();
    take_motion(run_.state.u, Side::committed, trial);
  }
  return trial;
}

// What the new laws no longer carry of the stresses is held at first and released in proportion (StageStart::open).  The
// first correction has the stiffness of points that have just returned to their surfaces, which is elastic: that of the
// return itself leads far away where flow is not associated.
void TrialRun::run_stage(TrialResult& trial) {
  StepReport& report = trial.report;
  report.stage = run_.settings.trials->stage();
  report.increment = report.increments = 1;
  start_.open(report.stage);
  control_.open_stage();
  run_.tangent().forget();
  if (run_.assembly().eliminated().dofs().empty()) run_.assembly().evaluate(run_.state.du, &run_.tangent());
  trial.equilibrium = control_.take_increment(report);
  if (!trial.equilibrium) return fail(trial);
  report.points = run_.assembly().count_points();
  take_motion(run_.state.u, Side::committed, trial);
  trial.outcome = StepOutcome::converged;
}

void TrialRun::fail(TrialResult& trial) {
  const NewtonStep& step = control_.failed();
  trial.outcome = step.outcome;
  trial.reason = step.outcome == StepOutcome::singular
                     ? explain_singular(run_.model, run_.system.activity(), run_.assembly(), trial.report, step)
                     : explain_failure(run_.model, run_.assembly(), trial.report, step);
  control_.drop_step();
  take_motion(run_.state.u + run_.state.du, Side::trial, trial);
}

// Since the start of the trial.  Groups whose states are recovered late have no strain here.
void TrialRun::take_motion(const Eigen::VectorXd& u, Side side, TrialResult& trial) const {
  trial.motion = u - start_u_;
  const std::vector<GroupData>& groups = run_.assembly().groups();
  trial.strain.assign(groups.size(), {});
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].active || groups[g].constant) continue;
    const StateStore& store = groups[g].state;
    std::vector<double>& strain = trial.strain[g];
    strain = side == Side::trial ? store.trial.eps : store.committed.eps;
    for (std::size_t i = 0; i < strain.size(); ++i) strain[i] -= start_strain_[g][i];
  }
}

}  // namespace sage
