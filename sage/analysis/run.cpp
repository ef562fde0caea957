#include "sage/analysis/run.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/condition.hpp"
#include "sage/analysis/explain.hpp"
#include "sage/analysis/initial_balance.hpp"
#include "sage/analysis/loads.hpp"
#include "sage/analysis/newton.hpp"
#include "sage/analysis/uniqueness.hpp"

namespace sage {

namespace {

// Everything that a run carries from stage to stage.
class Run {
 public:
  Run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
      std::span<Observer* const> observers)
      : model_(model),
        catalogue_(catalogue),
        settings_(settings),
        observers_(observers),
        scene_(analyse_scene(model)),
        assembly_(model, scene_, settings.skips, result_.work),
        activity_(model),
        lived_(model.groups.size(), 0) {
    u_.setZero(model.dofs());
    du_.setZero(model.dofs());
    external_.setZero(model.dofs());
    measure_extent();
    assembly_.set_stop(settings.stop_asked);
  }

  RunResult execute();

 private:
  // Where a run stands: increments of a stage that are done.
  struct Place {
    int stage = 0, increment = 0;
  };

  void place_groups(const Stage& stage);
  void start_new_nodes();
  void start_states(const std::vector<InitialStress>& initials);
  bool open_stage(int s);
  void prepare_stage(int s);
  const SolverEntry* choose_solver(int equations, bool symmetric) const;
  void prepare(LinearSolver& solver) const;
  void make_solver();
  bool run_stage(int s, int done);
  bool run_increment(const Stage& stage, StepReport& report, double& reached);
  NewtonStep attempt(const Stage& stage, double from, double to);
  void renew_tangent();
  bool contracts(const Stage& stage) const;
  bool can_repeat(const Stage& stage, double size) const;
  void accept(double reached);
  void reject(const Stage& stage, double next);
  void keep_way(double size);
  void start_on_last_way(double size);
  void measure_stiffness(double from, double to);
  double stiffness_share(double from, double to, const NewtonStep& step) const;
  double refused_motion(double from, double to, const NewtonStep& step) const;
  void warn_about_motion(const Stage& stage);
  void measure_extent();
  double motion() const;
  bool fail(StepReport& report, const NewtonStep& step);
  void exchange(Archive& archive, const Place& place);
  void offer_checkpoint(Place place);
  void recover_for(const StepReport& report);
  Place resume();
  void run_stages();
  void stop();
  EquilibriumAudit audit() const;
  int all_equations() const;
  double smallest_pivot() const;
  void warn_about_numbers(int s, const EquilibriumAudit& sums);
  void find_loose_part(const StepReport& report);
  void warn(const Stage& stage, const std::string& message, Severity severity = Severity::warning);
  Solution solution() const;
  template <class Call>
  void tell(Call call) {
    const Timer timer(result_.work.output_seconds);
    for (Observer* observer : observers_) call(*observer);
  }

