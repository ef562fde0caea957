#include "sage/analysis/analysis.hpp"

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sage/analysis/audit.hpp"
#include "sage/analysis/dissipation.hpp"
#include "sage/analysis/explain.hpp"
#include "sage/analysis/external_loads.hpp"
#include "sage/analysis/fold.hpp"
#include "sage/analysis/load_control.hpp"
#include "sage/analysis/pore_warnings.hpp"
#include "sage/analysis/run_checkpoint.hpp"
#include "sage/analysis/stage_start.hpp"
#include "sage/analysis/stage_warnings.hpp"
#include "sage/analysis/step_control.hpp"
#include "sage/analysis/trial_run.hpp"

namespace sage {

// Stages and their increments, and what observers receive of them.
class Analysis::Stages {
 public:
  Stages(const Model& model, const Catalogue& catalogue, RunSettings settings,
         std::span<Observer* const> observers);

  bool open();
  bool advance();
  Solution state();
  void take_loads();
  RunResult close();
  const RunPlace& done() const { return done_; }
  bool is_complete() const { return done_.stage >= stages(); }

 private:
  // How many stages are run in sequence.
  int stages() const {
    return settings_.trials != nullptr ? settings_.trials->stage() : static_cast<int>(model_.stages.size());
  }
  template <class Work>
  bool guard(Work work);
  void begin_stage();
  bool take_increment();
  void end_increment(StepReport& report);
  void end_stage();
  void fail(StepReport& report);
  void find_loose_part(const StepReport& report);
  void recover_for(const StepReport& report);
  void show_recovered_for(const StepReport& report);
  void show_recovered(bool states);
  Solution solution() const;
  void offer_checkpoint();
  void leave_step();

