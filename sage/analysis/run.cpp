#include "sage/analysis/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "sage/analysis/audit.hpp"
#include "sage/analysis/contraction.hpp"
#include "sage/analysis/explain.hpp"
#include "sage/analysis/extent.hpp"
#include "sage/analysis/initial_balance.hpp"
#include "sage/analysis/loads.hpp"
#include "sage/analysis/run_checkpoint.hpp"
#include "sage/analysis/stage_warnings.hpp"
#include "sage/analysis/trials.hpp"
#include "sage/model/active_dofs.hpp"

namespace sage {

namespace {

enum class StateSide { committed, trial };

// Attempts of a trial, of so many iterations each at most.
constexpr int kMostAttempts = 3;
// Damped iterations of an attempt, at least.
constexpr int kDamped = 200;

constexpr double kWaterBalance = 1e-11;
constexpr int kManyHeads = 20000;

// Stages, increments and the steps within them.
class Run {
 public:
  Run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
      std::span<Observer* const> observers)
      : model_(model),
        settings_(settings),
        audience_(observers, result_.work.profile),
        system_(model, catalogue, settings, result_.work),
        extent_(model),
        max_cuts_(settings.max_cuts) {
    const int dofs = assembly_.dof_map().dofs();
    if (settings.profile_memory) result_.work.profile = Profile(true);
    profile().show_in(settings.pulse);
    state_.u.setZero(dofs);
    state_.du.setZero(dofs);
    state_.external.setZero(dofs);
    assembly_.set_committed(state_.u);
    water_alone_ = !model.groups.empty() && std::ranges::all_of(model.groups, [](const Group& group) {
      return group.entry != nullptr && group.flow();
    });
  }

  RunResult execute();

 private:
  void start_new_nodes();
  void start_states(int s, const Activity& activity, const std::vector<InitialStress>& initials, bool drainage);
  void begin_water(int s, const PorePressure* water);
  void set_water(double reached);
  void find_solids();
  void evaluate_start();
  void prepare_stage(int s);
  void begin_stage(int s);
  bool run_stage(int s, int done);
  void end_stage(int s, double last_force);
  void end_increment(StepReport& report);
  void set_moment(double load_factor, double share);
  void show(const StepReport& report, double reached) const;
  bool run_increment(const Stage& stage, StepReport& report, double& reached);
  enum class Begin { committed, here, damped };
  NewtonStep attempt(const Stage& stage, double from, double to, Begin begin = Begin::committed,
                     double damping_fall = 0.0);
  bool can_damp(const NewtonStep& step) const;
  NewtonStep attempt_damped(const Stage& stage, StepReport& report, double from, double to,
                            const NewtonStep& failed);
  NewtonStep attempt_with_exits(const Stage& stage, double from, double to);
  NewtonStep settle_exits(const Stage& stage, double from, double to, bool from_here);
  NewtonStep settle_free_surface(const Stage& stage, double from, double to);
  void renew_tangent();
  bool contracts(const Stage& stage) const;
  bool predicts(const Stage& stage) const;
  bool goes_on(const Stage& stage, double size) const;
  bool can_repeat(const Stage& stage, double size) const;
  void accept(double reached);
  void reject(const Stage& stage, double reached, double next);
  void keep_way(double size);
  void start_on_last_way(double size);
  void measure_stiffness(double from, double to);
  double stiffness_share(double from, double to, const NewtonStep& step) const;
  double refused_motion(double from, double to, const NewtonStep& step) const;
  bool tries_otherwise(const Stage& stage, const NewtonStep& step, bool went_on, double reached, double size);
  bool fail(StepReport& report, const NewtonStep& step);
  void find_loose_part(const StepReport& report);
  void offer_checkpoint(RunPlace place);
  RunPlace resume();
  void start();
  void recover_for(const StepReport& report);
  void show_region_for(const StepReport& report);
  void catch_up(double reached);
  double load_work() const;
  void start_first_states();
  void run_stages();
  std::string keep_state();
  void give_back_state(const std::string& kept);
  TrialResult try_stage();
  void run_trial_stage();
  void take_motion(const Eigen::VectorXd& u, StateSide side);
  void run_trials();
  void stop();
  void warn(const std::vector<Diagnostic>& list);
  Solution solution() const;
  Profile& profile() { return result_.work.profile; }
  Resumable resumable() { return {model_, system_, state_, result_, audience_}; }

