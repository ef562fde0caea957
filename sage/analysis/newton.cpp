#include "sage/analysis/newton.hpp"

#include <cmath>
#include <limits>

#include "sage/analysis/acceleration.hpp"
#include "sage/analysis/contraction.hpp"
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
        pass_(assembly, target, rate_part),
        rate_part_(rate_part),
        tangent_(tangent),
        target_(target),
        settings_(settings),
        work_(work),
        du_(du),
        residual_(assembly.equations()),
        correction_(assembly.equations()) {}

  NewtonStep solve(const Eigen::VectorXd& rate);

 private:
  bool full_newton() const {
    return (settings_.method == Method::newton || settings_.method == Method::dogleg) && !tangent_.constant();
  }
  bool new_K_each_iteration() const { return full_newton() && !settings_.contract; }
  bool accelerated() const { return !full_newton() && !tangent_.constant(); }
  bool repeats();
  void accelerate(double old_norm);
  NewtonStep& iterate_with_line_search();
  NewtonStep& iterate_with_dogleg();
  bool record_iteration();
  IterationRecord measure_whole();
  Outcome evaluate(bool with_K);
  void form_residual();
  void correct();
  bool predict(const Eigen::VectorXd& rate);
  bool search_line();
  IterationRecord measure() const;
  bool converged(const IterationRecord& record) const;
  bool linear_rounding(const IterationRecord& record) const;
  bool at_rounding(const IterationRecord& record) const;
  double scale() const;
  bool hopeless() const;
  bool outgrown(const IterationRecord& record) const;
  double load_size() const;
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
  Eigen::VectorXd residual_, correction_, start_residual_;
  Acceleration acceleration_;
  bool start_known_ = false;  // start_residual_ is the residual at du = 0
  double prescribed_ = 0.0;   // largest displacement that supports are given in this step
  double load_scale_ = 0.0;   // |loads| of all free dofs
  double first_force_ = 0.0;  // largest of the step's start, its loads, and what its first correction balances
  double energy_scale_ = 0.0, start_scale_ = 0.0, slope_ = 0.0, step_length_ = 1.0;
  double best_ = std::numeric_limits<double>::infinity();  // smallest |residual| so far
  NewtonStep result_;
};

Outcome Step::evaluate(bool with_K) {
  return pass_.iterate(du_, with_K ? &tangent_ : nullptr);
}

void Step::form_residual() {
  const Eigen::VectorXd& f = assembly_.internal_force();
  for (int eq = 0; eq < assembly_.equations(); ++eq) {
    const int dof = assembly_.dof_of(eq);
    residual_[eq] = target_[dof] - f[dof];
  }
}

void Step::correct() {
  tangent_.factorise(work_);
  tangent_.solve(residual_, correction_, work_);
}

void Step::move(double factor) {
  for (int eq = 0; eq < assembly_.equations(); ++eq) du_[assembly_.dof_of(eq)] += factor * correction_[eq];
}

// An increment after one that was linear to the last digit: the same step again, if it leaves next to nothing
// out of balance.  It costs one force pass.
bool Step::repeats() {
  if (!tangent_.current()) return false;
  start_scale_ = assembly_.force_scale();
  form_residual();
  start_residual_ = residual_;
  start_known_ = true;
  if (evaluate(false) == Outcome::cut_step) return false;
  form_residual();
  correction_.setZero();
  const double limit = Repeats::limit(settings_.tolerance);
  if (!(measure().force <= limit)) return false;
  const IterationRecord record = measure_whole();
  if (!(record.force <= limit)) return false;
  result_.iterations.push_back(record);
  find_worst();
  result_.outcome = StepOutcome::converged;
  result_.repeated = true;
  ++work_.repeats;
  return true;
}