  const Model& model_;
  const Catalogue& catalogue_;
  const RunSettings& settings_;
  std::span<Observer* const> observers_;
  Scene scene_;
  RunResult result_;
  Assembly assembly_;
  Activity activity_;
  std::unique_ptr<LinearSolver> solver_;
  std::string solver_name_;
  Stiffness stiffness_;
  Eigen::VectorXd u_, du_, external_, target_, external_start_, force_start_, force_end_, rate_;
  double linear_size_ = 0.0;  // of the last step, where it was linear; 0 = it was not
  Eigen::VectorXd last_du_;   // the last step of the stage, its share of the stage; 0 = there is none
  double last_size_ = 0.0;
  bool on_last_way_ = false;                      // the next attempt starts with the tangent of that step
  Eigen::VectorXd committed_force_;               // internal, at the committed state
  double stiffest_ = 0.0, last_stiffness_ = 0.0;  // along the motion: largest of the stage, of the last step
  std::vector<char> held_before_, groups_before_, lived_;
  double path_error_ = 0.0;           // largest of the stage
  std::vector<int> nodes_;            // those that elements have
  Vector2 extent_ = Vector2::Zero();  // of the box around them
  double size_ = 0.0;                 // its longer side
  std::string loose_part_;            // the first of the stage
};

Solution Run::solution() const {
  return {&u_, &assembly_.internal_force(), &external_, &assembly_, &activity_};
}

void Run::start_states(const std::vector<InitialStress>& initials) {
  Diagnostics warnings;
  for (const InitialStress& initial : initials)
    apply_initial_stress(model_, initial, assembly_.groups()[static_cast<std::size_t>(initial.group)],
                         warnings);
  for (const Diagnostic& d : warnings.list()) tell([&](Observer& o) { o.on_warning(d); });
}

const SolverEntry* Run::choose_solver(int equations, bool symmetric) const {
  int code = settings_.solver >= 0 ? settings_.solver : model_.solver;
  if (code == 0 && settings_.choose_solver) code = settings_.choose_solver(equations, symmetric);
  const SolverEntry* entry = catalogue_.solvers.find(code);
  if (entry == nullptr)
    throw AnalysisError("solver " + std::to_string(code) + " is unknown; " + catalogue_.solvers.known());
  if (entry->symmetric && !symmetric)
    throw AnalysisError("solver " + entry->name +
                        " is for symmetric matrices only; this scene has an unsymmetric law");
  return entry;
}

void Run::prepare(LinearSolver& solver) const {
  solver.set_threads(settings_.threads);
  solver.set_refinement(settings_.refinement);
  solver.set_stop(settings_.stop_asked);
}

void Run::make_solver() {
  const SolverEntry* entry = choose_solver(assembly_.equations(), scene_.symmetric);
  solver_ = entry->make();
  prepare(*solver_);
  solver_name_ = entry->name;
  stiffness_ = {};
  stiffness_.solver = solver_.get();
}

// A group that has lived before comes back without stress and history.
void Run::place_groups(const Stage& stage) {
  for (int g : stage.births)
    if (lived_[static_cast<std::size_t>(g)]) assembly_.reset_group(static_cast<std::size_t>(g));
  for (std::size_t g = 0; g < lived_.size(); ++g) lived_[g] = lived_[g] || activity_.group[g];
}

// What is born has not moved yet, also where something was that has been removed since.
// Called before the stage is entered.
void Run::start_new_nodes() {
  if (std::ranges::all_of(activity_.group, [](char active) { return active != 0; })) return;
  const std::vector<char> borne = active_nodes(model_, activity_);
  for (int node = 0; node < model_.mesh.nodes(); ++node)
    if (!borne[static_cast<std::size_t>(node)]) u_.segment<2>(2 * node).setZero();
}

// What takes part, equations and numbering.  True if the pattern is that of the stage before.
bool Run::open_stage(int s) {
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  activity_.enter(stage);
  rate_ = prescribed_rate(model_, stage);
  place_groups(stage);
  const bool condensed_before = assembly_.condensation() != nullptr;
  assembly_.enter_stage(activity_, rate_);
  assembly_.condense(stage.increments, [&](int equations, bool symmetric) {
    auto solver = choose_solver(equations, symmetric)->make();
    prepare(*solver);
    return solver;
  });
  const bool same_pattern = solver_ && !condensed_before && !assembly_.condensation() &&
                            held_before_ == activity_.held && groups_before_ == activity_.group;
  if (!same_pattern) {
    make_solver();
    const Timer timer(result_.work.analyse_seconds);
    ++result_.work.analyses;
    solver_->analyse(assembly_.equations(), assembly_.element_equations());
    held_before_ = activity_.held;
    groups_before_ = activity_.group;
  }
  stiffness_.constant = scene_.linear && settings_.skips.factors;
  return same_pattern;
}

// The states and the loads at both ends of a stage.  What the forces of removed parts, initial stress and
// released supports leave out of balance is held at the start and let go in proportion over the stage.
void Run::prepare_stage(int s) {
  start_new_nodes();
  const bool same_pattern = open_stage(s);
  start_states(model_.stages[static_cast<std::size_t>(s)].initials);
  assembly_.take_states();
  const bool keep_factors = same_pattern && stiffness_.constant && stiffness_.factorised && rate_.isZero(0.0);
  if (!keep_factors) stiffness_.assembled = stiffness_.factorised = false;
  du_.setZero();
  linear_size_ = 0.0;
  if (assembly_.evaluate(du_, stiffness_.assembled ? nullptr : solver_.get()) == Outcome::cut_step)
    throw AnalysisError("stage " + std::to_string(s + 1) + ": a law cannot start from the state it is given");
  stiffness_.assembled = true;
  assembly_.commit(du_);
  force_start_ = committed_force_ = assembly_.internal_force();
  last_size_ = stiffest_ = last_stiffness_ = 0.0;
  force_end_ = external_force(model_, s);
  external_start_ = external_;
  const InitialImbalance imbalance = initial_imbalance(model_, activity_, s, force_start_, force_end_);
  if (imbalance.counts())
    warn(model_.stages[static_cast<std::size_t>(s)], explain_imbalance(model_, s, imbalance), Severity::note);
}

bool Run::contracts(const Stage& stage) const {
  constexpr int kLarge = 20000;  // equations: a factorisation costs a dozen force passes and solutions
  return settings_.skips.contraction && stage.method == Method::newton && !stiffness_.constant &&
         assembly_.equations() > kLarge;
}

// After a step of the same size that was linear: one correction, and the very same K at its end.
bool Run::can_repeat(const Stage& stage, double size) const {
  const bool newton = stage.method == Method::newton || stage.method == Method::dogleg;
  return settings_.skips.repeats && newton && !stiffness_.constant && linear_size_ > 0.0 &&
         std::abs(size - linear_size_) < 1e-12;
}

NewtonStep Run::attempt(const Stage& stage, double from, double to) {
  target_ = (1.0 - to) * force_start_ + to * force_end_;
  NewtonSettings newton{stage.method, stage.max_iterations, stage.tolerance, settings_.line_search};
  newton.repeat = can_repeat(stage, to - from);
  newton.contract = contracts(stage);
  return newton_step(assembly_, stiffness_, target_, rate_, to - from, newton, result_.work, du_);
}

// Modified Newton: the tangent at the end of a step serves the next one.  It must be taken with the step still
// in hand: at du = 0 a law on its yield surface answers elastically.
void Run::renew_tangent() {
  if (stiffness_.constant) return;
  assembly_.evaluate(du_, solver_.get());
  stiffness_.assembled = true;
  if (assembly_.matrix_changed()) stiffness_.factorised = false;
}

void Run::accept(double reached) {
  assembly_.commit(du_);
  u_ += du_;
  external_ = (1.0 - reached) * external_start_ + reached * force_end_;
  result_.motion = std::max(result_.motion, motion());
}

// Of the nodes that elements have.
void Run::measure_extent() {
  std::vector<char> used(static_cast<std::size_t>(model_.mesh.nodes()), 0);
  for (const Group& group : model_.groups)
    for (const int node : group.nodes) used[static_cast<std::size_t>(node)] = 1;
  for (int node = 0; node < model_.mesh.nodes(); ++node)
    if (used[static_cast<std::size_t>(node)]) nodes_.push_back(node);
  if (nodes_.empty()) return;
  Vector2 low = model_.mesh.x.col(nodes_.front()), high = low;
  for (const int node : nodes_) {
    low = low.cwiseMin(model_.mesh.x.col(node));
    high = high.cwiseMax(model_.mesh.x.col(node));
  }
  extent_ = high - low;
  size_ = extent_.maxCoeff();
}

// How much displacements along an axis differ, as a share of the model's extent along it: about the mean
// strain, and none for a translation.  Around an axis of symmetry the radial displacement itself strains.
double Run::motion() const {
  Vector2 low = Vector2::Zero(), high = Vector2::Zero();
  const bool axisymmetric = model_.geometry == Geometry::axisymmetric;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector2 u = u_.segment<2>(2 * nodes_[i]);
    if (i == 0) low = high = u;
    if (i == 0 && axisymmetric) low.x() = high.x() = 0.0;
    low = low.cwiseMin(u);
    high = high.cwiseMax(u);
  }
  double largest = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    if (extent_[axis] > 0.0) largest = std::max(largest, (high[axis] - low[axis]) / extent_[axis]);
  return largest;
}