  const Model& model_;
  const RunSettings& settings_;
  RunResult result_;
  Audience audience_;
  System system_;
  RunState state_;
  Assembly& assembly_ = system_.assembly();
  Tangent& tangent_ = system_.tangent();
  StagePath& path_ = state_.path;
  RunPlace place_;        // the increment in hand
  double reached_ = 0.0;  // of the stage's loads, at the committed state
  const Extent extent_;
  Eigen::VectorXd target_;
  double force_left_ = 0.0;  // NewtonStep::force_left of the last step
  Eigen::VectorXd last_du_;  // the last step of the stage, if path_.last_size > 0
  // The next attempt is Newton's, whatever the method of its stage: 1 to a hundredth of its tolerance, 2 to all of it.
  int by_newton_ = 0;
  bool on_last_way_ = false;         // the next attempt starts with the tangent of that step
  Eigen::VectorXd committed_force_;  // internal, at the committed state; of scenes that are not linear
  // With a condensed region that is behind filled in, for observers; no entries: nobody looks.
  Eigen::VectorXd shown_u_, shown_force_;
  int max_cuts_;
  std::vector<char> of_solids_;  // by dof: some solid of the stage has it
  bool has_walls_ = false;       // interfaces or structures
  bool water_alone_ = false;     // flow is all that there is
  double easing_ = 1.0;          // of laws of water, on the way to a free surface
  // Of a trial: what it comes to, and where it began.
  TrialResult* trial_ = nullptr;
  Eigen::VectorXd trial_u_;
  std::vector<std::vector<double>> trial_strain_;
};

Solution Run::solution() const {
  const bool shown = shown_u_.size() > 0;
  return {shown ? &shown_u_ : &state_.u,
          shown ? &shown_force_ : &assembly_.internal_force(),
          &state_.external,
          &assembly_,
          &system_.activity(),
          {},
          place_.stage,
          reached_};
}

// Pore pressures at the end of a stage; nothing where the deck has no water.
std::optional<PorePressure> water_at(const Model& model, int s, const Activity& activity,
                                     const Eigen::VectorXd* u) {
  std::optional<PorePressure> water;
  if (!model.water.empty()) water.emplace(model, s, activity.group, activity.dof_map, u);
  return water;
}

// drainage: of the stage too, not of what stands before the first.
void Run::start_states(int s, const Activity& activity, const std::vector<InitialStress>& initials,
                       bool drainage) {
  Diagnostics warnings;
  const bool changes = drainage && changes_drainage(model_, s);
  const std::optional<PorePressure> water =
      initials.empty() ? std::nullopt : water_at(model_, s, activity, s > 0 ? &state_.u : nullptr);
  assembly_.start_states(!initials.empty() || changes, [&](std::vector<GroupData>& groups) {
    apply_initials(model_, initials, water ? &*water : nullptr, groups, warnings);
    if (changes) apply_drainage(model_, s, groups);
  });
  warn(warnings.list());
}

// The pore pressure of points goes from what it was to that of the stage.  What begins with stress has that of the
// stage from its start: its stress is what the pressure has left.
void Run::begin_water(int s, const PorePressure* water) {
  if (water == nullptr) return;
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  const std::size_t groups = assembly_.groups().size();
  path_.pore_start.assign(groups, {});
  path_.pore_end.assign(groups, {});
  for (std::size_t g = 0; g < groups; ++g) {
    GroupData& data = assembly_.groups()[g];
    if (!data.group->solid()) continue;
    const int points = data.group->element->traits().points;
    std::vector<double>& end = path_.pore_end[g];
    for (int e = 0; e < data.group->elements(); ++e)
      for (int p = 0; p < points; ++p) end.push_back(water->at_point(g, e, p));
    const auto states_stress = [&](const InitialStress& initial) {
      return initial.group == static_cast<int>(g) && initial.kind != InitialKind::history &&
             initial.kind != InitialKind::zero;
    };
    const bool active_from_here =
        s == 0 || std::ranges::find(stage.births, static_cast<int>(g)) != stage.births.end();
    const bool begins = (s == 0 && std::ranges::any_of(model_.initials, states_stress)) ||
                        std::ranges::any_of(stage.initials, states_stress) ||
                        (active_from_here && has_own_stress(model_, *data.group));
    if (data.pore.empty()) data.pore.assign(end.size(), 0.0);
    path_.pore_start[g] = begins ? end : data.pore;
  }
  path_.force_end += water_of(model_, system_.activity(), water);
  set_water(0.0);
}

// Whose dofs move the ground.
void Run::find_solids() {
  of_solids_.assign(static_cast<std::size_t>(assembly_.dof_map().displacements()), 0);
  has_walls_ = false;
  for (const GroupData& data : assembly_.groups()) {
    if (!data.active) continue;
    has_walls_ = has_walls_ || data.group->interface() || data.group->structure();
    if (!data.group->solid()) continue;
    for (const int node : data.group->nodes)
      for (int c = 0; c < 2; ++c) of_solids_[static_cast<std::size_t>(DofMap::displacement(node, c))] = 1;
  }
}

void Run::set_water(double reached) {
  for (std::size_t g = 0; g < path_.pore_end.size(); ++g) {
    std::vector<double>& now = assembly_.groups()[g].pore;
    for (std::size_t p = 0; p < path_.pore_end[g].size(); ++p)
      now[p] = (1.0 - reached) * path_.pore_start[g][p] + reached * path_.pore_end[g][p];
  }
}

void Run::warn(const std::vector<Diagnostic>& list) {
  for (const Diagnostic& diagnostic : list) audience_.warn(diagnostic);
}

// What is born has not moved yet, also where something was that has been removed since.
// Called before the stage is entered.
void Run::start_new_nodes() {
  if (std::ranges::all_of(system_.activity().group, [](char active) { return active != 0; })) return;
  const std::vector<char> borne = active_dofs(model_, system_.activity());
  for (std::size_t dof = 0; dof < borne.size(); ++dof)
    if (!borne[dof]) state_.u[static_cast<Eigen::Index>(dof)] = 0.0;
}

// What is evaluated from now on ends at that load factor of the stage, after a step of that share of it; 0 = a
// state that stands.
void Run::set_moment(double load_factor, double share) {
  if (assembly_.wants_moment())
    assembly_.set_moment(moment_at(model_, place_.stage, place_.increment, load_factor, share, easing_));
}

// The tangent of laws that depend on time is that of the first increment, where they have an answer for it; forces
// are those at its start.
void Run::evaluate_start() {
  const int s = place_.stage;
  const double increment = 1.0 / model_.stages[static_cast<std::size_t>(s)].increments;
  Tangent* tangent = tangent_.current() ? nullptr : &tangent_;
  if (assembly_.wants_moment() && tangent != nullptr) {
    set_moment(increment, increment);
    if (assembly_.evaluate(state_.du, tangent) == Outcome::ok) tangent = nullptr;
  }
  set_moment(0.0, 0.0);
  if (assembly_.evaluate(state_.du, tangent) == Outcome::cut_step)
    throw AnalysisError("S503",
                        "stage " + std::to_string(s + 1) + ": a law cannot start from the state it is given");
}

// The states and the loads at both ends of a stage.  What the forces of removed parts, initial stress and
// released supports leave out of balance is held at the start and let go in proportion over the stage.
void Run::prepare_stage(int s) {
  const Profile::Scope scope(profile(), phase::kStart);
  start_new_nodes();
  system_.open_stage(s);
  find_solids();
  start_states(s, system_.activity(), model_.stages[static_cast<std::size_t>(s)].initials, true);
  state_.du.setZero();
  path_.repeats.forget();
  on_last_way_ = false;
  place_ = {s, 0};
  reached_ = 0.0;
  path_.prediction = {};
  path_.own_tangent = false;
  evaluate_start();
  assembly_.commit(state_.du);
  path_.force_start = assembly_.internal_force();
  if (!tangent_.constant()) committed_force_ = path_.force_start;
  path_.last_size = path_.stiffest = path_.last_stiffness = 0.0;
  path_.force_end = external_force(model_, s);
  const std::optional<PorePressure> water = water_at(model_, s, system_.activity(), &state_.u);
  begin_water(s, water ? &*water : nullptr);
  path_.u_start.resize(0);
  if (assembly_.condensation() != nullptr) {
    path_.u_start = state_.u;
    assembly_.set_stage_loads(path_.force_end - path_.force_start);
  }
  path_.external_start = state_.external;
  const InitialImbalance imbalance =
      initial_imbalance(model_, system_.activity(), s, path_.force_start, path_.force_end);
  if (imbalance.counts())
    audience_.warn(stage_message(model_.stages[static_cast<std::size_t>(s)], "S528",
                                 explain_imbalance(model_, s, imbalance), Severity::note));
  path_.path_error = 0.0;
  path_.loose_part.clear();
}

bool Run::contracts(const Stage& stage) const {
  return settings_.skips.contraction && stage.method == Method::newton && !tangent_.constant() &&
         is_large(assembly_.equations());
}

bool Run::can_repeat(const Stage& stage, double size) const {
  const bool newton = stage.method == Method::newton || stage.method == Method::dogleg;
  // In a small linear scene a correction with kept factors costs little, and mends the rounding of the steps before, which
  // repetitions keep.
  const bool pays = !tangent_.constant() || (!water_alone_ && is_large(assembly_.equations()));
  return settings_.skips.repeats && newton && pays && path_.repeats.due(size);
}

// Whether steps of the stage may start from the way of the one before.
bool Run::predicts(const Stage& stage) const {
  return settings_.skips.prediction && stage.method == Method::newton && !tangent_.linear() &&
         assembly_.condensation() == nullptr && assembly_.dof_map().only_displacement();
}

bool Run::goes_on(const Stage& stage, double size) const {
  return path_.prediction.due() && predicts(stage) && !path_.repeats.due(size);
}

// here: state_.du is near the answer, but for what is prescribed.
NewtonStep Run::attempt(const Stage& stage, double from, double to, Begin begin, double damping_fall) {
  target_ = (1.0 - to) * path_.force_start + to * path_.force_end;
  set_moment(to, to - from);
  constexpr int kShort = 50;
  NewtonSettings newton{by_newton_ > 0 ? Method::newton : stage.method, stage.max_iterations, stage.tolerance,
                        settings_.line_search};
  if (by_newton_ == 1) {
    newton.tolerance *= 0.01;
    newton.max_iterations = std::min(newton.max_iterations, kShort);
  }
  newton.pulse = settings_.pulse;
  newton.committed = &state_.u;
  newton.unknowns = &model_.unknowns;
  newton.size = extent_.size();
  if (begin != Begin::committed) newton.start = NewtonStart::nearby;
  if (begin == Begin::damped) {
    newton.damping_fall = damping_fall;
    newton.of_solids = &of_solids_;
    newton.max_iterations = std::max(kDamped, 5 * stage.max_iterations);
  }
  if (begin == Begin::committed && goes_on(stage, to - from)) {
    newton.start = NewtonStart::last_way;
    state_.du *= (to - from) / path_.last_size;
  }
  // What is put in comes out to ten digits.  The rounding of many heads is all on one side and adds up.
  if (water_alone_ && easing_ == 1.0) {
    newton.tolerance = std::min(stage.tolerance, kWaterBalance);
    newton.refine = assembly_.equations() >= kManyHeads;
  }
  if (begin != Begin::damped) {
    if (can_repeat(stage, to - from))
      newton.repeat = path_.repeats.limit(newton.tolerance, tangent_.constant());
    newton.contract = contracts(stage);
    newton.stop_at_flow = settings_.trials != nullptr;
  }
  if (path_.u_start.size() > 0) newton.so_far = {from, &path_.u_start, &state_.u};
  const Profile::Scope scope(profile(), phase::kIteration);
  return newton_step(assembly_, tangent_, target_, system_.rate(), to - from, newton, result_.work, state_.du);
}

// Whether a step that failed is tried once more with damped corrections.  Walls in joints lose their hold in single
// iterations, without a limit of the ground.
bool Run::can_damp(const NewtonStep& step) const {
  if (step.outcome == StepOutcome::converged || tangent_.linear() || assembly_.condensation() != nullptr ||
      assembly_.dof_map().displacements() == 0)
    return false;
  // These are tried again otherwise first.
  if (step.finished || by_newton_ == 1 || (step.outcome == StepOutcome::singular && on_last_way_)) return false;
  if (settings_.trials == nullptr) return has_walls_;
  return has_walls_ || (!step.flows && step.outcome != StepOutcome::singular);
}

// Whether ground that ran away shows a collapse.  At a collapse the loads exceed what the ground carries by little, since
// factors are tried from near; corrections that damping let go too early leave most forces without balance.
bool shows_collapse(const NewtonStep& step) {
  constexpr double kExcess = 0.01;  // of all forces
  return step.flows && !step.iterations.empty() && step.iterations.back().force <= kExcess;
}

// failed: Newton's attempt at the same step.
NewtonStep Run::attempt_damped(const Stage& stage, StepReport& report, double from, double to,
                               const NewtonStep& failed) {
  constexpr std::array<double, 3> kFalls{0.7, 0.9, 0.97};
  NewtonStep step = failed;
  for (const double fall : kFalls) {
    report.total_iterations += static_cast<int>(step.iterations.size());
    path_.repeats.forget();
    path_.prediction.forget();
    on_last_way_ = false;
    assembly_.drop_step();
    state_.du.setZero();
    set_moment(from, 0.0);
    if (!tangent_.has_elastic()) assembly_.take_elastic(tangent_);
    tangent_.forget();
    if (!tangent_.has_elastic()) return failed;
    step = attempt(stage, from, to, Begin::damped, fall);
    if (!step.flows || shows_collapse(step)) break;
  }
  step.flows = shows_collapse(step);
  const bool says_more = step.outcome == StepOutcome::converged || settings_.trials != nullptr;
  return says_more ? step : failed;
}

NewtonStep Run::attempt_with_exits(const Stage& stage, double from, double to) {
  const bool eased = assembly_.eases();
  if (!system_.has_exits() && !eased) return attempt(stage, from, to);
  path_.repeats.forget();
  if (system_.has_exits()) system_.start_exits(state_.u, to - from);
  return eased ? settle_free_surface(stage, from, to) : settle_exits(stage, from, to, false);
}

// Some rounds of this settle which places water leaves at; places that are switched to and fro end the run.
NewtonStep Run::settle_exits(const Stage& stage, double from, double to, bool from_here) {
  constexpr int kMostRounds = 50;
  std::vector<IterationRecord> iterations;  // of a free surface, all
  for (int round = 0; round < kMostRounds; ++round) {
    NewtonStep step = attempt(stage, from, to, from_here ? Begin::here : Begin::committed);
    if (assembly_.eases()) {
      iterations.insert(iterations.end(), step.iterations.begin(), step.iterations.end());
      step.iterations = iterations;
      from_here = true;
    }
    if (step.outcome != StepOutcome::converged) return step;
    if (!system_.has_exits() || !system_.switch_exits(state_.u, state_.du, target_, to - from)) return step;
  }
  throw AnalysisError("S529", chattering_exits(model_, stage, system_.exits().switched(), kMostRounds));
}

// Where a free surface lies is found from far to near: first the soil falls dry over a height many times the one that
// is meant, then each answer starts the next, sharper one.  One that is not found is reached in smaller steps.
NewtonStep Run::settle_free_surface(const Stage& stage, double from, double to) {
  constexpr double kWidest = 64.0, kSharper = 4.0, kLeast = 1.02;
  struct Restore {
    double& easing;
    ~Restore() { easing = 1.0; }
  } const restore{easing_};
  std::vector<IterationRecord> iterations;
  Eigen::VectorXd found;
  double wide = 0.0;  // of the answer in `found`
  double ratio = kSharper;
  for (easing_ = kWidest;;) {
    NewtonStep step = settle_exits(stage, from, to, found.size() > 0);
    iterations.insert(iterations.end(), step.iterations.begin(), step.iterations.end());
    if (step.outcome == StepOutcome::converged) {
      if (easing_ <= 1.0) {
        step.iterations = iterations;
        return step;
      }
      if (found.size() > 0 && wide / easing_ >= 0.99 * ratio) ratio = std::min(kSharper, ratio * ratio);
      wide = easing_;
      found = state_.du;
    } else {
      ratio = std::sqrt(ratio);
      if (found.size() == 0 || ratio < kLeast) {
        if (water_alone_) throw AnalysisError("S539", lost_free_surface(stage, easing_, wide));
        step.iterations = iterations;
        return step;
      }
      state_.du = found;
    }
    easing_ = wide / ratio < 1.001 ? 1.0 : wide / ratio;
  }
}

// Modified Newton: the tangent at the end of a step serves the next one.  It must be taken with the step still
// in hand: at du = 0 a law on its yield surface answers elastically.
void Run::renew_tangent() {
  if (!tangent_.constant()) assembly_.evaluate(state_.du, &tangent_);
}

void Run::accept(double reached) {
  assembly_.commit(state_.du);
  if (assembly_.sees_unknowns()) state_.u_before = state_.u;
  state_.u += state_.du;
  reached_ = reached;
  state_.external = (1.0 - reached) * path_.external_start + reached * path_.force_end;
  if (!path_.pore_end.empty()) set_water(reached);
  if (!assembly_.region_is_behind()) result_.motion = std::max(result_.motion, extent_.motion(state_.u));
}

// Drops the step in hand; reached: load factor of the committed state.
void Run::catch_up(double reached) {
  assembly_.drop_step();
  if (!assembly_.region_is_behind()) return;
  target_ = (1.0 - reached) * path_.force_start + reached * path_.force_end;
  assembly_.catch_up(target_, reached, path_.u_start, state_.u);
  result_.motion = std::max(result_.motion, extent_.motion(state_.u));
}

// Of the step in hand, along the loads of the stage.
double Run::load_work() const {
  const Eigen::VectorXd loads = path_.force_end - path_.force_start;
  const Condensation* const region = assembly_.condensation();
  return region != nullptr ? region->load_work(loads, state_.du) : loads.dot(state_.du);
}

// Back to the committed state, with its own internal forces.  The next attempt starts with the tangent of the
// way that the last step took.  At du = 0 points on their yield surfaces answer elastically: from there a cut
// step would have to find all of the plastic zone anew, however short it is.
// reached: load factor of that state.  next: share of the stage of the attempt; 0 = from there all the same.
void Run::reject(const Stage& stage, double reached, double next) {
  path_.repeats.forget();
  path_.prediction.forget();
  on_last_way_ = false;
  catch_up(reached);
  const bool keep_K = tangent_.constant() || stage.method == Method::initial_stiffness;
  if (!keep_K) {
    tangent_.set_aside();
    set_moment(reached + next, next);
    if (next > 0.0) start_on_last_way(next);
  }
  state_.du.setZero();
  set_moment(reached, 0.0);
  assembly_.evaluate(state_.du, nullptr);
}

// Linear scenes cut no step.
void Run::keep_way(double size) {
  if (tangent_.linear()) return;
  last_du_ = state_.du;
  path_.last_size = size;
  committed_force_ = assembly_.internal_force();
}

// K half way along the last step once more, in its direction, for a step of this share of the stage.
void Run::start_on_last_way(double size) {
  if (!(path_.last_size > 0.0)) return;
  state_.du = (0.5 * size / path_.last_size) * last_du_;
  on_last_way_ = assembly_.evaluate(state_.du, &tangent_) == Outcome::ok;
}

// Of the step in hand: where supports move, the growth of their forces along their own motion; else the growth
// of the loads over the motion along them.  Both fall to nothing at a limit load (Bergan's current stiffness).
void Run::measure_stiffness(double from, double to) {
  if (tangent_.linear()) return;
  const double size = to - from;
  double work = 0.0;
  if (!system_.rate().isZero(0.0)) {
    const Eigen::VectorXd& f = assembly_.internal_force();
    for (int dof = 0; dof < assembly_.dof_map().dofs(); ++dof)
      if (system_.rate()[dof] != 0.0) work += (f[dof] - committed_force_[dof]) * system_.rate()[dof];
    path_.last_stiffness = work / size;
  } else {
    work = load_work();
    path_.last_stiffness = work > 0.0 ? size / work : 0.0;
  }
  path_.stiffest = std::max(path_.stiffest, path_.last_stiffness);
}

// After a failed attempt: that of the last step, and under loads that of the attempt where it ran away.
// Before any step the attempt's first correction, which is elastic, stands for the stage.
double Run::stiffness_share(double from, double to, const NewtonStep& step) const {
  if (tangent_.linear()) return -1.0;
  const double size = to - from;
  if (!system_.rate().isZero(0.0))
    return path_.stiffest > 0.0 && path_.last_size > 0.0 ? path_.last_stiffness / path_.stiffest : -1.0;
  const double work = load_work();
  const double attempt = work > 0.0 && std::isfinite(work) ? size / work : 0.0;
  const double elastic = step.predicted_work > 0.0 ? size * size / step.predicted_work : 0.0;
  const double largest = std::max(path_.stiffest, elastic);
  if (!(largest > 0.0)) return -1.0;
  return std::min(attempt, path_.last_size > 0.0 ? path_.last_stiffness : attempt) / largest;
}

// A step that moves a node by a thousand times the model's size while hardly anything resists is flow at a
// limit load: an equilibrium far away that rounding and the mesh's own faults give (reduced integration, nu
// near 1/2). Returns its motion as a share of that size; 0 = the step may stand.
double Run::refused_motion(double from, double to, const NewtonStep& step) const {
  constexpr double kFar = 1e3;    // model's sizes
  constexpr double kSoft = 0.01;  // of the stage's largest stiffness, or prescribed motion over the largest
  if (step.outcome != StepOutcome::converged || tangent_.linear()) return 0.0;
  const int n = assembly_.dof_map().displacements();
  const double motion = n > 0 ? state_.du.head(n).lpNorm<Eigen::Infinity>() : 0.0;
  if (!(motion > kFar * extent_.size()) || !(extent_.size() > 0.0)) return 0.0;
  const double prescribed = (to - from) * system_.rate().head(n).lpNorm<Eigen::Infinity>();
  const double share = prescribed > 0.0 ? prescribed / motion : stiffness_share(from, to, step);
  return share >= 0.0 && share < kSoft ? motion / extent_.size() : 0.0;
}

// reached: load factor of the stage.
void Run::show(const StepReport& report, double reached) const {
  Pulse* const pulse = settings_.pulse;
  if (pulse == nullptr) return;
  double all = 0.0, before = 0.0;
  for (int s = 0; s < static_cast<int>(model_.stages.size()); ++s) {
    const int increments = model_.stages[static_cast<std::size_t>(s)].increments;
    all += increments;
    if (s < report.stage) before += increments;
  }
  pulse->share = (before + reached * report.increments) / all;
  pulse->stage = report.stage + 1;
  pulse->stages = static_cast<int>(model_.stages.size());
  pulse->increment = report.increment;
  pulse->increments = report.increments;
  pulse->iterated(0, std::numeric_limits<double>::quiet_NaN());
}

// Whether a step that failed is tried once more in another way before it is cut.  size: of the step.
bool Run::tries_otherwise(const Stage& stage, const NewtonStep& step, bool went_on, double reached,
                          double size) {
  // The way of the last step may lead nowhere where that from the committed state does not.
  if (went_on) {
    path_.prediction.fail();
    reject(stage, reached, size);
    return true;
  }
  // The tangent of a step whose ground flows everywhere is too soft for points that stop to flow in the next one.
  if (stage.method == Method::modified_newton && !path_.own_tangent && !tangent_.linear()) {
    path_.own_tangent = true;
    reject(stage, reached, 0.0);
    return true;
  }
  // From a place that a kept tangent has reached Newton's method may find nothing where it does from the start.
  // It comes nearer than the stage asks, if it can.
  if ((step.finished && by_newton_ == 0) || by_newton_ == 1) {
    ++by_newton_;
    reject(stage, reached, 0.0);
    return true;
  }
  by_newton_ = 0;
  // Half way along a collapse mechanism the matrix may be singular where the committed state's is not.
  if (step.outcome == StepOutcome::singular && on_last_way_) {
    reject(stage, reached, 0.0);
    return true;
  }
  return false;
}

bool Run::run_increment(const Stage& stage, StepReport& report, double& reached) {
  const double end = static_cast<double>(report.increment) / report.increments;
  const double whole = 1.0 / report.increments;
  double size = end - reached;
  int iterations = 0;  // of Newton's attempts
  report.substeps = 0;
  place_ = {report.stage, report.increment};
  while (reached < end) {
    const double to = size >= end - reached - 1e-12 * whole ? end : reached + size;
    show(report, reached);
    const bool went_on = goes_on(stage, to - reached);
    NewtonStep step = attempt_with_exits(stage, reached, to);
    iterations += static_cast<int>(step.iterations.size());
    const bool last_cut = to - reached < 1.001 * std::ldexp(whole, -max_cuts_);
    const bool damps = settings_.trials != nullptr || last_cut;
    if (damps && !went_on && can_damp(step)) step = attempt_damped(stage, report, reached, to, step);
    report.iterations = step.iterations;
    report.total_iterations += static_cast<int>(step.iterations.size());
    report.worst = step.worst;
    const double refused = refused_motion(reached, to, step);
    if (refused > 0.0) report.refused = refused;
    if (step.outcome == StepOutcome::converged && refused == 0.0) {
      const double error = assembly_.path_error();
      if (error > kPathTolerance && to - reached > 1.001 * kSmallestPart * whole) {
        size = (to - reached) * std::clamp(0.9 * std::cbrt(kPathTolerance / error), 0.25, 0.75);
        size = std::max(size, kSmallestPart * whole);
        reject(stage, reached, 0.0);
        continue;
      }
      path_.path_error = std::max(path_.path_error, error);
      force_left_ = step.repeated ? step.iterations.back().force : step.force_left;
      path_.own_tangent = path_.own_tangent || step.finished;
      by_newton_ = 0;
      const bool modified = stage.method == Method::modified_newton && !path_.own_tangent;
      if (modified || (contracts(stage) && !predicts(stage))) renew_tangent();
      const bool same_K = tangent_.constant() || !tangent_.changed();
      const bool linear = step.iterations.size() == 1 && same_K;
      if (!step.repeated) path_.repeats.take(linear, to - reached, step.iterations.back().force);
      on_last_way_ = false;
      if (path_.own_tangent) tangent_.set_aside();
      measure_stiffness(reached, to);
      accept(to);
      keep_way(to - reached);
      path_.prediction.take(report.cuts > 0);
      reached = to;
      report.load_factor = reached;
      ++report.substeps;
      if (step.iterations.size() <= 6 && 8.0 * error <= kPathTolerance) size *= 2.0;
      continue;
    }
    if (tries_otherwise(stage, step, went_on, reached, to - reached)) continue;
    report.points = assembly_.count_points();
    report.failed_at = to;  // beyond `reached`, which may have passed an earlier failure
    const bool given_up =
        trial_ != nullptr && (step.flows || iterations >= kMostAttempts * stage.max_iterations);
    if (given_up || last_cut || tangent_.linear()) {
      report.stiffness_share = stiffness_share(reached, to, step);
      return fail(report, step);
    }
    ++report.cuts;
    size = 0.5 * (to - reached);
    reject(stage, reached, size);
  }
  return true;
}

bool Run::fail(StepReport& report, const NewtonStep& step) {
  report.converged = false;
  report.flows = step.flows || (step.outcome == StepOutcome::singular && !has_walls_);
  report.spares_ground = step.spares_ground;
  if (trial_ != nullptr) {
    trial_->outcome = step.outcome;
    trial_->reason = step.outcome == StepOutcome::singular
                         ? explain_singular(model_, system_.activity(), assembly_, report, step)
                         : explain_failure(model_, assembly_, report, step);
    catch_up(report.load_factor);
    take_motion(state_.u + state_.du, StateSide::trial);
    return false;
  }
  if (step.outcome == StepOutcome::singular) {
    result_.status = RunStatus::singular;
    result_.code = Code("S502");
    result_.reason = explain_singular(model_, system_.activity(), assembly_, report, step);
  } else {
    result_.status = RunStatus::not_converged;
    result_.code = Code("S501");
    result_.reason = explain_failure(model_, assembly_, report, step);
  }
  result_.reason = with_code(result_.reason, *result_.code);
  state_.du.setZero();
  set_moment(report.load_factor, 0.0);
  catch_up(report.load_factor);
  report.motion = result_.motion;
  warn(motion_warnings(model_.stages[static_cast<std::size_t>(report.stage)], result_.motion));
  assembly_.evaluate(state_.du, nullptr);
  assembly_.recover_states();
  audience_.tell([&](Observer& o) { o.on_failure(model_, report, result_.reason, solution()); });
  return false;
}

// Newton's matrix is singular then; a matrix that is kept from before finds an equilibrium all the same.
void Run::find_loose_part(const StepReport& report) {
  if (!path_.loose_part.empty() || report.points[static_cast<std::size_t>(PointStatus::open)] == 0) return;
  path_.loose_part = explain_loose_part(model_, system_.activity(), assembly_);
  if (!path_.loose_part.empty())
    path_.loose_part = "increment " + std::to_string(report.increment) + ": " + path_.loose_part;
}

void Run::start() {
  audience_.tell(
      [&](Observer& o) { o.on_start(model_, system_.scene(), tangent_.name(), system_.equations()); });
}

void Run::offer_checkpoint(RunPlace place) {
  if (!settings_.checkpoint_due || !settings_.checkpoint_due()) return;
  const Profile::Scope scope(profile(), phase::kCheckpoint);
  const std::string bytes = checkpoint_bytes(resumable(), place);
  audience_.outside([&] { settings_.save_checkpoint(bytes); });
}

RunPlace Run::resume() {
  const RunPlace place = resume_from(resumable(), settings_.resume_from);
  last_du_ = state_.du;
  committed_force_ = assembly_.internal_force();
  if (path_.own_tangent) tangent_.set_aside();
  if (place.increment > 0 && assembly_.condensation() != nullptr)
    assembly_.set_stage_loads(path_.force_end - path_.force_start);
  return place;
}

// Stress and strain of linear elements, if somebody will look at them.  Where laws are asked all come up to date at
// once: forces made from stresses are rounded otherwise than those that go on, and a stage near its limit load shows it.
void Run::recover_for(const StepReport& report) {
  const bool structures = audience_.wants_structures(model_, report);
  if (audience_.wants_states(model_, report) || (structures && !system_.scene().linear))
    assembly_.recover_states();
  else if (structures)
    assembly_.recover_structures();
}

// Those who look at inner nodes of a region that is behind are shown it filled in.
void Run::show_region_for(const StepReport& report) {
  const bool states = audience_.wants_states(model_, report) || audience_.wants_structures(model_, report);
  if (!states && !audience_.wants_nodes(model_, report, assembly_.condensation()->inner_nodes())) return;
  Eigen::VectorXd motion;
  assembly_.show_region(motion, shown_force_);
  shown_u_ = state_.u + motion;
  if (states) assembly_.recover_states_at(motion);
}

void Run::begin_stage(int s) {
  StepReport report;
  report.stage = s;
  report.increments = model_.stages[static_cast<std::size_t>(s)].increments;
  show(report, 0.0);
  prepare_stage(s);
  if (s == 0) start();
  recover_for(report);
  audience_.tell([&](Observer& o) { o.on_stage_start(model_, s, solution()); });
}

void Run::end_increment(StepReport& report) {
  report.points = assembly_.count_points();
  find_loose_part(report);
  report.motion = assembly_.region_is_behind() ? std::numeric_limits<double>::quiet_NaN() : result_.motion;
  report.smallest_pivot_ratio = system_.smallest_pivot();
  ++result_.increments_done;
  if (assembly_.region_is_behind())
    show_region_for(report);
  else
    recover_for(report);
  audience_.tell([&](Observer& o) { o.on_increment(model_, report, solution()); });
  shown_u_.resize(0);
}

void Run::end_stage(int s, double last_force) {
  ++result_.stages_done;
  EquilibriumAudit sums;
  {
    const Profile::Scope scope(profile(), phase::kChecks);
    sums = audit_equilibrium(model_, assembly_, state_.external, path_.force_start, state_.u);
    warn(stage_warnings(
        model_.stages[static_cast<std::size_t>(s)],
        {result_.motion, sums.out_of_balance, system_.digits(), path_.path_error, path_.loose_part, last_force},
        assembly_));
    warn(gradient_warnings(model_, model_.stages[static_cast<std::size_t>(s)], system_.activity()));
    warn(free_surface_warnings(model_, model_.stages[static_cast<std::size_t>(s)], assembly_));
    if (settings_.stream_function)
      warn(stream_warnings(model_, model_.stages[static_cast<std::size_t>(s)], solution()));
  }
  audience_.tell([&](Observer& o) { o.on_stage_end(model_, s, sums, solution()); });
}

// done: increments that a checkpoint has behind it.
bool Run::run_stage(int s, int done) {
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  if (done == 0) begin_stage(s);
  const bool whole_stages_only = stage.method == Method::initial_stiffness && !tangent_.constant();
  const bool is_last = settings_.trials == nullptr && s + 1 == static_cast<int>(model_.stages.size());
  double last_force = 0.0;  // out of balance at the end of the last increment, relative
  double reached = static_cast<double>(done) / stage.increments;
  for (int i = done + 1; i <= stage.increments; ++i) {
    StepReport report;
    report.stage = s;
    report.increment = i;
    report.increments = stage.increments;
    report.load_factor = reached;
    if (!run_increment(stage, report, reached)) return false;
    last_force = force_left_;
    if (is_last && i == stage.increments) {
      const Profile::Scope scope(profile(), phase::kChecks);
      system_.release_solver();
    }
    end_increment(report);
    if (i == stage.increments) break;
    if (!whole_stages_only) offer_checkpoint({s, i});
    stop_if_asked(settings_.stop_asked);
  }
  end_stage(s, last_force);
  if (s + 1 == static_cast<int>(model_.stages.size())) return true;
  offer_checkpoint({s + 1, 0});
  stop_if_asked(settings_.stop_asked);
  return true;
}

// Who lives at the start only matters to pore pressures.
void Run::start_first_states() {
  assembly_.start_states(has_own_start(model_),
                         [&](std::vector<GroupData>& groups) { apply_own_starts(model_, groups); });
  if (model_.water.empty()) return start_states(0, system_.activity(), model_.initials, false);
  Activity first(model_);
  first.enter(model_.stages.front());
  start_states(0, first, model_.initials, false);
}

void Run::run_stages() {
  RunPlace place;
  if (settings_.resume_from.empty())
    start_first_states();
  else
    place = resume();
  const int stages =
      settings_.trials != nullptr ? settings_.trials->stage() : static_cast<int>(model_.stages.size());
  for (int s = place.stage; s < stages; ++s)
    if (!run_stage(s, s == place.stage ? place.increment : 0)) return;
  if (settings_.trials != nullptr) run_trials();
}

// Everything that the next trial starts from; the tangent is made anew.
std::string Run::keep_state() {
  Archive archive;
  state_.exchange_totals(archive);
  assembly_.exchange(archive, false);
  return archive.take();
}

void Run::give_back_state(const std::string& kept) {
  Archive archive(kept);
  state_.exchange_totals(archive);
  assembly_.exchange(archive, false);
  state_.du.setZero();
  tangent_.forget();
}

// Since the start of the trial.  Groups whose states come late have no strain here.
void Run::take_motion(const Eigen::VectorXd& u, StateSide side) {
  trial_->motion = u - trial_u_;
  const std::vector<GroupData>& groups = assembly_.groups();
  trial_->strain.assign(groups.size(), {});
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].active || groups[g].constant) continue;
    const StateStore& store = groups[g].state;
    std::vector<double>& strain = trial_->strain[g];
    strain = side == StateSide::trial ? store.trial.eps : store.committed.eps;
    for (std::size_t i = 0; i < strain.size(); ++i) strain[i] -= trial_strain_[g][i];
  }
}

