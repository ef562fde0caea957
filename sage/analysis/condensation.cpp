#include "sage/analysis/condensation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/analysis/checked_solve.hpp"

namespace sage {

namespace {

bool symmetric(const LawRef& law) {
  return std::visit([](const auto* l) { return l->traits().symmetric; }, law);
}

}  // namespace

Condensation::Condensation(const std::vector<GroupData>& groups, const std::vector<int>& dofs,
                           const std::vector<char>& keep, const SolverMaker& make)
    : groups_(&groups), dofs_(static_cast<int>(keep.size())) {
  for (int dof : dofs) (keep[static_cast<std::size_t>(dof)] ? kept_ : condensed_).push_back(dof);
  bool all_symmetric = true;
  for (const GroupData& data : groups)
    if (data.active && data.constant) all_symmetric = all_symmetric && symmetric(data.law);
  solver_ = make(condensed(), all_symmetric);
  border_solver_ = dynamic_cast<BorderSolver*>(solver_.get());
  if (border_solver_ != nullptr && !border_solver_->set_border(static_cast<int>(kept_.size())))
    border_solver_ = nullptr;
}

bool Condensation::analyse_if_it_pays(int increments, bool symmetric) {
  if (border_solver_ == nullptr && !solutions_pay(increments)) return false;
  analyse();
  return border_solver_ == nullptr || border_pays(increments, symmetric);
}

void Condensation::analyse() {
  const int equations = condensed() + (border_solver_ != nullptr ? static_cast<int>(kept_.size()) : 0);
  std::vector<int> equation(static_cast<std::size_t>(dofs_), -1);
  for (int i = 0; i < equations; ++i) equation[static_cast<std::size_t>(dof_of(i))] = i;
  ElementEquations elements;
  for (const GroupData& data : *groups_)
    if (data.active && data.constant) append_equations(data, equation, elements);
  solver_->analyse(equations, std::move(elements));
}

// Measured: S costs a solution for each of its dofs, an iteration saves about eight.
bool Condensation::solutions_pay(int increments) const {
  constexpr std::size_t kWidestBorder = 400;
  constexpr int kBorderPerIncrement = 15;
  if (kept_.size() > kWidestBorder) return false;
  const int border = static_cast<int>(kept_.size());
  return condensed() >= 4 * border && border <= kBorderPerIncrement * increments;
}

bool Condensation::border_pays(int increments, bool symmetric) const {
  const double border = static_cast<double>(kept_.size());
  // The whole matrix is factorised once an increment at least (large systems keep factors within a step), with twice
  // the work of the region where it is unsymmetric; the border's once in each of two iterations.
  const double region = solver_->report().factor_operations;
  const double whole = (symmetric == solver_->traits().symmetric ? 1.0 : 2.0) * region;
  const double dense = border * border * border / (symmetric ? 3.0 : 1.5);
  return region + increments * 2.0 * dense < increments * whole;
}

int Condensation::repeated_equations() const {
  const auto* repeated = dynamic_cast<const RepeatedParts*>(solver_.get());
  return repeated != nullptr ? repeated->repeated_equations() : 0;
}

void Condensation::factorise() {
  solver_->clear();
  int element = 0;
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    for (int e = 0; e < data.group->elements(); ++e) solver_->add(element++, data.matrix_of(e));
  }
  solver_->factorise();

  const auto n = static_cast<Eigen::Index>(kept_.size()), all = static_cast<Eigen::Index>(dofs_);
  for (Eigen::VectorXd* x : {&g_, &base_, &kept_du_, &kept_f_}) x->setZero(n);
  predictor_.begin(n);
  for (Eigen::VectorXd* x : {&stage_load_, &loads_, &solution_}) x->setZero(condensed());
  for (Eigen::VectorXd* x : {&stage_, &step_, &from_, &whole_}) x->setZero(condensed() + n);
  for (Eigen::VectorXd* x : {&stage_forces_, &all_dofs_, &all_forces_}) x->setZero(all);
  S_.resize(n, n);
  if (border_solver_ != nullptr)
    border_solver_->border_matrix(S_.data());
  else
    solve_for_border();
  S_norm_ = S_.cwiseAbs().rowwise().sum().maxCoeff();
  list_inner_nodes();
}