// Back to the committed state, with its own internal forces.  The next attempt starts with the tangent of the
// way that the last step took.  At du = 0 points on their yield surfaces answer elastically: from there a cut
// step would have to find all of the plastic zone anew, however short it is.
// next: its share of the stage; 0 = from there all the same.
void Run::reject(const Stage& stage, double next) {
  linear_size_ = 0.0;
  on_last_way_ = false;
  const bool keep_K = stiffness_.constant || stage.method == Method::initial_stiffness;
  if (!keep_K) {
    stiffness_.assembled = stiffness_.factorised = false;
    if (next > 0.0) start_on_last_way(next);
  }
  du_.setZero();
  assembly_.evaluate(du_, nullptr);
}

// Linear scenes cut no step.
void Run::keep_way(double size) {
  if (stiffness_.constant) return;
  last_du_ = du_;
  last_size_ = size;
  committed_force_ = assembly_.internal_force();
}

// K half way along the last step once more, in its direction, for a step of this share of the stage.
void Run::start_on_last_way(double size) {
  if (!(last_size_ > 0.0)) return;
  du_ = (0.5 * size / last_size_) * last_du_;
  stiffness_.assembled = on_last_way_ = assembly_.evaluate(du_, solver_.get()) != Outcome::cut_step;
}

// Of the step in hand: where supports move, the growth of their forces along their own motion; else the growth
// of the loads over the motion along them.  Both fall to nothing at a limit load (Bergan's current stiffness).
void Run::measure_stiffness(double from, double to) {
  if (stiffness_.constant) return;
  const double size = to - from;
  double work = 0.0;
  if (!rate_.isZero(0.0)) {
    const Eigen::VectorXd& f = assembly_.internal_force();
    for (int dof = 0; dof < model_.dofs(); ++dof)
      if (rate_[dof] != 0.0) work += (f[dof] - committed_force_[dof]) * rate_[dof];
    last_stiffness_ = work / size;
  } else {
    work = (force_end_ - force_start_).dot(du_);
    last_stiffness_ = work > 0.0 ? size / work : 0.0;
  }
  stiffest_ = std::max(stiffest_, last_stiffness_);
}