// What the new laws no longer carry of the stresses is held at first and let go in proportion (prepare_stage).  The
// first correction has the stiffness of points that have just returned to their surfaces, which is elastic: that of the
// return itself leads far away where flow is not associated.
void Run::run_trial_stage() {
  const int s = settings_.trials->stage();
  StepReport& report = trial_->report;
  report.stage = s;
  report.increment = report.increments = 1;
  prepare_stage(s);
  tangent_.forget();
  if (!assembly_.condensation()) assembly_.evaluate(state_.du, &tangent_);
  double reached = 0.0;
  trial_->equilibrium = run_increment(model_.stages[static_cast<std::size_t>(s)], report, reached);
  if (!trial_->equilibrium) return;
  report.points = assembly_.count_points();
  take_motion(state_.u, StateSide::committed);
  trial_->outcome = StepOutcome::converged;
}

// What a law or the solver refuses is an answer too.
TrialResult Run::try_stage() {
  TrialResult result;
  trial_ = &result;
  trial_u_ = state_.u;
  trial_strain_.clear();
  for (const GroupData& data : assembly_.groups()) trial_strain_.push_back(data.state.committed.eps);
  try {
    run_trial_stage();
  } catch (const AnalysisError& error) {
    result.outcome = StepOutcome::law_cut;
    result.reason = error.what();
    take_motion(state_.u, StateSide::committed);
  }
  trial_ = nullptr;
  return result;
}