// First correction: prescribed displacements enter through K(free, prescribed).
bool Step::predict(const Eigen::VectorXd& rate) {
  du_.setZero();
  if (!tangent_.current() && evaluate(true) == Outcome::cut_step) return false;
  if (start_known_) {
    residual_ = start_residual_;
  } else {
    start_scale_ = assembly_.force_scale();  // a step may end without any stress
    form_residual();
  }
  const Eigen::VectorXd& coupling = tangent_.coupling();
  for (int eq = 0; eq < assembly_.equations(); ++eq)
    residual_[eq] -= rate_part_ * coupling[assembly_.dof_of(eq)];
  correct();
  energy_scale_ = std::abs(correction_.dot(residual_));
  if (const Condensation* region = assembly_.condensation()) energy_scale_ += std::abs(region->held_work());
  result_.predicted_work = energy_scale_;
  first_force_ = std::max({residual_.norm(), start_scale_, load_scale_});
  du_ = rate_part_ * rate;
  prescribed_ = du_.size() > 0 ? du_.lpNorm<Eigen::Infinity>() : 0.0;
  move(1.0);
  return true;
}

double Step::load_size() const {
  double sum = 0.0;
  for (int eq = 0; eq < assembly_.equations(); ++eq) sum += std::pow(target_[assembly_.dof_of(eq)], 2);
  if (const Condensation* region = assembly_.condensation())
    for (int dof : region->condensed_dofs()) sum += std::pow(target_[dof], 2);
  return std::sqrt(sum);
}

double Step::scale() const {
  return std::max({assembly_.force_scale(), load_scale_, start_scale_});
}

// With a condensed region: of the whole model, as without one.
IterationRecord Step::measure_whole() {
  if (assembly_.condensation() == nullptr) return measure();
  pass_.complete(du_);
  form_residual();
  IterationRecord record = measure();
  const double size = du_.norm();
  // The displacement counts where the energy does not decide.
  if (record.energy > settings_.tolerance * settings_.tolerance && size > 0.0)
    record.displacement = pass_.whole_norm(correction_) / size;
  return record;
}

IterationRecord Step::measure() const {
  IterationRecord record;
  const double force_scale = scale(), size = du_.norm();
  const double force = residual_.norm(), energy = std::abs(correction_.dot(residual_));
  record.force = force_scale > 0.0 ? force / force_scale : 0.0;
  record.displacement = size > 0.0 ? correction_.norm() / size : 0.0;
  record.energy = energy_scale_ > 0.0 ? energy / energy_scale_ : 0.0;
  record.step_length = step_length_;
  return record;
}

// With a constant tangent the second correction removes all but rounding: what does not fall any more is that
// of the internal forces themselves, near nu = 1/2 K/G times that of the displacements.  The run warns of it.
bool Step::linear_rounding(const IterationRecord& record) const {
  const std::size_t done = result_.iterations.size();
  return tangent_.constant() && done >= 3 && record.force > 0.5 * result_.iterations[done - 2].force &&
         record.force <= std::sqrt(settings_.tolerance);
}

// Equilibrium and energy to the tolerance; the last correction to its root, unless the energy is smaller still
// (a linear step ends with its first correction, which is then the whole increment).
// Forces of very stiff joints are k times differences of displacements and can't be balanced better than those
// are rounded: a full correction that no longer changes the displacements ends the step too.
bool Step::converged(const IterationRecord& record) const {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double tol = settings_.tolerance;
  if (outgrown(record)) return false;
  if (record.displacement <= kRounding && record.step_length >= 1.0 && record.force <= std::sqrt(tol))
    return true;
  if (!(record.force <= tol)) return at_rounding(record) || linear_rounding(record);
  return record.energy <= tol * tol || record.force <= 1e-3 * tol ||
         (record.energy <= tol && record.displacement <= std::sqrt(tol));
}

// Forces are K times displacements: what the rounding of those makes can't be balanced (stiff joints,
// nu near 1/2). A residual of that size ends the step once corrections are tiny, if it is small beside
// the forces; or if all forces are no more than the rounding of a motion that is prescribed (a loose
// part, moved without stress).
bool Step::at_rounding(const IterationRecord& record) const {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon(), kTiny = 1e-6;
  if (!(record.displacement <= kTiny) || record.step_length < 1.0 || residual_.size() == 0) return false;
  const double unit = kRounding * tangent_.solver().norm1();  // negative where the solver has no norm
  const double largest = residual_.lpNorm<Eigen::Infinity>();
  if (record.force <= std::sqrt(settings_.tolerance)) return largest <= unit * du_.lpNorm<Eigen::Infinity>();
  return largest <= unit * prescribed_ && scale() <= 1e3 * unit * prescribed_;
}

