// The matrix of a linear region with the dofs eliminated that only its elements have: K_ll, its factors and
// S = K_nn - K_nl K_ll^-1 K_ln (condensation.hpp).
#pragma once

#include <memory>
#include <vector>

#include "sage/analysis/assembly.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"

namespace sage {

// Vectors of the region have condensed dofs first and kept ones behind them, as in BorderSolver.
class RegionMatrix {
 public:
  // dofs: all free ones.  keep: one flag per dof, for those that belong to other elements, too.
  RegionMatrix(const std::vector<GroupData>& groups, const std::vector<int>& dofs,
               const std::vector<char>& keep, const SolverMaker& make);

  // The equations, if the iterations of so many increments cost less with it; false: they don't.  symmetric: the whole
  // matrix is.
  bool analyse_if_it_pays(int increments, bool symmetric);
  // K_ll, its factors and S.  Throws SingularMatrix.
  void factorise();

  const std::vector<int>& kept() const { return kept_; }  // dofs
  const std::vector<int>& condensed_dofs() const { return condensed_; }
  int condensed() const { return static_cast<int>(condensed_.size()); }
  const Eigen::MatrixXd& S() const { return S_; }
  FactorReport report() const { return solver_->report(); }
  int dofs() const { return dofs_; }         // of the model
  double S_norm() const { return S_norm_; }  // largest sum of |terms| of a row
  // One flag per node: an element of the region has it, and it has a dof that is not kept.
  const std::vector<char>& inner_nodes() const { return inner_nodes_; }

  auto inner(Eigen::VectorXd& x) const { return x.head(condensed()); }
  auto border(Eigen::VectorXd& x) const { return x.tail(static_cast<Eigen::Index>(kept_.size())); }
  int dof_of(Eigen::Index i) const { return i < condensed() ? condensed_[i] : kept_[i - condensed()]; }

  // As BorderSolver::eliminate and recover.
  void eliminate(Eigen::VectorXd& x);
  void recover(Eigen::VectorXd& x);
  // y = K x, one entry per dof of the model.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // Some node of the region has a part in this motion, one entry per dof of the model.
  bool is_moved_by(const Eigen::VectorXd& motion) const;

 private:
  void find_forces(const Eigen::VectorXd& x, Eigen::Index begin, Eigen::Index end);
  void solve_for_border();  // S, one solution per column
  void list_inner_nodes();
  void analyse();
  bool border_pays(int increments, bool symmetric) const;
  bool solutions_pay(int increments) const;

  const std::vector<GroupData>* groups_;
  int dofs_;
  std::vector<int> kept_, condensed_;
  std::unique_ptr<LinearSolver> solver_;
  BorderSolver* border_solver_ = nullptr;  // the same one, where it keeps the border
  Eigen::MatrixXd S_;
  double S_norm_ = 0.0;
  std::vector<char> inner_nodes_;
  Eigen::VectorXd solution_, all_dofs_, all_forces_;  // work space
};

}  // namespace sage