// After a failed attempt: that of the last step, and under loads that of the attempt where it ran away.
// Before any step the attempt's first correction, which is elastic, stands for the stage.
double Run::stiffness_share(double from, double to, const NewtonStep& step) const {
  const double size = to - from;
  if (!rate_.isZero(0.0)) return stiffest_ > 0.0 && last_size_ > 0.0 ? last_stiffness_ / stiffest_ : -1.0;
  const double work = (force_end_ - force_start_).dot(du_);
  const double attempt = work > 0.0 && std::isfinite(work) ? size / work : 0.0;
  const double elastic = step.predicted_work > 0.0 ? size * size / step.predicted_work : 0.0;
  const double largest = std::max(stiffest_, elastic);
  if (!(largest > 0.0)) return -1.0;
  return std::min(attempt, last_size_ > 0.0 ? last_stiffness_ : attempt) / largest;
}

// A step that moves a node by a thousand times the model's size while hardly anything resists is flow at a
// limit load: an equilibrium far away that rounding and the mesh's own faults give (reduced integration, nu
// near 1/2). Returns its motion as a share of that size; 0 = the step may stand.
double Run::refused_motion(double from, double to, const NewtonStep& step) const {
  constexpr double kFar = 1e3;    // model's sizes
  constexpr double kSoft = 0.01;  // of the stage's largest stiffness, or prescribed motion over the largest
  if (step.outcome != StepOutcome::converged || stiffness_.constant) return 0.0;
  const double motion = du_.size() > 0 ? du_.lpNorm<Eigen::Infinity>() : 0.0;
  if (!(motion > kFar * size_) || !(size_ > 0.0)) return 0.0;
  const double prescribed = (to - from) * rate_.lpNorm<Eigen::Infinity>();
  const double share = prescribed > 0.0 ? prescribed / motion : stiffness_share(from, to, step);
  return share >= 0.0 && share < kSoft ? motion / size_ : 0.0;
}