// Beyond 1/eps of the step's own forces no digit of those is left in a residual: the iteration has run away,
// and what comes behind is noise, however small it may be beside the stress that it has made itself.
bool Step::hopeless() const {
  const double size = residual_.norm();
  return !std::isfinite(size) ||
         (first_force_ > 0.0 && size * std::numeric_limits<double>::epsilon() > first_force_);
}

// Stress that balances itself is made by the motion and grows with it (mean stress near nu = 1/2): beside that
// of an iteration that runs away any load is small.  What is left out of balance must be small beside what the
// step has to balance, too.
bool Step::outgrown(const IterationRecord& record) const {
  constexpr double kShare = 0.01;
  const double largest = std::max(kShare, 10.0 * settings_.tolerance) * first_force_;
  return first_force_ > 0.0 && record.force * scale() > largest;
}

void Step::find_worst() {
  if (residual_.size() == 0) return;
  Eigen::Index worst = 0;
  residual_.cwiseAbs().maxCoeff(&worst);
  const int dof = assembly_.dof_of(static_cast<int>(worst));
  result_.worst = {dof / 2, dof % 2, residual_[worst]};
}

// Crisfield's criterion on the slope correction . residual: the full step is kept while it is below 0.8 of the
// start, otherwise the zero of the slope is sought by regula falsi within (0, 1).
bool Step::search_line() {
  constexpr double kAccept = 0.8;
  constexpr int kTrials = 4;
  double a = 0.0, slope_a = slope_, length = 1.0, slope = correction_.dot(residual_);
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
    slope = correction_.dot(residual_);
    const bool beyond = between && slope_a * slope > 0.0;  // the zero lies between here and b
    (beyond ? a : b) = next;
    (beyond ? slope_a : slope_b) = slope;
  }
  step_length_ = length;
  return true;
}

// True once converged.
bool Step::record_iteration() {
  constexpr double kNear = 10.0;  // iterations of a condensed region know the scale of its forces roughly
  IterationRecord record = measure();
  if (record.force <= kNear * settings_.tolerance || converged(record)) record = measure_whole();
  result_.iterations.push_back(record);
  const double size = residual_.norm();
  const bool done = converged(record);
  if (done || size <= best_) find_worst();
  best_ = std::min(best_, size);
  if (!done) return false;
  result_.outcome = StepOutcome::converged;
  return true;
}

NewtonStep Step::solve(const Eigen::VectorXd& rate) {
  load_scale_ = load_size();
  result_.outcome = StepOutcome::law_cut;
  result_.iterations.reserve(static_cast<std::size_t>(settings_.max_iterations));
  if (settings_.repeat && repeats()) return result_;
  if (!predict(rate)) return result_;
  return settings_.method == Method::dogleg ? iterate_with_dogleg() : iterate_with_line_search();
}

// The tangent is not that of the place reached: earlier corrections help.  A step that made
// things worse starts anew.
void Step::accelerate(double old_norm) {
  if (residual_.norm() > 2.0 * old_norm) acceleration_.restart();
  acceleration_.improve(correction_);
}

NewtonStep& Step::iterate_with_line_search() {
  double old_norm = residual_.norm();
  if (accelerated()) acceleration_.improve(correction_);
  for (int i = 1; i <= settings_.max_iterations; ++i) {
    if (evaluate(new_K_each_iteration()) == Outcome::cut_step) return result_;
    form_residual();
    step_length_ = 1.0;
    if (settings_.line_search && !accelerated() && i > 1 &&
        std::abs(correction_.dot(residual_)) > 0.8 * std::abs(slope_) && !search_line())
      return result_;
    if (hopeless() || record_iteration()) return result_;
    if (i == settings_.max_iterations) break;
    const double norm = residual_.norm();
    if (settings_.contract && contracts_poorly(norm, old_norm) && evaluate(true) == Outcome::cut_step)
      return result_;
    correct();
    if (accelerated()) accelerate(old_norm);
    old_norm = norm;
    slope_ = correction_.dot(residual_);
    energy_scale_ = std::max(energy_scale_, std::abs(slope_));
    move(1.0);
  }
  result_.outcome = StepOutcome::not_converged;
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
    energy_scale_ = std::max(energy_scale_, std::abs(newton.dot(residual_)));
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
