#include "sage/analysis/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

// Square of the time step.  With the elastic stiffness as mass the highest frequency is 1, and a step of 2 the longest
// that is stable.
constexpr double kTimeStepSquared = 0.5;
constexpr double kLeastShare = kTimeStepSquared / 64.0;
constexpr int kMostPasses = 10000;
constexpr int kWindow = 64;  // passes
constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

bool Relaxation::suits(const Model& model) {
  return std::ranges::all_of(model.unknowns, [](const UnknownField& field) {
    return field.displacement() || field.turns || field.balanced;
  });
}

// Paths of flow that is not associated depend on the length of steps: a step whose elastic answer leaves more than this
// unbalanced is halved.
double Relaxation::start(double from, double to) {
  constexpr double kMostUnbalanced = 0.005;
  constexpr int kHalvings = 10;
  start_u_ = run_.state.u;
  velocity_.setZero(run_.assembly().equations());
  share_ = kTimeStepSquared;
  windows_.clear();
  at_strength_.clear();
  least_ = kNever;
  passes_ = 0;
  lost_ = !hold_elastic();
  for (int halving = 0; !lost_; ++halving) {
    const bool answered = try_step(from, to);
    if (answered && (force_ <= kMostUnbalanced || halving == kHalvings)) break;
    lost_ = !answered && halving == kHalvings;
    to = 0.5 * (from + to);
  }
  if (!lost_) {
    run_.assembly().commit(run_.state.du);
    run_.state.u += run_.state.du;
  }
  return to_ = to;
}

// K_e at the committed state, and its factors.
bool Relaxation::hold_elastic() {
  run_.state.du.setZero();
  run_.tangent().forget();
  if (evaluate_elastic(run_.assembly(), run_.tangent()) == Outcome::cut_step) return false;
  try {
    run_.tangent().factorise(run_.result.work);
  } catch (const SingularMatrix&) {
    return false;
  }
  return true;
}

// The elastic answer to the loads and prescribed displacements of the step.
bool Relaxation::try_step(double from, double to) {
  RunState& state = run_.state;
  Assembly& assembly = run_.assembly();
  state.target = run_.loads_at(to);
  run_.set_step_time(to, to - from);
  state.du.setZero(assembly.dof_map().dofs());
  if (assembly.evaluate(state.du, nullptr) == Outcome::cut_step) return false;
  form_residual();
  const Eigen::VectorXd& coupling = run_.tangent().coupling();
  for (int eq = 0; eq < assembly.equations(); ++eq)
    residual_[eq] -= (to - from) * assembly.numbering().force(coupling, eq);
  acceleration_.resize(residual_.size());
  run_.tangent().solve(residual_, acceleration_, run_.result.work);
  state.du = (to - from) * run_.system.rate();
  for (int eq = 0; eq < assembly.equations(); ++eq) assembly.numbering().move(state.du, eq, acceleration_[eq]);
  ++passes_;
  if (assembly.evaluate(state.du, nullptr) == Outcome::cut_step) return false;
  form_residual();
  return true;
}

Relaxation::End Relaxation::settle(double goal) {
  if (lost_ || !is_ready()) return End::lost;
  velocity_.setZero();
  while (force_ > goal) {
    if (passes_ >= kMostPasses) return End::restless;
    accelerate();
    if (!advance()) return End::lost;
    watch();
    if (passes_ % kWindow == 0 && flows()) return End::flow;
  }
  return End::rest;
}

// With K_e and the residual of the committed state in hand, which the caller may have replaced by others.
bool Relaxation::is_ready() {
  if (run_.tangent().factorised()) return true;
  if (!hold_elastic()) return false;
  run_.set_step_time(to_, 0.0);
  if (run_.assembly().evaluate(run_.state.du, nullptr) == Outcome::cut_step) return false;
  form_residual();
  return true;
}

// Kinetic damping: masses that begin to move against the residual are stopped (Cundall 1982).
void Relaxation::accelerate() {
  run_.tangent().solve(residual_, acceleration_, run_.result.work);
  if (velocity_.dot(residual_) < 0.0) velocity_.setZero();
  velocity_ += share_ * acceleration_;
}