  const Model& model_;
  const RunSettings settings_;
  const std::vector<Observer*> observers_;
  RunResult result_;
  ObserverList observer_list_;
  System system_;
  RunState state_;
  const Extent extent_;
  const RunParts run_{model_, settings_, extent_, system_, state_, result_, observer_list_};
  StageStart start_{run_};
  StepControl control_{run_};
  RunPlace done_;           // increments that are complete
  bool has_begun_ = false;  // the stage of done_ is open
  bool was_opened_ = false, is_closed_ = false;
  bool is_open_ = false;         // a next increment may be taken
  bool has_tried_ = false;       // all trials are done
  bool is_interrupted_ = false;  // an exception left a step in hand
  // With eliminated dofs recovered, for output that needs it; no entries: none does.
  Eigen::VectorXd shown_u_, shown_force_;
};

Analysis::Stages::Stages(const Model& model, const Catalogue& catalogue, RunSettings settings,
                         std::span<Observer* const> observers)
    : model_(model),
      settings_(std::move(settings)),
      observers_(observers.begin(), observers.end()),
      observer_list_(observers_, result_.work.profile),
      system_(model, catalogue, settings_, result_.work),
      extent_(model) {
  const int dofs = system_.assembly().dof_map().dofs();
  state_.path.policy = make_stepping_policy(settings_.skips);
  if (settings_.profile_memory) result_.work.profile = Profile(true);
  run_.profile().show_in(settings_.pulse);
  state_.u.setZero(dofs);
  state_.du.setZero(dofs);
  state_.external.setZero(dofs);
  system_.assembly().set_committed(state_.u);
}

Solution Analysis::Stages::solution() const {
  Solution solution = run_.solution();
  if (shown_u_.size() > 0) {
    solution.u = &shown_u_;
    solution.internal = &shown_force_;
  }
  return solution;
}

// What ends the run becomes the status and the reason of its result.
template <class Work>
bool Analysis::Stages::guard(Work work) {
  shown_u_.resize(0);
  is_open_ = false;
  try {
    is_open_ = work();
    return is_open_;
  } catch (const Stopped&) {
    result_.status = RunStatus::stopped;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (observer_list_.is_outside()) throw;
    result_.status = RunStatus::failed;
    const auto* coded = dynamic_cast<const CodedError*>(&error);
    result_.code = coded != nullptr ? coded->code() : Code("S510");
    result_.reason = with_code(error.what(), *result_.code);
  }
  is_interrupted_ = has_begun_;
  return false;
}

bool Analysis::Stages::open() {
  if (was_opened_ || is_closed_) throw std::logic_error("Analysis::open: it has been opened before");
  was_opened_ = true;
  if (settings_.trials != nullptr) refuse_controlled_trials(model_);
  return guard([&] {
    if (settings_.resume_from.empty()) {
      start_.start_first_states();
    } else {
      done_ = resume_from(run_, settings_.resume_from);
      has_begun_ = done_.increment > 0;
      if (has_begun_) control_.resume();
    }
    if (!is_complete() && !has_begun_) begin_stage();
    return true;
  });
}

bool Analysis::Stages::advance() {
  if (!was_opened_ || is_closed_) throw std::logic_error("Analysis::advance: it is not open");
  if (!is_open_) return false;
  return guard([&] {
    if (!is_complete()) {
      if (!has_begun_) begin_stage();
      return take_increment();
    }
    if (settings_.trials != nullptr) {
      TrialRun(run_, start_, control_).run();
      has_tried_ = true;
    }
    return false;
  });
}

void Analysis::Stages::begin_stage() {
  const int s = done_.stage;
  StepReport report;
  report.stage = s;
  report.increments = model_.stages[s].increments;
  run_.show_progress(report, 0.0);
  start_.open(s);
  control_.open_stage();
  has_begun_ = true;
  if (s == 0)
    observer_list_.tell([&](Observer& o) {
      o.on_start(model_, system_.scene(), system_.tangent().solver().traits().name, system_.equations());
    });
  recover_for(report);
  observer_list_.tell([&](Observer& o) { o.on_stage_start(model_, s, solution()); });
}

bool Analysis::Stages::take_increment() {
  const Stage& stage = model_.stages[done_.stage];
  StepReport report;
  report.stage = done_.stage;
  report.increment = done_.increment + 1;
  report.increments = stage.increments;
  report.load_factor = report.started_at = run_.load_share();
  report.early = state_.early;
  if (!control_.take_increment(report)) {
    fail(report);
    return false;
  }
  if (state_.path.pores.ended) report.increments = report.increment;
  const bool ends_stage = report.increment == report.increments;
  if (ends_stage && settings_.trials == nullptr && done_.stage + 1 == stages()) {
    const Profile::Scope scope(run_.profile(), phase::kChecks);
    system_.release_solver();
  }
  end_increment(report);
  ++done_.increment;
  if (ends_stage) end_stage();
  const bool whole_stages_only =
      stage.method == Method::initial_stiffness && !system_.tangent().constant() && !ends_stage;
  if (done_.stage < static_cast<int>(model_.stages.size())) {
    if (!whole_stages_only) offer_checkpoint();
    stop_if_asked(settings_.stop_asked);
  }
  return true;
}

void Analysis::Stages::end_increment(StepReport& report) {
  const bool behind = system_.assembly().is_behind();
  report.points = system_.assembly().count_points();
  find_loose_part(report);
  report.motion = behind ? std::numeric_limits<double>::quiet_NaN() : result_.motion;
  report.smallest_pivot_ratio = system_.smallest_pivot();
  ++result_.increments_done;
  if (behind)
    show_recovered_for(report);
  else
    recover_for(report);
  if (water_flows(system_.assembly()) && (report.increment == 1 || report.increment == report.increments))
    run_.warn(oscillation_warnings(model_, run_.stage(), report.increment, system_.assembly(), state_.u));
  observer_list_.tell([&](Observer& o) { o.on_increment(model_, report, solution()); });
  shown_u_.resize(0);
}

void Analysis::Stages::end_stage() {
  const int s = done_.stage;
  const Stage& stage = run_.stage();
  const Assembly& assembly = system_.assembly();
  const StagePath& path = state_.path;
  ++result_.stages_done;
  EquilibriumAudit sums;
  {
    const Profile::Scope scope(run_.profile(), phase::kChecks);
    sums = audit_equilibrium(model_, assembly, run_.solution(), path.force_start);
    run_.warn(stage_warnings(stage,
                             {model_.large_strain ? 0.0 : result_.motion, sums.out_of_balance, system_.digits(),
                              path.path_error, path.loose_part, path.relaxed, control_.force_left()},
                             assembly));
    run_.warn(PoreSteps::remarks(run_));
    run_.warn(gradient_warnings(model_, stage, system_.activity()));
    run_.warn(free_surface_warnings(model_, stage, assembly));
    if (settings_.stream_function) run_.warn(stream_warnings(model_, stage, solution()));
  }
  observer_list_.tell([&](Observer& o) { o.on_stage_end(model_, s, sums, solution()); });
  state_.early += (1.0 - state_.reached) * stage.duration;
  done_ = {s + 1, 0};
  has_begun_ = false;
}

void Analysis::Stages::fail(StepReport& report) {
  const NewtonStep& step = control_.failed();
  const Assembly& assembly = system_.assembly();
  if (run_.stage().is_controlled()) {
    result_.status = RunStatus::not_converged;
    result_.code = Code("S584");
    result_.reason = explain_controlled(run_, report, step);
  } else if (step.outcome == StepOutcome::singular) {
    result_.status = RunStatus::singular;
    result_.code = Code("S502");
    result_.reason = explain_singular(model_, system_.activity(), assembly, report, step);
  } else {
    result_.status = RunStatus::not_converged;
    result_.code = Code("S501");
    result_.reason = explain_failure(model_, assembly, report, step);
  }
  if (const std::string fold =
          model_.large_strain ? fold_lines(model_, assembly, state_.u, state_.du) : std::string();
      !fold.empty()) {
    result_.code = Code("S555");
    result_.reason.insert(result_.reason.find('\n') + 1, fold);
  }
  result_.reason = with_code(result_.reason, *result_.code);
  if (settings_.trials != nullptr) settings_.trials->lost(state_.u + state_.du, dissipation(run_, state_.du));
  leave_step();
  report.motion = result_.motion;
  if (!model_.large_strain) run_.warn(motion_warnings(run_.stage(), result_.motion));
  system_.assembly().recover_states();
  observer_list_.tell([&](Observer& o) { o.on_failure(model_, report, result_.reason, solution()); });
}

// Back to the committed state, with its own internal forces.
void Analysis::Stages::leave_step() {
  state_.du.setZero();
  run_.set_step_time(state_.reached, 0.0);
  control_.drop_step();
  system_.assembly().evaluate(state_.du, nullptr);
}

// Newton's matrix is singular then; a matrix that is kept from before finds an equilibrium all the same.
void Analysis::Stages::find_loose_part(const StepReport& report) {
  std::string& part = state_.path.loose_part;
  if (!part.empty() || report.points[static_cast<std::size_t>(PointStatus::open)] == 0) return;
  part = explain_loose_part(model_, system_.activity(), system_.assembly());
  if (!part.empty()) part = "increment " + std::to_string(report.increment) + ": " + part;
}

void Analysis::Stages::offer_checkpoint() {
  if (!settings_.checkpoint_due || !settings_.checkpoint_due()) return;
  const Profile::Scope scope(run_.profile(), phase::kCheckpoint);
  const std::string bytes = checkpoint_bytes(run_, done_);
  observer_list_.outside([&] { settings_.save_checkpoint(bytes); });
}

// Stress and strain of linear elements, if an observer needs them.  Where laws are evaluated all are recovered at once:
// forces made from stresses are rounded otherwise than those that go on, and a stage near its limit load shows it.
void Analysis::Stages::recover_for(const StepReport& report) {
  const bool structures = observer_list_.wants_structures(model_, report);
  if (observer_list_.wants_states(model_, report) || (structures && !system_.scene().linear))
    system_.assembly().recover_states();
  else if (structures)
    system_.assembly().recover_structures();
}

// Observers that need nodes of eliminated dofs that are behind get a copy in which they are recovered.
void Analysis::Stages::show_recovered_for(const StepReport& report) {
  const bool states =
      observer_list_.wants_states(model_, report) || observer_list_.wants_structures(model_, report);
  const std::vector<char>& inner = system_.assembly().eliminated().nodes();
  if (states || observer_list_.wants_nodes(model_, report, inner)) show_recovered(states);
}

void Analysis::Stages::show_recovered(bool states) {
  Eigen::VectorXd motion;
  system_.assembly().show_recovered(motion, shown_force_);
  shown_u_ = state_.u + motion;
  if (states) system_.assembly().recover_states_at(motion);
}

Solution Analysis::Stages::state() {
  Assembly& assembly = system_.assembly();
  if (is_interrupted_) {
    assembly.set_stop({});
    leave_step();
    is_interrupted_ = false;
  }
  if (assembly.is_behind())
    show_recovered(true);
  else
    assembly.recover_states();
  return solution();
}

// F(t) = (1 - t) f0 + t F1 goes on from what it is now: f0 becomes what makes it so with the new F1.
void Analysis::Stages::take_loads() {
  const double t = state_.reached;
  if (!has_begun_ || !is_open_) return;
  if (run_.stage().is_controlled())
    throw std::logic_error("Analysis::take_loads: the load of the stage is controlled by a displacement");
  control_.drop_step();
  shown_u_.resize(0);
  StagePath& path = state_.path;
  const Eigen::VectorXd now = run_.loads_at(t);
  path.force_end = external_force(model_, done_.stage);
  if (path.water_force.size() > 0) path.force_end += path.water_force;
  if (path.let_in.size() > 0) path.force_end += path.let_in;
  Eigen::VectorXd beside_line = Eigen::VectorXd::Zero(now.size());
  run_.add_histories(t, beside_line);
  const auto start_of = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    return (at - beside_line - t * path.force_end) / (1.0 - t);
  };
  path.force_start = start_of(now);
  path.external_start = start_of(state_.external);
  system_.assembly().take_element_loads(t);
  control_.take_loads();
}

