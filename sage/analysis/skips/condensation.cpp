#include "sage/analysis/skips/condensation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sage/math/rounding.hpp"

namespace sage {

Condensation::Condensation(RegionMatrix matrix) : matrix_(std::move(matrix)) {
  const auto n = static_cast<Eigen::Index>(matrix_.kept().size()), inside = Eigen::Index{matrix_.condensed()};
  for (Eigen::VectorXd* x : {&g_, &base_, &kept_du_, &kept_f_}) x->setZero(n);
  predictor_.begin(n);
  for (Eigen::VectorXd* x : {&stage_load_, &loads_}) x->setZero(inside);
  for (Eigen::VectorXd* x : {&stage_, &step_, &from_, &whole_}) x->setZero(inside + n);
  stage_forces_.setZero(matrix_.dofs());
}

void Condensation::begin_stage(const Eigen::VectorXd& loads, const Eigen::VectorXd& prescribed,
                               double force_squares) {
  stage_forces_.setZero();
  if (!prescribed.isZero(0.0)) matrix_.multiply(prescribed, stage_forces_);
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i)
    stage_load_[i] = loads[matrix_.dof_of(i)] - stage_forces_[matrix_.dof_of(i)];
  stage_work_ = eliminate_loads(stage_load_, stage_);
  predictor_.begin_stage(matrix_.is_moved_by(prescribed), force_squares);
}

// Returns their work while the border is held.
double Condensation::eliminate_loads(const Eigen::VectorXd& loads, Eigen::VectorXd& eliminated) {
  matrix_.inner(eliminated) = loads;
  matrix_.border(eliminated).setZero();
  matrix_.eliminate(eliminated);
  matrix_.inner(whole_) = matrix_.inner(eliminated);
  matrix_.border(whole_).setZero();
  matrix_.recover(whole_);
  return loads.dot(matrix_.inner(whole_));
}

void Condensation::begin_step(double part, const StageSoFar& so_far, const Eigen::VectorXd& target,
                              const Eigen::VectorXd& f0, double tolerance) {
  predictor_.begin_step(part, so_far);
  target_ = &target;
  from_is_here_ = false;
  if (!predictor_.is_behind()) look_at_loads(f0, tolerance);
  const double part_since = predictor_.part_since();
  if (predictor_.on_line()) {
    matrix_.border(step_) = part_since * matrix_.border(stage_);
    held_work_ = part * part * stage_work_;
  } else {
    held_work_ = eliminate_loads(loads_, step_);
  }
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = matrix_.kept()[i];
    g_[i] = f0[dof] + part_since * stage_forces_[dof] - step_[matrix_.condensed() + i];
  }
  base_.setZero();
}

// Whether those of the step are its part of the stage's.
void Condensation::look_at_loads(const Eigen::VectorXd& f0, double tolerance) {
  const double part_since = predictor_.part_since();
  double off = 0.0;
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i) {
    const int dof = matrix_.dof_of(i);
    loads_[i] = (*target_)[dof] - f0[dof] - part_since * stage_forces_[dof];
    off = std::max(off, std::abs(loads_[i] - part_since * stage_load_[i]));
  }
  predictor_.set_on_line(off <= tolerance);
}

void Condensation::add_start_forces(Eigen::VectorXd& f) const {
  kept_du_ = predictor_.since();
  add_border_forces(f);
}

void Condensation::add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& f) const {
  find_kept_motion(du);
  add_border_forces(f);
}

void Condensation::find_kept_motion(const Eigen::VectorXd& du) const {
  const Eigen::VectorXd& since = predictor_.since();
  for (Eigen::Index i = 0; i < base_.size(); ++i) kept_du_[i] = du[matrix_.kept()[i]] + since[i] - base_[i];
}

void Condensation::add_border_forces(Eigen::VectorXd& f) const {
  kept_f_.noalias() = matrix_.S() * kept_du_;
  for (Eigen::Index i = 0; i < g_.size(); ++i) f[matrix_.kept()[i]] += g_[i] + kept_f_[i];
}

// Interface dofs that move by u leave rounding of |K| |u|: the solution is the motion from a state near by.
void Condensation::complete(Eigen::VectorXd& du) {
  if (!from_is_here_) {
    from_is_here_ = true;
    from_has_loads_ = predictor_.extrapolate(matrix_.condensed_dofs(), matrix_.kept(), from_);
    if (!from_has_loads_ && predictor_.on_line())
      matrix_.inner(step_) = predictor_.part_since() * matrix_.inner(stage_);
  }
  if (from_has_loads_)
    matrix_.inner(whole_).setZero();
  else
    matrix_.inner(whole_) = matrix_.inner(step_);
  for (Eigen::Index i = matrix_.condensed(); i < whole_.size(); ++i)
    whole_[i] = du[matrix_.dof_of(i)] + predictor_.since()[i - matrix_.condensed()] - from_[i];
  matrix_.recover(whole_);
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i) du[matrix_.dof_of(i)] = from_[i] + whole_[i];
}

