#include "sage/analysis/condensation.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

bool symmetric(const LawRef& law) {
  return std::visit([](const auto* l) { return l->symmetric(); }, law);
}

}  // namespace

Condensation::Condensation(const std::vector<GroupData>& groups, const std::vector<int>& dofs,
                           const std::vector<char>& keep, const SolverMaker& make)
    : groups_(&groups) {
  std::vector<int> equation(keep.size(), -1);
  for (int dof : dofs) {
    if (keep[static_cast<std::size_t>(dof)]) {
      kept_.push_back(dof);
    } else {
      equation[static_cast<std::size_t>(dof)] = condensed();
      condensed_.push_back(dof);
    }
  }
  ElementEquations elements;
  bool all_symmetric = true;
  for (const GroupData& data : groups) {
    if (!data.active || !data.constant) continue;
    all_symmetric = all_symmetric && symmetric(data.law);
    append_equations(data, equation, elements);
  }
  solver_ = make(condensed(), all_symmetric);
  solver_->analyse(condensed(), std::move(elements));
  solver_->clear();
  int element = 0;
  for (const GroupData& data : groups) {
    if (!data.active || !data.constant) continue;
    for (int e = 0; e < data.group->elements(); ++e) solver_->add(element++, data.matrix_of(e));
  }
  solver_->factorise();
  solver_->release_workspace();

  const auto n = static_cast<Eigen::Index>(kept_.size());
  const auto all = static_cast<Eigen::Index>(keep.size());
  rhs_.resize(condensed());
  solution_.resize(condensed());
  target_.setZero(condensed());
  load_.setZero(condensed());
  g_.setZero(n);
  base_.setZero(n);
  kept_du_.resize(n);
  kept_f_.resize(n);
  work_x_.setZero(all);
  work_y_.setZero(all);
  S_.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    work_x_.setZero();
    work_x_[kept_[static_cast<std::size_t>(j)]] = 1.0;
    solve_condensed(work_x_);
    multiply(work_x_, work_y_);
    for (Eigen::Index i = 0; i < n; ++i) S_(i, j) = work_y_[kept_[static_cast<std::size_t>(i)]];
  }
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

void Condensation::solve() {
  const auto n = static_cast<std::size_t>(condensed());
  solver_->solve({rhs_.data(), n}, {solution_.data(), n});
}

// x: kept and prescribed dofs given, condensed ones 0 on entry and filled in.
void Condensation::solve_condensed(Eigen::VectorXd& x) {
  multiply(x, work_y_);
  for (Eigen::Index i = 0; i < rhs_.size(); ++i)
    rhs_[i] = load_[i] - work_y_[condensed_[static_cast<std::size_t>(i)]];
  solve();
  for (Eigen::Index i = 0; i < rhs_.size(); ++i) x[condensed_[static_cast<std::size_t>(i)]] = solution_[i];
}

void Condensation::begin_step(const Eigen::VectorXd& target, const Eigen::VectorXd& prescribed,
                              const Eigen::VectorXd& f0) {
  for (Eigen::Index i = 0; i < load_.size(); ++i) {
    const int dof = condensed_[static_cast<std::size_t>(i)];
    target_[i] = target[dof];
    load_[i] = target[dof] - f0[dof];
  }
  work_x_ = prescribed;
  solve_condensed(work_x_);
  held_work_ = rhs_.dot(solution_);
  multiply(work_x_, work_y_);
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = kept_[static_cast<std::size_t>(i)];
    g_[i] = f0[dof] + work_y_[dof];
  }
  base_.setZero();
}

void Condensation::add_start_forces(Eigen::VectorXd& f) const {
  for (Eigen::Index i = 0; i < g_.size(); ++i) f[kept_[static_cast<std::size_t>(i)]] += g_[i];
}

void Condensation::add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& f) const {
  for (Eigen::Index i = 0; i < g_.size(); ++i) kept_du_[i] = du[kept_[static_cast<std::size_t>(i)]] - base_[i];
  kept_f_.noalias() = S_ * kept_du_;
  for (Eigen::Index i = 0; i < g_.size(); ++i) f[kept_[static_cast<std::size_t>(i)]] += g_[i] + kept_f_[i];
}

void Condensation::complete(Eigen::VectorXd& du) {
  for (int dof : condensed_) du[dof] = 0.0;
  solve_condensed(du);
}

double Condensation::largest_residual(const Eigen::VectorXd& f) const {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < target_.size(); ++i)
    largest = std::max(largest, std::abs(target_[i] - f[condensed_[static_cast<std::size_t>(i)]]));
  return largest;
}

void Condensation::refine(const Eigen::VectorXd& f, Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < rhs_.size(); ++i)
    rhs_[i] = target_[i] - f[condensed_[static_cast<std::size_t>(i)]];
  solve();
  for (Eigen::Index i = 0; i < rhs_.size(); ++i) du[condensed_[static_cast<std::size_t>(i)]] += solution_[i];
}

void Condensation::set_base(const Eigen::VectorXd& all, const Eigen::VectorXd& others,
                            const Eigen::VectorXd& du) {
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const int dof = kept_[static_cast<std::size_t>(i)];
    g_[i] = all[dof] - others[dof];
    base_[i] = du[dof];
  }
}

double Condensation::whole_norm(const Eigen::VectorXd& correction) {
  work_x_.setZero();
  for (Eigen::Index i = 0; i < correction.size(); ++i)
    work_x_[kept_[static_cast<std::size_t>(i)]] = correction[i];
  multiply(work_x_, work_y_);
  for (Eigen::Index i = 0; i < rhs_.size(); ++i) rhs_[i] = work_y_[condensed_[static_cast<std::size_t>(i)]];
  solve();
  return std::sqrt(correction.squaredNorm() + solution_.squaredNorm());
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

}  // namespace

std::unique_ptr<Condensation> condense_if_it_pays(const std::vector<GroupData>& groups,
                                                  const std::vector<int>& free_dofs, int dofs, int increments,
                                                  const SolverMaker& make) {
  // Measured: the matrix of the border costs a solution for each of its dofs, an iteration saves about eight.
  constexpr int kWidestBorder = 400, kFewestCondensed = 100, kBorderPerIncrement = 15;
  constexpr double kPoorPivot = 1e-6;  // of an ill-conditioned region: its elimination would cost digits
  const std::vector<char> keep = changing_dofs(groups, dofs);
  const auto kept = static_cast<int>(std::count_if(
      free_dofs.begin(), free_dofs.end(), [&](int dof) { return keep[static_cast<std::size_t>(dof)] != 0; }));
  const int condensed = static_cast<int>(free_dofs.size()) - kept;
  if (kept == 0 || kept > kWidestBorder || condensed < kFewestCondensed || condensed < 4 * kept ||
      kept > kBorderPerIncrement * increments)
    return nullptr;
  try {
    auto region = std::make_unique<Condensation>(groups, free_dofs, keep, make);
    if (region->report().smallest_pivot_ratio < kPoorPivot) return nullptr;
    return region;
  } catch (const SingularMatrix&) {
    return nullptr;  // a region that only its border holds: the whole system says what is wrong, or solves it
  }
}

}  // namespace sage
