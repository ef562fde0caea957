#include "sage/analysis/newton.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "sage/analysis/acceleration.hpp"
#include "sage/analysis/by_field.hpp"
#include "sage/analysis/contraction.hpp"
#include "sage/analysis/creep.hpp"
#include "sage/analysis/dogleg.hpp"
#include "sage/analysis/repeats.hpp"

namespace sage {

namespace {

// Shared by the parts of one step; vectors of equations are sized once.
class Step {
 public:
  Step(Assembly& assembly, Tangent& tangent, const Eigen::VectorXd& target, double rate_part,
       const NewtonSettings& settings, WorkCounters& work, Eigen::VectorXd& du)
      : assembly_(assembly),
        pass_(assembly, target, rate_part, settings.so_far),
        rate_part_(rate_part),
        tangent_(tangent),
        target_(target),
        settings_(settings),
        work_(work),
        du_(du),
        fields_(assembly),
        residual_(assembly.equations()) {}

  NewtonStep solve(const Eigen::VectorXd& rate);

 private:
  bool full_newton() const {
    return (settings_.method == Method::newton || settings_.method == Method::dogleg) && !tangent_.constant();
  }
  bool new_K_each_iteration() const { return full_newton() && !settings_.contract; }
  bool accelerated() const { return !full_newton() && !tangent_.linear(); }
  bool repeats();
  void accelerate(double old_norm);
  NewtonStep& iterate_with_line_search();
  NewtonStep& polished();
  NewtonStep& iterate_with_dogleg();
  NewtonStep& iterate_damped();
  bool evaluate_or_halve();
  double damping_growth(const Eigen::VectorXd& old_residual, double old_norm) const;
  bool record_iteration();
  IterationRecord measure_whole();
  Outcome evaluate(bool with_K);
  void form_residual();
  void correct();
  bool predict(const Eigen::VectorXd& rate);
  void take_prescribed(const Eigen::VectorXd& rate);
  bool wants_line_search(double old_norm) const;
  bool search_line();
  bool chatters(double old_norm) const;
  bool halve_step(double old_norm);
  IterationRecord measure(int field) const;
  IterationRecord measure();
  bool converged(const IterationRecord& record) const;
  bool converged(int field, const IterationRecord& record) const;
  NewtonStep& finished();
  bool linear_rounding(const IterationRecord& record) const;
  bool falls_no_more() const;
  bool at_rounding(int field, const IterationRecord& record) const;
  double couplings(int field) const;
  double stiffness_norm(int field) const;
  double own_forces(const Eigen::VectorXd& correction, int field) const;
  Eigen::VectorXd free_part_of_du() const;
  bool start_from_committed();
  bool start_from_du(const Eigen::VectorXd& rate);
  void take_first_scales(const Eigen::VectorXd& way, const Eigen::VectorXd& force);
  bool even(int field) const;
  double size_of_unknown(int field) const;
  double scale(int field) const;
  double residual_size() const;
  double work_left() const;
  bool hopeless() const;
  bool flows();
  bool strays() const;
  bool ends_next() const;
  bool outgrown(int field, const IterationRecord& record) const;
  double load_size(int field) const;
  void take_start_scales();
  void take_energy(const Eigen::VectorXd& correction);
  void find_worst();
  void move(double factor);

