// The skip 'condensation'.  Static condensation: free dofs that belong to constant (linear) elements only are eliminated once for all;
// the iterations have the others, the kept ones, and one dense matrix for the whole linear region.
//
// With l = condensed, n = kept, p = prescribed dofs of the linear region, f0 its internal forces at the start
// of a step and F the loads at its end:
//   K_ll du_l = F_l - f0_l - K_ln du_n - K_lp du_p
//   f_n = g + S du_n,   S = K_nn - K_nl K_ll^-1 K_ln,
//   g = f0_n + K_np du_p + K_nl K_ll^-1 (F_l - f0_l - K_lp du_p)
// A solver that keeps a border has S when K_ll is factorised, and an increment then costs one back substitution: loads
// grow along a line in a stage, so that they are eliminated once.  With other solvers S costs one solution per kept dof.
// Once the region's forces f are known at some du, f_n = f(du)_n + S (change of du_n): S then multiplies small
// changes, and its rounding counts no more.
//
// du_l is recovered now and then, and where output needs it.  Steps between two recoveries are one step for the region, as
// it is linear: the load path of its border between them does not matter (RegionPredictor).
#pragma once

#include <memory>
#include <vector>

#include "sage/analysis/skips/region_matrix.hpp"
#include "sage/analysis/skips/region_predictor.hpp"

namespace sage {

class Condensation final : public EliminatedDofs {
 public:
  // matrix: factorised.
  explicit Condensation(RegionMatrix matrix);

  const RegionMatrix& matrix() const { return matrix_; }
  const std::vector<int>& dofs() const override { return matrix_.condensed_dofs(); }
  const std::vector<char>& nodes() const override { return matrix_.inner_nodes(); }
  double smallest_pivot() const override { return matrix_.report().smallest_pivot_ratio; }

  // Over the whole stage, one entry per dof: the loads that are added, and the displacement of every prescribed dof
  // (others 0).  force_squares: sum over the region's elements of |f_e|^2 now.  Before the first step, or behind
  // exchange().
  void begin_stage(const Eigen::VectorXd& loads, const Eigen::VectorXd& prescribed, double force_squares);
  // part: the step's share of the stage; target: loads at its end; f0: internal forces of the linear region where it was
  // recovered last.  One entry per dof; target and what so_far points to must outlive the step.  tolerance: force that f0
  // may leave unbalanced.
  void begin_step(double part, const StageSoFar& so_far, const Eigen::VectorXd& target,
                  const Eigen::VectorXd& f0, double tolerance);
  double held_work() const override { return held_work_; }
  // f += forces of the linear region on the kept dofs: where the step begins (du = 0), and anywhere.
  void add_start_forces(Eigen::VectorXd& f) const;
  void add_forces(const Eigen::VectorXd& du, Eigen::VectorXd& f) const;
  // Recovers du of the condensed dofs: their motion since they were recovered last.
  void complete(Eigen::VectorXd& du);
  // |du| of the step in hand once that is done: condensed dofs count by its part of what they have moved.
  double step_norm(const Eigen::VectorXd& du) const;
  // Force that rounding may then leave unbalanced at a kept dof.
  double rounding(const Eigen::VectorXd& du) const;
  // When the region was recovered last, and what follows from that for the step in hand.
  RegionPredictor& predictor() { return predictor_; }
  const RegionPredictor& predictor() const { return predictor_; }
  // du, with what the kept dofs have moved since then.
  void add_motion(Eigen::VectorXd& du) const;
  double load_work(const Eigen::VectorXd& loads, const Eigen::VectorXd& du) const override;
  // Largest load that the internal forces f leave unbalanced at condensed dofs.
  double largest_residual(const Eigen::VectorXd& f) const;
  // Corrects du of the condensed dofs for what f leaves there.
  void refine(const Eigen::VectorXd& f, Eigen::VectorXd& du);
  // all - others: forces of the linear region at du, recovered.  Those at other du count from them.
  void set_base(const Eigen::VectorXd& all, const Eigen::VectorXd& others, const Eigen::VectorXd& du);
  // |correction| with what it brings about at the condensed dofs; correction: one entry per kept dof.
  double whole_norm(const Eigen::VectorXd& correction);

 private:
  void add_border_forces(Eigen::VectorXd& f) const;  // where they have moved by kept_du_
  double eliminate_loads(const Eigen::VectorXd& loads, Eigen::VectorXd& eliminated);
  void look_at_loads(const Eigen::VectorXd& f0, double tolerance);
  void find_kept_motion(const Eigen::VectorXd& du) const;  // kept_du_: from base_

  RegionMatrix matrix_;
  RegionPredictor predictor_;
  Eigen::VectorXd g_, base_;  // forces at the place base_ of the kept dofs
  const Eigen::VectorXd* target_ = nullptr;
  Eigen::VectorXd stage_load_, stage_;  // of the whole stage: F_l - f0_l - K_lp du_p, and eliminated
  Eigen::VectorXd stage_forces_;        // K du_p of the whole stage, every dof
  Eigen::VectorXd loads_, step_;        // of the step, likewise; of loads that from_ has, the border alone
  Eigen::VectorXd from_;                // displacements from which those of the step are counted,
  bool from_has_loads_ = false;         // whether they balance its loads,
  bool from_is_here_ = false;           // and whether they are those of this step
  Eigen::VectorXd whole_;               // work space
  double stage_work_ = 0.0, held_work_ = 0.0;
  mutable Eigen::VectorXd kept_du_, kept_f_;
};

// The constant region of the active groups, where its elimination pays in so many increments; nullptr where it
// does not, where K_ll is singular or nearly so.  free_dofs: those with an equation; dofs: of the model; symmetric: the
// whole matrix is.
std::unique_ptr<Condensation> condense_if_it_pays(const std::vector<GroupData>& groups,
                                                  const std::vector<int>& free_dofs, int dofs, int increments,
                                                  bool symmetric, const SolverMaker& make);

}  // namespace sage
