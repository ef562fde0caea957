#include "sage/analysis/skips/region_matrix.hpp"

#include <algorithm>

#include "sage/analysis/checked_solve.hpp"

namespace sage {

namespace {

bool symmetric(const LawRef& law) {
  return std::visit([](const auto* l) { return l->traits().symmetric; }, law);
}

}  // namespace

RegionMatrix::RegionMatrix(const std::vector<GroupData>& groups, const std::vector<int>& dofs,
                           const std::vector<char>& keep, const SolverMaker& make)
    : groups_(&groups), dofs_(static_cast<int>(keep.size())) {
  for (int dof : dofs) (keep[dof] ? kept_ : condensed_).push_back(dof);
  bool all_symmetric = true;
  for (const GroupData& data : groups)
    if (data.active && data.constant) all_symmetric = all_symmetric && symmetric(data.law);
  solver_ = make(condensed(), all_symmetric);
  border_solver_ = dynamic_cast<BorderSolver*>(solver_.get());
  if (border_solver_ != nullptr && !border_solver_->set_border(static_cast<int>(kept_.size())))
    border_solver_ = nullptr;
}

bool RegionMatrix::analyse_if_it_pays(int increments, bool symmetric) {
  if (border_solver_ == nullptr && !solutions_pay(increments)) return false;
  analyse();
  return border_solver_ == nullptr || border_pays(increments, symmetric);
}

void RegionMatrix::analyse() {
  const int equations = condensed() + (border_solver_ != nullptr ? static_cast<int>(kept_.size()) : 0);
  std::vector<int> equation(static_cast<std::size_t>(dofs_), -1);
  for (int i = 0; i < equations; ++i) equation[dof_of(i)] = i;
  ElementEquations elements;
  for (const GroupData& data : *groups_)
    if (data.active && data.constant) append_equations(data, equation, elements);
  solver_->analyse(equations, std::move(elements));
}

// Measured: S costs a solution for each of its dofs, an iteration saves about eight.
bool RegionMatrix::solutions_pay(int increments) const {
  constexpr std::size_t kWidestBorder = 400;
  constexpr int kBorderPerIncrement = 15;
  if (kept_.size() > kWidestBorder) return false;
  const int border = static_cast<int>(kept_.size());
  return condensed() >= 4 * border && border <= kBorderPerIncrement * increments;
}

bool RegionMatrix::border_pays(int increments, bool symmetric) const {
  const double border = static_cast<double>(kept_.size());
  // The whole matrix is factorised once an increment at least (large systems keep factors within a step), with twice
  // the work of the region where it is unsymmetric; the border's once in each of two iterations.
  const double region = solver_->report().factor_operations;
  const double whole = (symmetric == solver_->traits().symmetric ? 1.0 : 2.0) * region;
  const double dense = border * border * border / (symmetric ? 3.0 : 1.5);
  return region + increments * 2.0 * dense < increments * whole;
}

void RegionMatrix::factorise() {
  solver_->clear();
  int element = 0;
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    for (int e = 0; e < data.group->elements(); ++e) solver_->add(element++, data.matrix_of(e));
  }
  solver_->factorise();

  for (Eigen::VectorXd* x : {&all_dofs_, &all_forces_}) x->setZero(dofs_);
  solution_.setZero(condensed());
  const auto n = static_cast<Eigen::Index>(kept_.size());
  S_.resize(n, n);
  if (border_solver_ != nullptr)
    border_solver_->border_matrix(S_.data());
  else
    solve_for_border();
  S_norm_ = S_.cwiseAbs().rowwise().sum().maxCoeff();
  list_inner_nodes();
}

void RegionMatrix::list_inner_nodes() {
  std::vector<char> kept(static_cast<std::size_t>(dofs_), 0);
  for (const int dof : kept_) kept[dof] = 1;
  inner_nodes_.assign(static_cast<std::size_t>(dofs_) / 2, 0);
  for (const GroupData& data : *groups_) {
    if (!data.active || !data.constant) continue;
    for (const int node : data.group->nodes) {
      const auto first = static_cast<std::size_t>(DofMap::displacement(node));
      if (!kept[first] || !kept[first + 1]) inner_nodes_[node] = 1;
    }
  }
}

bool RegionMatrix::is_moved_by(const Eigen::VectorXd& motion) const {
  return std::ranges::any_of(*groups_, [&](const GroupData& data) {
    return data.active && data.constant && std::ranges::any_of(data.group->nodes, [&](int node) {
             const int dof = DofMap::displacement(node);
             return motion[dof] != 0.0 || motion[dof + 1] != 0.0;
           });
  });
}

void RegionMatrix::solve_for_border() {
  const auto n = static_cast<Eigen::Index>(kept_.size());
  Eigen::VectorXd whole(condensed() + n);
  for (Eigen::Index j = 0; j < n; ++j) {
    whole.setZero();
    border(whole)[j] = 1.0;
    recover(whole);
    find_forces(whole, 0, whole.size());
    for (Eigen::Index i = 0; i < n; ++i) S_(i, j) = all_forces_[kept_[i]];
  }
}

// Forces on all dofs where those from `begin` to `end` have moved by x, and no other.
void RegionMatrix::find_forces(const Eigen::VectorXd& x, Eigen::Index begin, Eigen::Index end) {
  all_dofs_.setZero();
  for (Eigen::Index i = begin; i < end; ++i) all_dofs_[dof_of(i)] = x[i];
  multiply(all_dofs_, all_forces_);
}

// As BorderSolver::eliminate and recover.  Of a solver without a border x_l is K_ll^-1 b_l in between.
void RegionMatrix::eliminate(Eigen::VectorXd& x) {
  const auto n = static_cast<std::size_t>(condensed()), all = n + kept_.size();
  if (border_solver_ != nullptr) return border_solver_->eliminate({x.data(), all}, {x.data(), all});
  checked_solve(*solver_, {x.data(), n}, {x.data(), n});
  find_forces(x, 0, condensed());
  for (Eigen::Index i = condensed(); i < x.size(); ++i) x[i] -= all_forces_[dof_of(i)];
}

void RegionMatrix::recover(Eigen::VectorXd& x) {
  const auto n = static_cast<std::size_t>(condensed());
  if (border_solver_ != nullptr) return border_solver_->recover({x.data(), n + kept_.size()});
  find_forces(x, condensed(), x.size());
  for (Eigen::Index i = 0; i < condensed(); ++i) solution_[i] = all_forces_[dof_of(i)];
  checked_solve(*solver_, {solution_.data(), n}, {solution_.data(), n});
  inner(x) -= solution_;
}

// Displacements count from the element's first node, as in ConstantRegion.
void RegionMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
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

}  // namespace sage