  Assembly& assembly_;
  IteratedStep pass_;
  double rate_part_;  // of the stage's prescribed displacements
  Tangent& tangent_;
  const Eigen::VectorXd& target_;
  const NewtonSettings& settings_;
  WorkCounters& work_;
  Eigen::VectorXd& du_;
  const ByField fields_;
  Eigen::VectorXd residual_, correction_, start_residual_;
  Acceleration acceleration_;
  bool start_known_ = false;  // start_residual_ is the residual at du = 0
  // Of each field of unknowns:
  FieldSums prescribed_{};   // largest unknown that supports are given in this step
  FieldSums load_scale_{};   // |loads| of all free dofs
  FieldSums first_force_{};  // largest of the step's start, its loads, and what its first correction balances
  FieldSums energy_scale_{}, start_scale_{};
  std::array<IterationRecord, kMostFields> measured_{};
  bool K_is_here_ = false;  // the last pass made it
  double slope_ = 0.0, step_length_ = 1.0;
  double best_ = std::numeric_limits<double>::infinity();  // smallest residual_size() so far
  double damping_ = 1.0;                                   // share of the elastic stiffness
  NewtonStep result_;
};

Outcome Step::evaluate(bool with_K) {
  K_is_here_ = with_K;
  return pass_.iterate(du_, with_K ? &tangent_ : nullptr);
}

void Step::form_residual() {
  const Eigen::VectorXd& f = assembly_.internal_force();
  for (int eq = 0; eq < assembly_.equations(); ++eq) {
    const int dof = assembly_.dof_of(eq);
    residual_[eq] = target_[dof] - f[dof];
  }
}

// The run is largest while it factorises: room for the correction comes behind it.
void Step::correct() {
  if (settings_.damping_fall > 0.0) tangent_.damp(damping_);
  tangent_.factorise(work_);
  correction_.resize(assembly_.equations());
  tangent_.solve(residual_, correction_, work_);
  if (settings_.damping_fall > 0.0) tangent_.forget();
}

void Step::move(double factor) {
  for (int eq = 0; eq < assembly_.equations(); ++eq) du_[assembly_.dof_of(eq)] += factor * correction_[eq];
}

// An increment after one that was linear to the last digit: the same step again, if it leaves next to nothing
// out of balance.  It costs one force pass.
bool Step::repeats() {
  if (!tangent_.current()) return false;
  take_start_scales();
  form_residual();
  start_residual_ = residual_;
  start_known_ = true;
  if (const Condensation* region = assembly_.condensation())
    for (const int dof : region->condensed_dofs()) du_[dof] = 0.0;  // complete() says what they move by
  if (evaluate(false) == Outcome::cut_step) return false;
  form_residual();
  correction_.setZero(assembly_.equations());
  IterationRecord record = measure();
  if (!(record.force <= settings_.repeat)) return false;
  if (!pass_.wait(du_, residual_.norm(), settings_.repeat)) record = measure_whole();
  if (!(record.force <= settings_.repeat)) return false;
  result_.iterations.push_back(record);
  find_worst();
  result_.outcome = StepOutcome::converged;
  result_.repeated = true;
  ++work_.repeats;
  return true;
}

// First correction, from the place where the iterations begin.
bool Step::predict(const Eigen::VectorXd& rate) {
  const bool committed = settings_.start == NewtonStart::committed;
  if (!(committed ? start_from_committed() : start_from_du(rate))) return false;
  correct();
  if (settings_.start == NewtonStart::last_way && tangent_.norm1() >= 0.0) {  // the solver keeps K
    const Eigen::VectorXd way = free_part_of_du();
    take_first_scales(way, tangent_.times(way));
  } else {
    take_first_scales(correction_, residual_);
  }
  if (committed) du_ = rate_part_ * rate;
  for (int f = 0; f < fields_.count(); ++f)
    at(prescribed_, f) = std::abs(rate_part_) * fields_.largest_of_dofs(rate, f);
  move(1.0);
  return true;
}

// Prescribed displacements enter through K(free, prescribed).
bool Step::start_from_committed() {
  du_.setZero();
  if (!tangent_.current() && evaluate(true) == Outcome::cut_step) return false;
  if (start_known_) {
    residual_ = start_residual_;
  } else {
    take_start_scales();  // a step may end without any stress
    form_residual();
  }
  const Eigen::VectorXd& coupling = tangent_.coupling();
  for (int eq = 0; eq < assembly_.equations(); ++eq)
    residual_[eq] -= rate_part_ * coupling[assembly_.dof_of(eq)];
  return true;
}

// du is a place nearby, or the way of the step before: forces at the committed state are those before a pass at du.
bool Step::start_from_du(const Eigen::VectorXd& rate) {
  if (settings_.start == NewtonStart::last_way && !start_known_) take_start_scales();
  take_prescribed(rate);
  if (evaluate(true) == Outcome::cut_step) return false;
  if (settings_.start == NewtonStart::nearby) take_start_scales();
  form_residual();
  return true;
}

// Of the whole step: what its first correction moves by, and the forces that this balances.
void Step::take_first_scales(const Eigen::VectorXd& way, const Eigen::VectorXd& force) {
  double work = 0.0;
  for (int f = 0; f < fields_.count(); ++f) work += at(energy_scale_, f) = std::abs(fields_.dot(way, force, f));
  if (const Condensation* region = assembly_.condensation()) {
    energy_scale_[0] += std::abs(region->held_work());
    work = energy_scale_[0];
  }
  result_.predicted_work = work;
  for (int f = 0; f < fields_.count(); ++f)
    at(first_force_, f) =
        std::max({fields_.norm(force, f), at(start_scale_, f), at(load_scale_, f), own_forces(way, f)});
}

// Of du: all that has no equation.
void Step::take_prescribed(const Eigen::VectorXd& rate) {
  const Eigen::VectorXd free = free_part_of_du();
  du_ = rate_part_ * rate;
  for (int eq = 0; eq < assembly_.equations(); ++eq) du_[assembly_.dof_of(eq)] = free[eq];
}

// By equation.
Eigen::VectorXd Step::free_part_of_du() const {
  Eigen::VectorXd free(assembly_.equations());
  for (int eq = 0; eq < assembly_.equations(); ++eq) free[eq] = du_[assembly_.dof_of(eq)];
  return free;
}

// What the first correction of a field makes in its own equations, where another field balances it.
double Step::own_forces(const Eigen::VectorXd& correction, int field) const {
  if (fields_.count() == 1 || tangent_.norm1() < 0.0) return 0.0;
  return fields_.norm(tangent_.times(fields_.part(correction, field)), field);
}

void Step::take_start_scales() {
  for (int f = 0; f < fields_.count(); ++f) at(start_scale_, f) = assembly_.force_scale(f);
}

void Step::take_energy(const Eigen::VectorXd& correction) {
  for (int f = 0; f < fields_.count(); ++f)
    at(energy_scale_, f) = std::max(at(energy_scale_, f), std::abs(fields_.dot(correction, residual_, f)));
}

double Step::load_size(int field) const {
  double sum = 0.0;
  const ByField::Piece own = fields_.equations_of(field);
  for (int eq = own.begin; eq < own.end; ++eq) sum += std::pow(target_[assembly_.dof_of(eq)], 2);
  if (const Condensation* region = assembly_.condensation(); region != nullptr && field == 0)
    for (int dof : region->condensed_dofs()) sum += std::pow(target_[dof], 2);
  return std::sqrt(sum);
}

double Step::scale(int field) const {
  return std::max({assembly_.force_scale(field), at(load_scale_, field), at(start_scale_, field)});
}

// Fields have no common unit: each counts by what the step had to balance in it.
double Step::residual_size() const {
  if (fields_.count() == 1) return residual_.norm();
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    if (at(first_force_, f) > 0.0) sum += std::pow(fields_.norm(residual_, f) / at(first_force_, f), 2);
  return std::sqrt(sum);
}

// Of the work that is left along the correction; of each field by the largest of its corrections so far.
double Step::work_left() const {
  if (fields_.count() == 1) return correction_.dot(residual_);
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    if (at(energy_scale_, f) > 0.0) sum += fields_.dot(correction_, residual_, f) / at(energy_scale_, f);
  return sum;
}

// With a condensed region: of the whole model, as without one.
IterationRecord Step::measure_whole() {
  if (assembly_.condensation() == nullptr) return measure();
  pass_.complete(du_);
  form_residual();
  IterationRecord record = measure();
  const double size = assembly_.condensation()->step_norm(du_);
  // The displacement counts where the energy does not decide.
  if (record.energy > settings_.tolerance * settings_.tolerance && size > 0.0)
    record.displacement = pass_.whole_norm(correction_) / size;
  return record;
}

IterationRecord Step::measure(int field) const {
  IterationRecord record;
  const double force_scale = scale(field), size = fields_.norm_of_dofs(du_, field);
  const double force = fields_.norm(residual_, field);
  const double energy = std::abs(fields_.dot(correction_, residual_, field)), whole = at(energy_scale_, field);
  record.force = force_scale > 0.0 ? force / force_scale : 0.0;
  record.displacement = size > 0.0 ? fields_.norm(correction_, field) / size : 0.0;
  record.energy = whole > 0.0 ? energy / whole : 0.0;
  record.step_length = step_length_;
  return record;
}

// Of the field that is farthest from its end.
IterationRecord Step::measure() {
  for (int f = 0; f < fields_.count(); ++f) measured_[static_cast<std::size_t>(f)] = measure(f);
  IterationRecord record = measured_[0];
  const auto take = [](double& worst, double value) {
    if (!(value <= worst)) worst = value;  // not a number counts as worst
  };
  for (int f = 1; f < fields_.count(); ++f) {
    const IterationRecord& other = measured_[static_cast<std::size_t>(f)];
    take(record.force, other.force);
    take(record.displacement, other.displacement);
    take(record.energy, other.energy);
  }
  return record;
}

// With a constant tangent the second correction removes all but rounding: what does not fall any more is that
// of the internal forces themselves, near nu = 1/2 K/G times that of the displacements.  The run warns of it.
bool Step::linear_rounding(const IterationRecord& record) const {
  const std::size_t done = result_.iterations.size();
  return tangent_.linear() && done >= 3 && record.force > 0.5 * result_.iterations[done - 2].force &&
         record.force <= std::sqrt(settings_.tolerance);
}

// Residuals of several fields at rounding go up and down: that of the field farthest from its end has come no
// further in eight corrections.
bool Step::falls_no_more() const {
  constexpr std::size_t kLook = 8;
  const auto& all = result_.iterations;
  if (all.size() < kLook + 2) return false;
  const auto least_force = [](auto first, auto last) {
    return std::ranges::min_element(first, last, {}, &IterationRecord::force)->force;
  };
  const auto recent = all.end() - kLook;
  return least_force(recent, all.end()) > 0.5 * least_force(all.begin(), recent);
}

// Equilibrium and energy to the tolerance; the last correction to its root, unless the energy is smaller still
// (a linear step ends with its first correction, which is then the whole increment).
// Forces of very stiff joints are k times differences of displacements and can't be balanced better than those
// are rounded: a full correction that no longer changes the displacements ends the step too.
bool Step::converged(int field, const IterationRecord& record) const {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double tol = settings_.tolerance;
  if (outgrown(field, record)) return false;
  if (record.displacement <= kRounding && record.step_length >= 1.0 && record.force <= std::sqrt(tol))
    return true;
  if (!(record.force <= tol)) return at_rounding(field, record) || linear_rounding(record);
  return record.energy <= tol * tol || record.force <= 1e-3 * tol ||
         (record.energy <= tol && record.displacement <= std::sqrt(tol));
}

// Every field for itself, as measured last.  record: of all of them.
bool Step::converged(const IterationRecord& record) const {
  constexpr double kFirst = 1e-6;  // of the unknowns: no refinement
  if (settings_.refine && record.displacement > kFirst) return false;
  if (fields_.count() == 1) return converged(0, record);
  if (linear_rounding(record) && falls_no_more()) return true;
  for (int f = 0; f < fields_.count(); ++f)
    if (!converged(f, measured_[static_cast<std::size_t>(f)]) && !even(f)) return false;
  return true;
}

// A further field with nothing to balance but the rounding of its unknowns: a concentration that is the same
// everywhere, of whatever size, makes fluxes of no digit.
//
// So do the fields together: a beam that is bent by moments alone has forces that are the rounding of its rotations,
// and one that is moved as a whole has moments that are the rounding of its displacements.
//
// Where all displacements are prescribed, moments that are the rounding of the elements' forces times lengths count as
// none.
bool Step::even(int field) const {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon(), kNothing = 1e3;
  const double largest = fields_.largest(residual_, field);
  if (field != 0 && largest <= kRounding * stiffness_norm(field) * size_of_unknown(field)) return true;
  if (settings_.unknowns != nullptr && (*settings_.unknowns)[static_cast<std::size_t>(field)].turns) {
    const double moments = kRounding * assembly_.force_scale(0) * settings_.size;
    if (largest <= moments && scale(field) <= kNothing * moments) return true;
  }
  if (tangent_.norm1() < 0.0) return false;
  double together = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    together += kRounding * tangent_.coupling_of(fields_, field, f) * size_of_unknown(f);
  return largest <= together && scale(field) <= kNothing * together;
}

double Step::size_of_unknown(int field) const {
  const double before =
      settings_.committed != nullptr ? fields_.largest_of_dofs(*settings_.committed, field) : 0.0;
  return before + fields_.largest_of_dofs(du_, field);
}

// Forces are K times displacements: what the rounding of those makes can't be balanced (stiff joints,
// nu near 1/2). A residual of that size ends the step once corrections are tiny, if it is small beside
// the forces; or if all forces are no more than the rounding of a motion that is prescribed (a loose
// part, moved without stress).
bool Step::at_rounding(int field, const IterationRecord& record) const {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon(), kTiny = 1e-6;
  if (!(record.displacement <= kTiny) || record.step_length < 1.0 || residual_.size() == 0) return false;
  const double unit = kRounding * stiffness_norm(field);  // negative where the solver has no norm
  const double largest = fields_.largest(residual_, field);
  if (record.force <= std::sqrt(settings_.tolerance)) {
    if (largest <= unit * fields_.largest_of_dofs(du_, field)) return true;
    return fields_.count() > 1 && unit >= 0.0 && falls_no_more() && largest <= kRounding * couplings(field);
  }
  const double prescribed = at(prescribed_, field);
  return largest <= unit * prescribed && scale(field) <= 1e3 * unit * prescribed;
}

// Moments of beams are K times displacements too: the sum over all fields.  It is a bound from above, so that it
// ends a step only where corrections help no more.
double Step::couplings(int field) const {
  double sum = 0.0;
  for (int f = 0; f < fields_.count(); ++f)
    sum += tangent_.coupling_of(fields_, field, f) * fields_.largest_of_dofs(du_, f);
  return sum;
}

// Of the field's own block of K; of one among several from below, which is the careful side.
double Step::stiffness_norm(int field) const {
  const double norm1 = tangent_.norm1();
  if (fields_.count() == 1 || norm1 < 0.0) return norm1;
  return tangent_.coupling_of(fields_, field, field);
}

// Beyond 1/eps of the step's own forces no digit of those is left in a residual: the iteration has run away,
// and what comes behind is noise, however small it may be beside the stress that it has made itself.
bool Step::hopeless() const {
  for (int f = 0; f < fields_.count(); ++f) {
    const double size = fields_.norm(residual_, f), first = at(first_force_, f);
    if (!std::isfinite(size) || (first > 0.0 && size * std::numeric_limits<double>::epsilon() > first))
      return true;
  }
  return false;
}

// Corrections leave more out of balance than there was, and a good part of all stress: no equilibrium is near.  The
// second rule is for steps that begin with as much.
bool Step::flows() {
  constexpr double kMuch = 0.4, kTimes = 3.0;
  constexpr std::size_t kPatience = 12;
  const std::vector<IterationRecord>& done = result_.iterations;
  if (!settings_.stop_at_flow || done.empty()) return false;
  const double first = done.front().force, last = done.back().force;
  result_.flows = last > kMuch && (last > kTimes * first || (done.size() >= kPatience && last >= first));
  return result_.flows;
}

// Quadratic convergence leaves less than the tolerance then: a K at that place would serve nobody, as the next step
// starts with its own, and the factors at hand are still those of the K that the solver holds.
bool Step::ends_next() const {
  return settings_.start == NewtonStart::last_way && !result_.iterations.empty() &&
         result_.iterations.back().force <= std::sqrt(settings_.tolerance);
}

// The way of the step before is a guess: one that does not come ten times nearer in five corrections is given up.
bool Step::strays() const {
  constexpr std::size_t kPatience = 5;
  constexpr double kNearer = 0.1;
  const std::vector<IterationRecord>& done = result_.iterations;
  if (settings_.start != NewtonStart::last_way || done.size() % kPatience != 0) return false;
  return !(done.back().force <= kNearer * done[done.size() - kPatience].force);
}

// Stress that balances itself is made by the motion and grows with it (mean stress near nu = 1/2): beside that
// of an iteration that runs away any load is small.  What is left out of balance must be small beside what the
// step has to balance, too.
bool Step::outgrown(int field, const IterationRecord& record) const {
  constexpr double kShare = 0.01;
  const double first = at(first_force_, field);
  const double largest = std::max(kShare, 10.0 * settings_.tolerance) * first;
  return first > 0.0 && record.force * scale(field) > largest;
}

void Step::find_worst() {
  int worst = -1;
  double largest = -1.0;
  for (int f = 0; f < fields_.count(); ++f) {
    const int eq = fields_.place_of_largest(residual_, f);
    if (eq < 0) continue;
    const double scale_here = fields_.count() > 1 ? scale(f) : 1.0;
    const double share = scale_here > 0.0 ? std::abs(residual_[eq]) / scale_here : 0.0;
    if (share <= largest) continue;
    largest = share;
    worst = eq;
  }
  if (worst < 0) return;
  const DofMap::Unknown unknown = assembly_.dof_map().at(assembly_.dof_of(worst));
  result_.worst = {unknown.node, unknown.field, unknown.component, residual_[worst]};
}

constexpr double kLoose = 1e-6;  // tolerance above which a kept tangent alone ends no step
constexpr double kLeastDamping = 1e-13;
constexpr double kAccept = 0.8;  // of the slope at the start

// Crisfield's criterion on the slope correction . residual: the full step is kept while it is below 0.8 of the
// start.  Without symmetry that slope is no energy and may start near zero: a full step that halves what is out of
// balance is kept then, too.
bool Step::wants_line_search(double old_norm) const {
  constexpr double kHalf = 0.5;
  if (std::abs(work_left()) <= kAccept * std::abs(slope_)) return false;
  return assembly_.symmetric() || !(residual_size() < kHalf * old_norm);
}

// The zero of the slope is sought by regula falsi within (0, 1).
bool Step::search_line() {
  constexpr int kTrials = 4;
  double a = 0.0, slope_a = slope_, length = 1.0, slope = work_left();
  double b = 1.0, slope_b = slope;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (std::abs(slope) <= kAccept * std::abs(slope_)) break;
    const bool between = slope_a * slope_b < 0.0;
    const double zero = between ? a - slope_a * (b - a) / (slope_b - slope_a) : 0.5 * (a + b);
    const double next = std::clamp(zero, a + 0.1 * (b - a), b - 0.1 * (b - a));
    move(next - length);
    length = next;
    if (evaluate(new_K_each_iteration()) == Outcome::cut_step) return false;
    form_residual();
    slope = work_left();
    const bool beyond = between && slope_a * slope > 0.0;  // the zero lies between here and b
    (beyond ? a : b) = next;
    (beyond ? slope_a : slope_b) = slope;
  }
  step_length_ = length;
  return true;
}

// Joints that touch without pressure may be found open by one tangent and closed by the next, for good: late iterations
// whose correction throws away what earlier ones have won.
constexpr int kLate = 10;

bool Step::chatters(double old_norm) const {
  constexpr double kThrown = 5.0;
  if (!settings_.line_search || accelerated() || assembly_.symmetric()) return false;
  return residual_size() > kThrown * old_norm &&
         std::ranges::any_of(assembly_.groups(), [](const GroupData& data) { return data.group->interface(); });
}

bool Step::halve_step(double old_norm) {
  constexpr int kTrials = 4;
  for (int trial = 0; trial < kTrials && residual_size() > old_norm; ++trial) {
    move(-0.5 * step_length_);
    step_length_ *= 0.5;
    if (evaluate(new_K_each_iteration()) == Outcome::cut_step) return false;
    form_residual();
  }
  return true;
}

// True once converged.
bool Step::record_iteration() {
  // The scale of a condensed region's forces is that of an earlier step, or of what was before the stage.
  const double rough = pass_.begins_stage() ? 10.0 : 2.5;
  IterationRecord record = measure();
  const bool balanced = converged(record);
  const bool near = pass_.must_fill_in() && record.force <= rough * settings_.tolerance;
  if ((balanced || near) && !(balanced && pass_.wait(du_, residual_.norm(), settings_.tolerance)))
    record = measure_whole();
  result_.iterations.push_back(record);
  if (settings_.pulse != nullptr)
    settings_.pulse->iterated(static_cast<int>(result_.iterations.size()), record.force);
  const double size = residual_size();
  const bool done = converged(record);
  if (done || size <= best_) find_worst();
  best_ = std::min(best_, size);
  if (!done) return false;
  result_.force_left = fields_.count() == 1 ? record.force : 0.0;
  for (int f = 0; fields_.count() > 1 && f < fields_.count(); ++f)
    if (!even(f))
      result_.force_left = std::max(result_.force_left, measured_[static_cast<std::size_t>(f)].force);
  result_.outcome = StepOutcome::converged;
  return true;
}

NewtonStep Step::solve(const Eigen::VectorXd& rate) {
  for (int f = 0; f < fields_.count(); ++f) at(load_scale_, f) = load_size(f);
  result_.outcome = StepOutcome::law_cut;
  result_.iterations.reserve(static_cast<std::size_t>(settings_.max_iterations));
  if (settings_.repeat > 0.0 && repeats()) return result_;
  if (!predict(rate)) return result_;
  if (settings_.damping_fall > 0.0) return iterate_damped();
  return settings_.method == Method::dogleg ? iterate_with_dogleg() : iterate_with_line_search();
}

// The tangent is not that of the place reached: earlier corrections help.  A step that made
// things worse starts anew.
void Step::accelerate(double old_norm) {
  if (residual_size() > 2.0 * old_norm) acceleration_.restart();
  acceleration_.improve(correction_);
}

// With a tangent that is kept, corrections are small because they are many: a small residual may leave most of the
// change to come.  The tangent of the place reached tells how much, and Newton's method takes the rest.
NewtonStep& Step::finished() {
  constexpr int kMost = 10;
  constexpr double kRest = 3e-3;  // of the increment
  result_.finished = true;
  result_.outcome = StepOutcome::not_converged;
  for (int i = 0; i < kMost; ++i) {
    if (evaluate(true) == Outcome::cut_step) break;
    const double old_norm = residual_size();
    correct();
    take_energy(correction_);
    slope_ = work_left();
    step_length_ = 1.0;
    move(1.0);
    if (evaluate(false) == Outcome::cut_step) break;
    form_residual();
    if (settings_.line_search && wants_line_search(old_norm) && !search_line()) break;
    if (hopeless()) break;
    if (record_iteration() && result_.iterations.back().displacement * step_length_ <= kRest) return result_;
    result_.outcome = StepOutcome::not_converged;
  }
  return result_;
}

NewtonStep& Step::iterate_with_line_search() {
  double old_norm = residual_size();
  if (accelerated()) acceleration_.improve(correction_);
  for (int i = 1; i <= settings_.max_iterations; ++i) {
    if (evaluate(new_K_each_iteration() && !ends_next()) == Outcome::cut_step) return result_;
    form_residual();
    step_length_ = 1.0;
    if (settings_.line_search && !accelerated() && i > 1 && wants_line_search(old_norm) && !search_line())
      return result_;
    if (i > kLate && chatters(old_norm) && !halve_step(old_norm)) return result_;
    if (hopeless()) {
      result_.flows = settings_.stop_at_flow;
      return result_;
    }
    if (record_iteration()) return accelerated() && settings_.tolerance > kLoose ? finished() : polished();
    if (flows() || strays() || i == settings_.max_iterations) break;
    const double norm = residual_size();
    const bool wants_K = settings_.contract ? contracts_poorly(norm, old_norm) : full_newton() && !K_is_here_;
    if (wants_K && evaluate(true) == Outcome::cut_step) return result_;
    correct();
    if (accelerated()) accelerate(old_norm);
    old_norm = norm;
    take_energy(correction_);
    slope_ = work_left();
    move(1.0);
  }
  result_.outcome = StepOutcome::not_converged;
  return result_;
}

// From the way of the last step some iterations end just within the tolerance, where those from the committed state
// jump far below it.  One more correction makes them as good: where factors are at hand for a solution and a force pass.
NewtonStep& Step::polished() {
  const double far = (tangent_.factorised() ? 1e-3 : 1e-2) * settings_.tolerance;
  if (settings_.start != NewtonStart::last_way || result_.iterations.back().force <= far) return result_;
  const double old_norm = residual_size();
  correct();
  for (const double way : {1.0, -1.0}) {  // back again, if it helps nothing
    move(way);
    if (evaluate(false) == Outcome::cut_step) continue;
    form_residual();
    if (residual_size() <= old_norm) break;
  }
  record_iteration();
  return result_;
}

// A rejected step leaves K and its factors as they were: only the residual is computed anew.
NewtonStep& Step::iterate_with_dogleg() {
  Dogleg dogleg;
  if (evaluate(full_newton()) == Outcome::cut_step) return result_;
  form_residual();
  Eigen::VectorXd newton(residual_.size()), old_residual(residual_.size());
  for (int i = 1; i <= settings_.max_iterations; ++i) {
    if (hopeless() || record_iteration()) return result_;
    correct();
    newton = correction_;
    take_energy(newton);
    old_residual = residual_;
    dogleg.choose(tangent_.solver(), residual_, newton, correction_);
    step_length_ = dogleg.step_length();
    move(1.0);
    const bool computed = evaluate(false) == Outcome::ok;
    if (computed) form_residual();
    const double new_norm = computed ? residual_.norm() : std::numeric_limits<double>::infinity();
    if (!dogleg.accept(old_residual.norm(), new_norm)) {
      move(-1.0);
      residual_ = old_residual;
      continue;
    }
    if (full_newton() && evaluate(true) == Outcome::cut_step) return result_;
  }
  result_.outcome = StepOutcome::not_converged;
  return result_;
}

// The elastic stiffness is above every tangent: corrections held back by all of it lead towards equilibrium where Newton's
// own jump to and fro between states of joints, or find a matrix without stiffness in a direction.  Its share falls as
// long as corrections go on in one direction, so that they end as Newton's; what nothing holds runs away with it.  It
// grows where the residual grows by half, or turns while a correction goes too far.
NewtonStep& Step::iterate_damped() {
  Creep creep(*settings_.of_solids, settings_.size);
  creep.take(du_, residual_size());
  slope_ = work_left();
  for (int i = 1; i <= settings_.max_iterations; ++i) {
    const double old_norm = residual_size();
    const Eigen::VectorXd old_residual = residual_;
    if (!evaluate_or_halve()) return result_;
    form_residual();
    if (i > 1) damping_ *= damping_growth(old_residual, old_norm);
    damping_ = std::clamp(damping_, kLeastDamping, 1.0);
    creep.take(du_, residual_size());
    result_.flows = hopeless() || creep.flows();
    if (!result_.flows && record_iteration()) return result_;
    if (result_.flows || creep.is_shaken() || i == settings_.max_iterations) break;
    correct();
    take_energy(correction_);
    slope_ = work_left();
    move(1.0);
  }
  result_.spares_ground = creep.spares_ground();
  result_.outcome = StepOutcome::not_converged;
  return result_;
}

double Step::damping_growth(const Eigen::VectorXd& old_residual, double old_norm) const {
  constexpr double kGrows = 1.5, kJump = 4.0, kBeyond = 0.5, kStays = 0.95, kTurned = 0.9;
  const double norm = residual_size(), ratio = old_norm > 0.0 ? norm / old_norm : 1.0;
  const bool turned = residual_.dot(old_residual) < kTurned * residual_.norm() * old_residual.norm();
  const bool beyond = work_left() < -kBeyond * slope_;
  if (beyond && turned && ratio > kStays) return kJump;
  return ratio > kGrows ? std::min(ratio, kJump) : std::min(ratio, settings_.damping_fall);
}

// A law may have no answer so far away.
bool Step::evaluate_or_halve() {
  constexpr int kTrials = 6;
  step_length_ = 1.0;
  for (int trial = 0; evaluate(true) == Outcome::cut_step; ++trial) {
    if (trial == kTrials) return false;
    move(-0.5 * step_length_);
    step_length_ *= 0.5;
  }
  return true;
}

}  // namespace

NewtonStep newton_step(Assembly& assembly, Tangent& tangent, const Eigen::VectorXd& target,
                       const Eigen::VectorXd& rate, double rate_part, const NewtonSettings& settings,
                       WorkCounters& work, Eigen::VectorXd& du) {
  try {
    Step step(assembly, tangent, target, rate_part, settings, work, du);
    return step.solve(rate);
  } catch (const SingularMatrix& error) {
    NewtonStep result;
    result.outcome = StepOutcome::singular;
    result.singular_equation = error.equation();
    result.message = error.what();
    return result;
  }
}

}  // namespace sage
