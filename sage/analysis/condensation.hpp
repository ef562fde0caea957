// The skip 'condensation'.  Static condensation: free dofs that belong to constant (linear) elements only are eliminated once for all;
// the iterations see the others, the kept ones, and one dense matrix that stands for the whole linear region.
//
// With l = condensed, n = kept, p = prescribed dofs of the linear region, f0 its internal forces at the start
// of a step and F the loads at its end:
//   K_ll du_l = F_l - f0_l - K_ln du_n - K_lp du_p
//   f_n = g + S du_n,   S = K_nn - K_nl K_ll^-1 K_ln,
//   g = f0_n + K_np du_p + K_nl K_ll^-1 (F_l - f0_l - K_lp du_p)
// Once the region's forces f are known at some du, f_n = f(du)_n + S (change of du_n): S then multiplies small
// changes, and its rounding counts no more.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "sage/analysis/group_data.hpp"
#include "sage/core/linear_solver.hpp"

namespace sage {

// Makes a solver for so many equations; symmetric: the matrix is.
using SolverMaker = std::function<std::unique_ptr<LinearSolver>(int equations, bool symmetric)>;

class Condensation {
 public:
  // dofs: all free ones.  keep: a flag a dof, for those that belong to other elements too.  Throws
  // SingularMatrix.
  Condensation(const std::vector<GroupData>& groups, const std::vector<int>& dofs,
               const std::vector<char>& keep, const SolverMaker& make);

  const std::vector<int>& kept() const { return kept_; }  // dofs
  const std::vector<int>& condensed_dofs() const { return condensed_; }
  int condensed() const { return static_cast<int>(condensed_.size()); }
  const Eigen::MatrixXd& S() const { return S_; }
  FactorReport report() const { return solver_->report(); }

  // target: loads at the end of the step; prescribed: its displacement of every prescribed dof (others 0); f0:
  // internal forces of the linear region.  One entry a dof.
  void begin_step(const Eigen::VectorXd& target, const Eigen::VectorXd& prescribed, const Eigen::VectorXd& f0);
  // Work of the step's loads on the region while its border is held (twice that of a ramp).
  double held_work() const { return held_work_; }
  // f += forces of the linear region on the kept dofs: where the step begins (du = 0), and anywhere.
  void add_start_forces(Eigen::VectorXd& f) const;
  void add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& f) const;
  // Fills in du of the condensed dofs.
  void complete(Eigen::VectorXd& du);
  // Largest load that the internal forces f leave unbalanced at condensed dofs.
  double largest_residual(const Eigen::VectorXd& f) const;
  // Corrects du of the condensed dofs for what f leaves there.
  void refine(const Eigen::VectorXd& f, Eigen::VectorXd& du);
  // all - others: forces of the linear region at du.  Those of other du are taken from there.
  void set_base(const Eigen::VectorXd& all, const Eigen::VectorXd& others, const Eigen::VectorXd& du);
  // |correction| with what it brings about at the condensed dofs; correction: a kept dof each.
  double whole_norm(const Eigen::VectorXd& correction);

 private:
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;  // y = K x of the linear region
  void solve();                                                       // K_ll solution_ = rhs_
  void solve_condensed(Eigen::VectorXd& x);

  const std::vector<GroupData>* groups_;
  std::vector<int> kept_, condensed_;
  std::unique_ptr<LinearSolver> solver_;
  Eigen::MatrixXd S_;
  Eigen::VectorXd g_, base_;       // forces at the place base_ of the kept dofs
  Eigen::VectorXd target_, load_;  // F_l, F_l - f0_l; a condensed dof each
  Eigen::VectorXd rhs_, solution_, work_x_, work_y_;
  double held_work_ = 0.0;
  mutable Eigen::VectorXd kept_du_, kept_f_;
};

// The constant region of the active groups, where its elimination pays in so many increments; nullptr where it
// does not, where K_ll is singular or nearly so.  free_dofs: those with an equation; dofs: of the model.
std::unique_ptr<Condensation> condense_if_it_pays(const std::vector<GroupData>& groups,
                                                  const std::vector<int>& free_dofs, int dofs, int increments,
                                                  const SolverMaker& make);

}  // namespace sage