double Condensation::step_norm(const Eigen::VectorXd& du) const {
  double inner = 0.0;
  for (const int dof : matrix_.condensed_dofs()) inner += du[dof] * du[dof];
  const double part = predictor_.is_behind() ? predictor_.part() / predictor_.part_since() : 1.0;
  return std::sqrt(std::max(0.0, du.squaredNorm() - (1.0 - part * part) * inner));
}

double Condensation::rounding(const Eigen::VectorXd& du) const {
  constexpr double kRounding = rounding::kFewProducts;
  find_kept_motion(du);
  return kRounding * matrix_.S_norm() * kept_du_.lpNorm<Eigen::Infinity>();
}

void Condensation::add_motion(Eigen::VectorXd& du) const {
  const Eigen::VectorXd& since = predictor_.since();
  for (Eigen::Index i = 0; i < since.size(); ++i) du[matrix_.kept()[i]] += since[i];
}

// Of the condensed ones from the border: the stage's loads L there move by part K_ll^-1 L - K_ll^-1 K_ln du_n.
double Condensation::load_work(const Eigen::VectorXd& loads, const Eigen::VectorXd& du) const {
  if (!predictor_.on_line() || predictor_.supports_move()) return loads.dot(du);
  double work = predictor_.part() * stage_work_;
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = matrix_.kept()[i];
    work += (loads[dof] + stage_[matrix_.condensed() + i]) * du[dof];
  }
  return work;
}

double Condensation::largest_residual(const Eigen::VectorXd& f) const {
  double largest = 0.0;
  for (const int dof : matrix_.condensed_dofs())
    largest = std::max(largest, std::abs((*target_)[dof] - f[dof]));
  return largest;
}

void Condensation::refine(const Eigen::VectorXd& f, Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i)
    whole_[i] = (*target_)[matrix_.dof_of(i)] - f[matrix_.dof_of(i)];
  matrix_.border(whole_).setZero();
  matrix_.eliminate(whole_);
  matrix_.border(whole_).setZero();
  matrix_.recover(whole_);
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i) du[matrix_.dof_of(i)] += whole_[i];
}

void Condensation::set_base(const Eigen::VectorXd& all, const Eigen::VectorXd& others,
                            const Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = matrix_.kept()[i];
    g_[i] = all[dof] - others[dof];
    base_[i] = du[dof] + predictor_.since()[i];
  }
  from_is_here_ = from_has_loads_ = true;
  for (Eigen::Index i = 0; i < matrix_.condensed(); ++i) from_[i] = du[matrix_.dof_of(i)];
  matrix_.border(from_) = base_;
}

double Condensation::whole_norm(const Eigen::VectorXd& correction) {
  matrix_.inner(whole_).setZero();
  matrix_.border(whole_) = correction;
  matrix_.recover(whole_);
  return whole_.norm();
}

namespace {

// Dofs of elements that are not constant.
std::vector<char> changing_dofs(const std::vector<GroupData>& groups, int dofs) {
  std::vector<char> flags(static_cast<std::size_t>(dofs), 0);
  for (const GroupData& data : groups) {
    if (!data.active || data.constant) continue;
    for (int e = 0; e < data.group->elements(); ++e) {
      const ElementDofs own = data.dofs_of(e);
      for (std::size_t i = 0; i < own.size(); ++i) flags[own[i]] = 1;
    }
  }
  return flags;
}

// Elimination of a plane mesh takes up to about 200 multiplications times N^1.5 (quadratic elements, unsymmetric): a
// border that costs more can't pay, and need not be analysed.
bool too_wide(int kept, int condensed) {
  return std::pow(kept, 3.0) / 3.0 > 200.0 * std::pow(condensed, 1.5);
}

}  // namespace

std::unique_ptr<Condensation> condense_if_it_pays(const std::vector<GroupData>& groups,
                                                  const std::vector<int>& free_dofs, int dofs, int increments,
                                                  bool symmetric, const SolverMaker& make) {
  constexpr int kFewestCondensed = 100;
  // Of an ill-conditioned region, and of terms that grow: elimination without refinement would cost digits.
  constexpr double kPoorPivot = 1e-6, kLargeGrowth = 1e3;
  const std::vector<char> keep = changing_dofs(groups, dofs);
  const auto kept = static_cast<int>(
      std::count_if(free_dofs.begin(), free_dofs.end(), [&](int dof) { return keep[dof] != 0; }));
  const int condensed = static_cast<int>(free_dofs.size()) - kept;
  if (kept == 0 || condensed < kFewestCondensed || too_wide(kept, condensed)) return nullptr;
  try {
    RegionMatrix matrix(groups, free_dofs, keep, make);
    if (!matrix.analyse_if_it_pays(increments, symmetric)) return nullptr;
    matrix.factorise();
    const FactorReport report = matrix.report();
    if (report.smallest_pivot_ratio < kPoorPivot || report.growth > kLargeGrowth) return nullptr;
    return std::make_unique<Condensation>(std::move(matrix));
  } catch (const SingularMatrix&) {
    return nullptr;  // a region that is held by its interface dofs alone: the whole system reports the fault, or solves it
  }
}

}  // namespace sage