RunResult Analysis::Stages::close() {
  if (is_closed_) throw std::logic_error("Analysis::close: it has been closed before");
  is_closed_ = true;
  is_open_ = false;
  const bool is_done = is_complete() && (settings_.trials == nullptr || has_tried_);
  if (result_.status == RunStatus::completed && !is_done) result_.status = RunStatus::stopped;
  if (result_.status == RunStatus::stopped)
    result_.reason = "stopped as asked, with " + std::to_string(result_.stages_done) + " of " +
                     std::to_string(model_.stages.size()) + " stages and " +
                     std::to_string(result_.increments_done) + " increments complete";
  if (result_.status != RunStatus::stopped && result_.status != RunStatus::failed) {
    result_.kernels = system_.kernels();
    observer_list_.tell([&](Observer& o) { o.on_finish(model_, result_); });
  }
  RunResult result = result_;
  result.work.profile.show_in(nullptr);
  return result;
}

Analysis::Analysis(const Model& model, const Catalogue& catalogue, RunSettings settings,
                   std::span<Observer* const> observers)
    : stages_(std::make_unique<Stages>(model, catalogue, std::move(settings), observers)) {}
Analysis::~Analysis() = default;
Analysis::Analysis(Analysis&&) noexcept = default;
Analysis& Analysis::operator=(Analysis&&) noexcept = default;

bool Analysis::open() {
  return stages_->open();
}
bool Analysis::advance() {
  return stages_->advance();
}
Solution Analysis::state() {
  return stages_->state();
}
void Analysis::take_loads() {
  stages_->take_loads();
}
int Analysis::stage() const {
  return stages_->done().stage;
}
int Analysis::increment() const {
  return stages_->done().increment;
}
bool Analysis::is_complete() const {
  return stages_->is_complete();
}
RunResult Analysis::close() {
  return stages_->close();
}

}  // namespace sage
