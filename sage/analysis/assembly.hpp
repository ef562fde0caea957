// Passes over the elements: internal forces, element matrices into the solver, states of all points.
#pragma once

#include <utility>
#include <vector>

#include "sage/analysis/condensation.hpp"
#include "sage/analysis/group_data.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/analysis/skips.hpp"
#include "sage/core/archive.hpp"
#include "sage/core/stop.hpp"
#include "sage/model/activity.hpp"

namespace sage {

class Tangent;

class Assembly {
 public:
  Assembly(const Model& model, const Scene& scene, const Skips& skips, WorkCounters& work);

  // Passes over the elements ask it now and then and throw Stopped.
  void set_stop(StopAsked asked) { stop_asked_ = std::move(asked); }

  // Equations and element order of a stage.  rate: displacement of every prescribed dof over the stage.
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate);
  // Birth of a group: free of stress, with its first history.
  void reset_group(std::size_t group);
  // After committed states were set from outside (initial stress): the forces that belong to them.
  void take_states();

  int equations() const { return equations_; }
  // Of the elements of the system: all active ones, or with a condensed region those of changing groups and the
  // region's dense matrix last.
  ElementEquations element_equations() const;
  int equation_of(int dof) const { return equation_of_dof_[static_cast<std::size_t>(dof)]; }
  int dof_of(int equation) const { return dof_of_equation_[static_cast<std::size_t>(equation)]; }

  // False: no active element has the node of this dof.
  bool in_use(int dof) const { return node_used_[static_cast<std::size_t>(dof / 2)] != 0; }

  // Takes the linear region out of the iterations where that pays in so many increments.
  void condense(int increments, const SolverMaker& make);
  const Condensation* condensation() const { return condensation_.get(); }

  // A step begins: target = loads at its end, rate_part = its part of the prescribed
  // displacements.  Needed by iterate().
  void begin_step(const Eigen::VectorXd& target, double rate_part);
  // As evaluate(), within the iterations of a step: a condensed region acts by its border.
  Outcome iterate(const Eigen::VectorXd& du, Tangent* tangent);
  // Fills in du of condensed dofs as the last iterate() implies; forces and their scale are then those of all
  // elements, and the next iterate() counts from them.  Nothing where no region is condensed.
  void complete(Eigen::VectorXd& du);
  // |correction| of all free dofs; correction: an equation each.
  double whole_norm(const Eigen::VectorXd& correction);

  // Internal forces at committed state + du.  With a tangent, K too.
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);
  // Law::path_error of the trial states, the mean over all points by the work of their stress increments.
  double path_error() const;
  // Trial states become committed; du as in the evaluation before.
  void commit(const Eigen::VectorXd& du);
  // The same for a step that a checkpoint has counted already.
  void commit_again();
  // Brings the states of constant groups up to date; others always are.  Until it is called, stress and strain
  // of constant groups may have no room at all.
  void recover_states();

  const Eigen::VectorXd& internal_force() const { return internal_; }  // every dof
  // sqrt(sum over elements of |f_e|^2): a force scale that vanishes only in a stress-free mesh.
  double force_scale() const { return force_scale_; }

  // States of all groups and what goes with them.  before_step: those of active groups as they were before the
  // last commit (reading gives them back as committed).
  void exchange(Archive& archive, bool before_step);

  std::vector<GroupData>& groups() { return groups_; }
  const std::vector<GroupData>& groups() const { return groups_; }
  std::array<long, kStatuses> count_points() const;  // committed states of active groups

 private:
  const double* geometry_of(GroupData& data, int element);
  Outcome evaluate_element(GroupData& data, int element, const Eigen::VectorXd* du, double* K);
  Outcome evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent);
  Outcome evaluate_groups(const Eigen::VectorXd& du, Tangent* tangent);
  void add_constant(const Eigen::VectorXd& du);
  bool in_system(const GroupData& data) const;
  void number_elements();
  Outcome evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent);
  void evaluate_constant(GroupData& data, const Eigen::VectorXd& du);
  void keep_matrices(GroupData& data);
  void make_shifts(GroupData& data, int matrices) const;
  void gather(const GroupData& data, int element, const Eigen::VectorXd& u);
  double add_force(const GroupData& data, int element, const double* f, Eigen::VectorXd& to) const;
  void fill(Tangent& tangent) const;
  void stop_if_asked_at(int element) const;
  bool keeps_matrices(const GroupData& data) const { return !data.matrix.empty(); }

  const Model* model_;
  const Scene* scene_;
  Skips skips_;
  StopAsked stop_asked_;
  WorkCounters* work_;
  std::vector<GroupData> groups_;
  int equations_ = 0;
  std::vector<int> equation_of_dof_, dof_of_equation_;
  std::vector<char> node_used_;
  int elements_ = 0;  // of the system
  Eigen::VectorXd rate_, internal_;
  // Internal forces of groups that are not constant, every dof; no size where there are none.
  Eigen::VectorXd changing_;
  std::unique_ptr<Condensation> condensation_;
  Eigen::VectorXd prescribed_, constant_force_;
  Eigen::VectorXd behind_;  // displacement that the states of constant groups do not know yet, every dof
  bool is_behind_ = false;
  double force_scale_ = 0.0, changing_sum_ = 0.0, constant_sum_ = 0.0;
  std::vector<double> scratch_geometry_, scratch_K_, scratch_f_, scratch_du_, scratch_sigma_, scratch_eps_;
  std::vector<double> no_stress_;  // zeros, of one element
  Eigen::Matrix2Xd scratch_x_;
};

}  // namespace sage