bool Run::run_increment(const Stage& stage, StepReport& report, double& reached) {
  const double end = static_cast<double>(report.increment) / report.increments;
  const double whole = 1.0 / report.increments;
  double size = end - reached;
  report.substeps = 0;
  while (reached < end) {
    const double to = size >= end - reached - 1e-12 * whole ? end : reached + size;
    const NewtonStep step = attempt(stage, reached, to);
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
        reject(stage, 0.0);
        continue;
      }
      path_error_ = std::max(path_error_, error);
      if (stage.method == Method::modified_newton || contracts(stage)) renew_tangent();
      const bool linear = step.repeated || (step.iterations.size() == 1 && !assembly_.matrix_changed());
      linear_size_ = linear ? to - reached : 0.0;
      on_last_way_ = false;
      measure_stiffness(reached, to);
      accept(to);
      keep_way(to - reached);
      reached = to;
      report.load_factor = reached;
      ++report.substeps;
      if (step.iterations.size() <= 6 && 8.0 * error <= kPathTolerance) size *= 2.0;
      continue;
    }
    // Half way along a collapse mechanism the matrix may be singular where the committed state's is not.
    if (step.outcome == StepOutcome::singular && on_last_way_) {
      reject(stage, 0.0);
      continue;
    }
    report.points = assembly_.count_points();
    report.failed_at = to;  // beyond `reached`, which may have passed an earlier failure
    const bool shortest = to - reached < 1.001 * std::ldexp(whole, -settings_.max_cuts);
    if (shortest || stiffness_.constant) {
      report.stiffness_share = stiffness_share(reached, to, step);
      return fail(report, step);
    }
    ++report.cuts;
    size = 0.5 * (to - reached);
    reject(stage, size);
  }
  return true;
}

// Beyond it the results are those of small strains, which describe something else.
void Run::warn_about_motion(const Stage& stage) {
  if (!(result_.motion > kLargeMotion)) return;
  warn(stage, "displacements reach " + short_number(result_.motion) +
                  " times the model's size: results that suppose small strains (to about " +
                  short_number(kLargeMotion) + " times) do not describe this");
}

bool Run::fail(StepReport& report, const NewtonStep& step) {
  report.converged = false;
  report.motion = result_.motion;
  warn_about_motion(model_.stages[static_cast<std::size_t>(report.stage)]);
  if (step.outcome == StepOutcome::singular) {
    result_.status = RunStatus::singular;
    result_.reason = explain_singular(model_, activity_, assembly_, report, step);
  } else {
    result_.status = RunStatus::not_converged;
    result_.reason = explain_failure(model_, assembly_, report, step);
  }
  du_.setZero();
  assembly_.evaluate(du_, nullptr);
  assembly_.recover_states();
  tell([&](Observer& o) { o.on_failure(model_, report, result_.reason, solution()); });
  return false;
}

EquilibriumAudit Run::audit() const {
  EquilibriumAudit audit;
  const Eigen::VectorXd& f = assembly_.internal_force();
  double moment_scale = 0.0, scale[2] = {0, 0};
  for (int dof = 0; dof < model_.dofs(); ++dof) {
    if (!assembly_.in_use(dof)) continue;
    const int c = dof % 2;
    const double reaction = assembly_.equation_of(dof) < 0 ? f[dof] - external_[dof] : 0.0;
    const double force = external_[dof] + reaction;
    audit.applied[c] += external_[dof];
    audit.reactions[c] += reaction;
    const double arm = c == 0 ? -model_.mesh.x(1, dof / 2) : model_.mesh.x(0, dof / 2);
    audit.moment += force * arm;
    // A stage may end without any force: its start counts too.
    const double size = std::max(std::abs(external_[dof]) + std::abs(reaction), std::abs(force_start_[dof]));
    scale[c] += size;
    moment_scale += size * std::abs(arm);
  }
  audit.scale = std::max(scale[0], scale[1]);
  const bool plane = model_.geometry == Geometry::plane_strain;
  if (audit.scale > 0.0) {
    audit.out_of_balance = std::abs(audit.applied[1] + audit.reactions[1]) / audit.scale;
    if (plane)  // radial forces of a ring need no sum of zero
      audit.out_of_balance =
          std::max(audit.out_of_balance, std::abs(audit.applied[0] + audit.reactions[0]) / audit.scale);
  }
  if (plane && moment_scale > 0.0)
    audit.out_of_balance = std::max(audit.out_of_balance, std::abs(audit.moment) / moment_scale);
  return audit;
}

// Condensed ones too.
int Run::all_equations() const {
  return assembly_.equations() + (assembly_.condensation() ? assembly_.condensation()->condensed() : 0);
}

double Run::smallest_pivot() const {
  const double own = solver_->report().smallest_pivot_ratio;
  if (!assembly_.condensation()) return own;
  const double inner = assembly_.condensation()->report().smallest_pivot_ratio;
  return own < 0.0 || inner < 0.0 ? std::max(own, inner) : std::min(own, inner);
}