void Condensation::list_inner_nodes() {
  std::vector<char> kept(static_cast<std::size_t>(dofs_), 0);
  for (const int dof : kept_) kept[static_cast<std::size_t>(dof)] = 1;
  inner_nodes_.assign(static_cast<std::size_t>(dofs_) / 2, 0);
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    for (const int node : data.group->nodes) {
      const auto first = static_cast<std::size_t>(DofMap::displacement(node));
      if (!kept[first] || !kept[first + 1]) inner_nodes_[static_cast<std::size_t>(node)] = 1;
    }
  }
}

bool Condensation::reaches_region(const Eigen::VectorXd& motion) const {
  return std::ranges::any_of(*groups_, [&](const GroupData& data) {
    return data.active && data.constant && std::ranges::any_of(data.group->nodes, [&](int node) {
             const int dof = DofMap::displacement(node);
             return motion[dof] != 0.0 || motion[dof + 1] != 0.0;
           });
  });
}

void Condensation::solve_for_border() {
  const auto n = static_cast<Eigen::Index>(kept_.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    whole_.setZero();
    border(whole_)[j] = 1.0;
    recover(whole_);
    find_forces(whole_, 0, whole_.size());
    for (Eigen::Index i = 0; i < n; ++i) S_(i, j) = all_forces_[kept_[static_cast<std::size_t>(i)]];
  }
}

// Forces on all dofs where those from `begin` to `end` have moved by x, and no other.
void Condensation::find_forces(const Eigen::VectorXd& x, Eigen::Index begin, Eigen::Index end) {
  all_dofs_.setZero();
  for (Eigen::Index i = begin; i < end; ++i) all_dofs_[dof_of(i)] = x[i];
  multiply(all_dofs_, all_forces_);
}

// As BorderSolver::eliminate and recover.  Of a solver without a border x_l is K_ll^-1 b_l in between.
void Condensation::eliminate(Eigen::VectorXd& x) {
  const auto n = static_cast<std::size_t>(condensed()), all = n + kept_.size();
  if (border_solver_ != nullptr) return border_solver_->eliminate({x.data(), all}, {x.data(), all});
  checked_solve(*solver_, {x.data(), n}, {x.data(), n});
  find_forces(x, 0, condensed());
  for (Eigen::Index i = condensed(); i < x.size(); ++i) x[i] -= all_forces_[dof_of(i)];
}

void Condensation::recover(Eigen::VectorXd& x) {
  const auto n = static_cast<std::size_t>(condensed());
  if (border_solver_ != nullptr) return border_solver_->recover({x.data(), n + kept_.size()});
  find_forces(x, condensed(), x.size());
  for (Eigen::Index i = 0; i < condensed(); ++i) solution_[i] = all_forces_[dof_of(i)];
  checked_solve(*solver_, {solution_.data(), n}, {solution_.data(), n});
  inner(x) -= solution_;
}