bool Relaxation::advance() {
  constexpr int kTrials = 6;  // a law may have no answer so far away
  RunState& state = run_.state;
  Assembly& assembly = run_.assembly();
  run_.set_step_time(to_, 0.0);
  for (int trial = 0;; ++trial) {
    state.du.setZero();
    for (int eq = 0; eq < assembly.equations(); ++eq) assembly.numbering().set(state.du, eq, velocity_[eq]);
    ++passes_;
    if (assembly.evaluate(state.du, nullptr) == Outcome::ok) break;
    if (trial == kTrials) return false;
    velocity_ *= 0.5;
  }
  assembly.commit(state.du);
  state.u += state.du;
  form_residual();
  note_strength();
  return std::isfinite(force_);
}

void Relaxation::note_strength() {
  const std::vector<GroupData>& groups = run_.assembly().groups();
  at_strength_.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<PointStatus>& status = groups[g].state.committed.status;
    if (!groups[g].active || groups[g].constant) continue;
    at_strength_[g].resize(status.size());
    for (std::size_t p = 0; p < status.size(); ++p)
      if (status[p] != PointStatus::elastic && status[p] != PointStatus::unloading)
        at_strength_[g][p] = {status[p], passes_};
  }
}

void Relaxation::show_strength() const {
  std::vector<GroupData>& groups = run_.assembly().groups();
  for (std::size_t g = 0; g < at_strength_.size(); ++g)
    for (std::size_t p = 0; p < at_strength_[g].size(); ++p) {
      PointStatus& status = groups[g].state.committed.status[p];
      const AtStrength& last = at_strength_[g][p];
      if (status == PointStatus::elastic && last.pass >= passes_ - passes_ / 4) status = last.status;
    }
}

void Relaxation::form_residual() {
  const Assembly& assembly = run_.assembly();
  const Eigen::VectorXd& f = assembly.internal_force();
  const int displacements = assembly.dof_map().displacements();
  residual_.resize(assembly.equations());
  double sum = 0.0, loads = 0.0;
  for (int eq = 0; eq < assembly.equations(); ++eq) {
    const double load = assembly.numbering().force(run_.state.target, eq);
    residual_[eq] = load - assembly.numbering().force(f, eq);
    if (assembly.dof_of(eq) >= displacements) continue;
    sum += residual_[eq] * residual_[eq];
    loads += load * load;
  }
  const double scale = std::max(assembly.force_scale(0), std::sqrt(loads));
  force_ = scale > 0.0 ? std::sqrt(sum) / scale : 0.0;
}

double Relaxation::largest_motion() const {
  double largest = 0.0;
  for (std::size_t dof = 0; dof < of_solids_.size(); ++dof) {
    const auto at = static_cast<Eigen::Index>(dof);
    if (of_solids_[dof] == 0) continue;
    const double moved = std::abs(run_.state.u[at] - start_u_[at]);
    if (!(moved <= largest)) largest = moved;  // not a number counts
  }
  return largest;
}

// On the way to rest the residual falls by powers of ten, and the motion slows down.  That of a mechanism keeps its residual
// and gets faster; a load that is hardly too large takes long to move it far.
bool Relaxation::flows() const {
  constexpr double kFar = 0.1, kNear = 1e-3;  // of the model's size
  constexpr double kStays = 0.5;
  constexpr std::size_t kFew = 24, kMany = 94;  // windows
  const double moved = windows_.back().moved, size = run_.extent.size();
  const std::size_t count = windows_.size(), third = count / 3;
  if (!(moved <= size)) return true;
  if (count < kFew || moved < kNear * size) return false;
  double last = kNever, before = kNever;
  for (std::size_t i = count - third; i < count; ++i) {
    last = std::min(last, windows_[i].least);
    before = std::min(before, windows_[i - third].least);
  }
  if (last <= kStays * before) return false;
  const double start = windows_[count - 2 * third - 1].moved, middle = windows_[count - third - 1].moved;
  return moved > kFar * size || (count >= kMany && moved - middle > middle - start);
}

// A tangent above the elastic stiffness makes the motion unstable: the residual grows from window to window.
void Relaxation::watch() {
  constexpr double kGrows = 4.0;
  least_ = std::min(least_, force_);
  if (passes_ % kWindow != 0) return;
  if (!windows_.empty() && least_ > kGrows * windows_.back().least)
    share_ = std::max(0.5 * share_, kLeastShare);
  windows_.push_back({least_, largest_motion()});
  least_ = kNever;
}

}  // namespace sage