void Run::run_trials() {
  assembly_.recover_states();
  std::string kept = keep_state();
  bool more = settings_.trials->next(nullptr, solution());
  while (more) {
    max_cuts_ = settings_.trials->max_cuts();
    assembly_.take_laws();
    const TrialResult result = try_stage();
    if (result.equilibrium)
      kept = keep_state();
    else
      give_back_state(kept);
    more = settings_.trials->next(&result, solution());
    stop_if_asked(settings_.stop_asked);
  }
}

void Run::stop() {
  result_.status = RunStatus::stopped;
  result_.reason = "stopped as asked, with " + std::to_string(result_.stages_done) + " of " +
                   std::to_string(model_.stages.size()) + " stages and " +
                   std::to_string(result_.increments_done) + " increments complete";
}

RunResult Run::execute() {
  try {
    run_stages();
  } catch (const Stopped&) {
    stop();
    return result_;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (audience_.is_outside()) throw;
    result_.status = RunStatus::failed;
    const auto* coded = dynamic_cast<const CodedError*>(&error);
    result_.code = coded != nullptr ? coded->code() : Code("S510");
    result_.reason = with_code(error.what(), *result_.code);
    return result_;
  }
  result_.kernels = system_.kernels();
  audience_.tell([&](Observer& o) { o.on_finish(model_, result_); });
  return result_;
}

}  // namespace

RunResult run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
              std::span<Observer* const> observers) {
  RunResult result = Run(model, catalogue, settings, observers).execute();
  result.work.profile.show_in(nullptr);
  return result;
}

}  // namespace sage