// Displacements count from the element's first node, as in ConstantRegion.
void Condensation::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.setZero();
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    const std::size_t nodes = data.group->node_count(), dofs = data.dofs();
    for (int e = 0; e < data.group->elements(); ++e) {
      const int* node = data.group->nodes_of(e);
      const double* K = data.matrix_of(e);
      const int first_dof = DofMap::displacement(node[0]);
      const double first[] = {x[first_dof], x[first_dof + 1]};
      if (first[0] != 0.0) {
        const double* shift = data.shift_of(e);
        for (std::size_t i = 0; i < nodes; ++i) {
          const int dof = DofMap::displacement(node[i]);
          y[dof] += shift[2 * i] * first[0];
          y[dof + 1] += shift[2 * i + 1] * first[0];
        }
      }
      for (std::size_t j = 2; j < dofs; ++j) {
        const double xj = x[DofMap::displacement(node[j / 2], static_cast<int>(j % 2))] - first[j % 2];
        if (xj == 0.0) continue;
        for (std::size_t i = 0; i < nodes; ++i) {
          const int dof = DofMap::displacement(node[i]);
          y[dof] += K[j * dofs + 2 * i] * xj;
          y[dof + 1] += K[j * dofs + 2 * i + 1] * xj;
        }
      }
    }
  }
}

void Condensation::begin_stage(const Eigen::VectorXd& loads, const Eigen::VectorXd& prescribed,
                               double force_squares) {
  stage_forces_.setZero();
  if (!prescribed.isZero(0.0)) multiply(prescribed, stage_forces_);
  for (Eigen::Index i = 0; i < condensed(); ++i) stage_load_[i] = loads[dof_of(i)] - stage_forces_[dof_of(i)];
  stage_work_ = eliminate_loads(stage_load_, stage_);
  predictor_.begin_stage(reaches_region(prescribed), force_squares);
}

// Returns their work while the border is held.
double Condensation::eliminate_loads(const Eigen::VectorXd& loads, Eigen::VectorXd& eliminated) {
  inner(eliminated) = loads;
  border(eliminated).setZero();
  eliminate(eliminated);
  inner(whole_) = inner(eliminated);
  border(whole_).setZero();
  recover(whole_);
  return loads.dot(inner(whole_));
}

void Condensation::begin_step(double part, const StageSoFar& so_far, const Eigen::VectorXd& target,
                              const Eigen::VectorXd& f0, double tolerance) {
  predictor_.begin_step(part, so_far);
  target_ = &target;
  from_is_here_ = false;
  if (!predictor_.is_behind()) look_at_loads(f0, tolerance);
  const double part_since = predictor_.part_since();
  if (predictor_.on_line()) {
    border(step_) = part_since * border(stage_);
    held_work_ = part * part * stage_work_;
  } else {
    held_work_ = eliminate_loads(loads_, step_);
  }
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = kept_[static_cast<std::size_t>(i)];
    g_[i] = f0[dof] + part_since * stage_forces_[dof] - step_[condensed() + i];
  }
  base_.setZero();
}