void Run::warn(const Stage& stage, const std::string& message, Severity severity) {
  const Diagnostic diagnostic{
      severity, stage.where, "stage " + std::to_string(stage.number) + ": " + message, {}};
  tell([&](Observer& o) { o.on_warning(diagnostic); });
}

// What a reader of the results should know before trusting them.
void Run::warn_about_numbers(int s, const EquilibriumAudit& sums) {
  constexpr double kPoorAudit = 1e-6;
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  warn_about_motion(stage);
  if (sums.out_of_balance > kPoorAudit)
    warn(stage, "loads and reactions of the whole model are out of balance by " +
                    short_number(sums.out_of_balance) + " of the largest force");
  if (stiffness_.factorised)
    if (const auto digits =
            report_digits(*solver_, assembly_.equations(), smallest_pivot(), settings_.condition);
        !digits.words.empty())
      warn(stage, digits.words, digits.poor ? Severity::warning : Severity::note);
  if (path_error_ > kPathTolerance)
    warn(stage,
         "the stiffness of a hyperbolic law changes so much that an increment in 64 parts is still too long; "
         "with more increments the results would change by more than 1 %");
  if (!loose_part_.empty()) warn(stage, loose_part_);
  const auto points = assembly_.count_points();
  const long apex = points[static_cast<std::size_t>(PointStatus::apex)];
  if (apex > 0)
    warn(stage,
         std::to_string(apex) +
             " point(s) at the apex or cut off in tension: results there depend on how the law treats tension");
  const UniquenessCount unique = count_loss_of_uniqueness(assembly_);
  if (unique.lost > 0)
    warn(stage, "loss of uniqueness: the determinant of the acoustic tensor is negative at " +
                    std::to_string(unique.lost) + " of " + std::to_string(unique.plastic) +
                    " yielding points (flow is not associated): the answer can depend on mesh and steps");
}

// Newton's matrix is singular then; a matrix that is kept from before finds an equilibrium all the same.
void Run::find_loose_part(const StepReport& report) {
  if (!loose_part_.empty() || report.points[static_cast<std::size_t>(PointStatus::open)] == 0) return;
  loose_part_ = explain_loose_part(model_, activity_, assembly_);
  if (!loose_part_.empty()) loose_part_ = "increment " + std::to_string(report.increment) + ": " + loose_part_;
}

// Writing: as the state stands after an increment (place.increment > 0), or between two stages.  Within a stage
// the states before the last step are kept beside that step, because the tangent that the next step starts with
// was taken there.
void Run::exchange(Archive& archive, const Place& place) {
  const bool within = place.increment > 0;
  archive(u_);
  archive(external_);
  archive(result_.stages_done);
  archive(result_.increments_done);
  archive(result_.motion);
  archive(result_.work);
  archive(stiffness_.factorised);
  if (within) {
    archive(du_);
    archive(linear_size_);
    archive(last_size_);
    archive(stiffest_);
    archive(last_stiffness_);
    archive(path_error_);
    archive(loose_part_);
    archive(external_start_);
    archive(force_start_);
    archive(force_end_);
  }
  assembly_.exchange(archive, within);
}

// Stress and strain of linear elements, if somebody will look at them.
void Run::recover_for(const StepReport& report) {
  if (std::any_of(observers_.begin(), observers_.end(),
                  [&](const Observer* o) { return o->wants_states(model_, report); }))
    assembly_.recover_states();
}

void Run::offer_checkpoint(Place place) {
  if (!settings_.checkpoint_due || !settings_.checkpoint_due()) return;
  const Timer timer(result_.work.output_seconds);
  Archive archive;
  archive(place);
  exchange(archive, place);
  for (Observer* observer : observers_) observer->exchange(archive);
  settings_.save_checkpoint(archive.bytes());
}

// To the state of a checkpoint.  The last step's end is evaluated once more: that gives its tangent too.  What
// the run still had in hand is made again (the analysed pattern of the stage before, factors), so that the
// counters and the pivots on the record go on as if nothing had happened.
Run::Place Run::resume() {
  Archive archive(settings_.resume_from);
  Place place;
  archive(place);
  const bool within = place.increment > 0;
  const int opened = within ? place.stage : place.stage - 1;  // the last stage that was opened
  if (opened < 0 || opened >= static_cast<int>(model_.stages.size()))
    throw InputError({}, "the checkpoint does not belong to this model");
  for (int s = 0; s < opened; ++s) {
    activity_.enter(model_.stages[static_cast<std::size_t>(s)]);
    place_groups(model_.stages[static_cast<std::size_t>(s)]);
  }
  open_stage(opened);
  exchange(archive, place);
  const WorkCounters work = result_.work;
  const bool factorised = stiffness_.factorised && (within || stiffness_.constant);
  stiffness_.factorised = false;
  if (within || factorised) {
    if (assembly_.evaluate(du_, solver_.get()) == Outcome::cut_step)
      throw InputError({}, "the checkpoint does not belong to this model");
    stiffness_.assembled = true;
    if (within) assembly_.commit_again();
    last_du_ = du_;
    committed_force_ = assembly_.internal_force();
  }
  if (factorised) {
    solver_->factorise();
    stiffness_.factorised = true;
  }
  tell([&](Observer& o) { o.on_start(model_, scene_, solver_name_, all_equations()); });
  for (Observer* observer : observers_) observer->exchange(archive);
  if (!archive.at_end()) throw InputError({}, "the checkpoint is longer than it should be");
  result_.work = work;
  return place;
}

bool Run::run_stage(int s, int done) {
  const Stage& stage = model_.stages[static_cast<std::size_t>(s)];
  if (done == 0) {
    prepare_stage(s);
    path_error_ = 0.0;
    loose_part_.clear();
    if (s == 0) tell([&](Observer& o) { o.on_start(model_, scene_, solver_name_, all_equations()); });
    StepReport start;
    start.stage = s;
    start.increments = stage.increments;
    recover_for(start);
    tell([&](Observer& o) { o.on_stage_start(model_, s, solution()); });
  }
  const bool whole_stages_only = stage.method == Method::initial_stiffness && !stiffness_.constant;
  double last_force = 0.0;  // out of balance at the end of the last increment, relative
  double reached = static_cast<double>(done) / stage.increments;
  for (int i = done + 1; i <= stage.increments; ++i) {
    StepReport report;
    report.stage = s;
    report.increment = i;
    report.increments = stage.increments;
    report.load_factor = reached;
    if (!run_increment(stage, report, reached)) return false;
    if (!report.iterations.empty()) last_force = report.iterations.back().force;
    report.points = assembly_.count_points();
    find_loose_part(report);
    report.motion = result_.motion;
    report.smallest_pivot_ratio = smallest_pivot();
    ++result_.increments_done;
    recover_for(report);
    tell([&](Observer& o) { o.on_increment(model_, report, solution()); });
    if (i == stage.increments) break;
    if (!whole_stages_only) offer_checkpoint({s, i});
    stop_if_asked(settings_.stop_asked);
  }
  ++result_.stages_done;
  const EquilibriumAudit sums = audit();
  warn_about_numbers(s, sums);
  if (last_force > stage.tolerance)
    warn(stage,
         "equilibrium to " + short_number(last_force) + " of the forces only, the tolerance is " +
             short_number(stage.tolerance) +
             ": no correction improves it further, what is left is rounding (very stiff beside very soft "
             "parts, or nu close to 1/2)");
  tell([&](Observer& o) { o.on_stage_end(model_, s, sums, solution()); });
  if (s + 1 == static_cast<int>(model_.stages.size())) return true;
  offer_checkpoint({s + 1, 0});
  stop_if_asked(settings_.stop_asked);
  return true;
}

void Run::run_stages() {
  Place place;
  if (settings_.resume_from.empty())
    start_states(model_.initials);
  else
    place = resume();
  for (int s = place.stage; s < static_cast<int>(model_.stages.size()); ++s)
    if (!run_stage(s, s == place.stage ? place.increment : 0)) break;
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
  }
  tell([&](Observer& o) { o.on_finish(model_, result_); });
  return result_;
}

}  // namespace

RunResult run(const Model& model, const Catalogue& catalogue, const RunSettings& settings,
              std::span<Observer* const> observers) {
  return Run(model, catalogue, settings, observers).execute();
}

}  // namespace sage