// Whether those of the step are its part of the stage's.
void Condensation::look_at_loads(const Eigen::VectorXd& f0, double tolerance) {
  const double part_since = predictor_.part_since();
  double off = 0.0;
  for (Eigen::Index i = 0; i < condensed(); ++i) {
    const int dof = dof_of(i);
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
  for (Eigen::Index i = 0; i < base_.size(); ++i)
    kept_du_[i] = du[kept_[static_cast<std::size_t>(i)]] + since[i] - base_[i];
}

void Condensation::add_border_forces(Eigen::VectorXd& f) const {
  kept_f_.noalias() = S_ * kept_du_;
  for (Eigen::Index i = 0; i < g_.size(); ++i) f[kept_[static_cast<std::size_t>(i)]] += g_[i] + kept_f_[i];
}

// Interface dofs that move by u leave rounding of |K| |u|: the solution is the motion from a state near by.
void Condensation::complete(Eigen::VectorXd& du) {
  if (!from_is_here_) {
    from_is_here_ = true;
    from_has_loads_ = predictor_.extrapolate(condensed_, kept_, from_);
    if (!from_has_loads_ && predictor_.on_line()) inner(step_) = predictor_.part_since() * inner(stage_);
  }
  if (from_has_loads_)
    inner(whole_).setZero();
  else
    inner(whole_) = inner(step_);
  for (Eigen::Index i = condensed(); i < whole_.size(); ++i)
    whole_[i] = du[dof_of(i)] + predictor_.since()[i - condensed()] - from_[i];
  recover(whole_);
  for (Eigen::Index i = 0; i < condensed(); ++i) du[dof_of(i)] = from_[i] + whole_[i];
}

double Condensation::step_norm(const Eigen::VectorXd& du) const {
  double inner = 0.0;
  for (const int dof : condensed_) inner += du[dof] * du[dof];
  const double part = predictor_.is_behind() ? predictor_.part() / predictor_.part_since() : 1.0;
  return std::sqrt(std::max(0.0, du.squaredNorm() - (1.0 - part * part) * inner));
}

double Condensation::rounding(const Eigen::VectorXd& du) const {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  find_kept_motion(du);
  return kRounding * S_norm_ * kept_du_.lpNorm<Eigen::Infinity>();
}

void Condensation::add_motion(Eigen::VectorXd& du) const {
  const Eigen::VectorXd& since = predictor_.since();
  for (Eigen::Index i = 0; i < since.size(); ++i) du[kept_[static_cast<std::size_t>(i)]] += since[i];
}

// Of the condensed ones from the border: the stage's loads L there move by part K_ll^-1 L - K_ll^-1 K_ln du_n.
double Condensation::load_work(const Eigen::VectorXd& loads, const Eigen::VectorXd& du) const {
  if (!predictor_.on_line() || predictor_.supports_move()) return loads.dot(du);
  double work = predictor_.part() * stage_work_;
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = kept_[static_cast<std::size_t>(i)];
    work += (loads[dof] + stage_[condensed() + i]) * du[dof];
  }
  return work;
}

double Condensation::largest_residual(const Eigen::VectorXd& f) const {
  double largest = 0.0;
  for (const int dof : condensed_) largest = std::max(largest, std::abs((*target_)[dof] - f[dof]));
  return largest;
}

void Condensation::refine(const Eigen::VectorXd& f, Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < condensed(); ++i) whole_[i] = (*target_)[dof_of(i)] - f[dof_of(i)];
  border(whole_).setZero();
  eliminate(whole_);
  border(whole_).setZero();
  recover(whole_);
  for (Eigen::Index i = 0; i < condensed(); ++i) du[dof_of(i)] += whole_[i];
}

void Condensation::set_base(const Eigen::VectorXd& all, const Eigen::VectorXd& others,
                            const Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = kept_[static_cast<std::size_t>(i)];
    g_[i] = all[dof] - others[dof];
    base_[i] = du[dof] + predictor_.since()[i];
  }
  from_is_here_ = from_has_loads_ = true;
  for (Eigen::Index i = 0; i < condensed(); ++i) from_[i] = du[dof_of(i)];
  border(from_) = base_;
}

double Condensation::whole_norm(const Eigen::VectorXd& correction) {
  inner(whole_).setZero();
  border(whole_) = correction;
  recover(whole_);
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
      for (std::size_t i = 0; i < own.size(); ++i) flags[static_cast<std::size_t>(own[i])] = 1;
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
  const auto kept = static_cast<int>(std::count_if(
      free_dofs.begin(), free_dofs.end(), [&](int dof) { return keep[static_cast<std::size_t>(dof)] != 0; }));
  const int condensed = static_cast<int>(free_dofs.size()) - kept;
  if (kept == 0 || condensed < kFewestCondensed || too_wide(kept, condensed)) return nullptr;
  try {
    auto region = std::make_unique<Condensation>(groups, free_dofs, keep, make);
    if (!region->analyse_if_it_pays(increments, symmetric)) return nullptr;
    region->factorise();
    const FactorReport report = region->report();
    if (report.smallest_pivot_ratio < kPoorPivot || report.growth > kLargeGrowth) return nullptr;
    return region;
  } catch (const SingularMatrix&) {
    return nullptr;  // a region that is held by its interface dofs alone: the whole system reports the fault, or solves it
  }
}

}  // namespace sage
