// Passes over the elements: internal forces, element matrices into the solver, states of all points.
#pragma once

#include <vector>

#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/state_store.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/model.hpp"

namespace sage {

// A group's points and what is kept of its elements between passes.
struct GroupData {
  const Group* group = nullptr;
  LawRef law;
  bool active = false;
  bool linear = false;
  StateStore state;
  std::vector<double> geometry;  // w and B of all elements; empty = made anew in each pass
  int first_element = 0;         // in the solver's element order, while active
};

class Assembly {
 public:
  Assembly(const Model& model, const Scene& scene, WorkCounters& work);

  // Equations and element order of a stage.  rate: displacement of every prescribed dof over the stage.
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate);

  int equations() const { return equations_; }
  const ElementEquations& element_equations() const { return element_equations_; }
  int equation_of(int dof) const { return equation_of_dof_[static_cast<std::size_t>(dof)]; }
  int dof_of(int equation) const { return dof_of_equation_[static_cast<std::size_t>(equation)]; }

  // Internal forces at committed state + du.  With a solver, K too: added to it, and its product with the
  // prescribed displacements' rate kept (coupling()).
  Outcome evaluate(const Eigen::VectorXd& du, LinearSolver* solver);
  // Law::path_error of the trial states, the mean over all points by the work of their stress increments.
  double path_error() const;
  // Trial states become committed.
  void commit();

  const Eigen::VectorXd& internal_force() const { return internal_; }  // every dof
  const Eigen::VectorXd& coupling() const { return coupling_; }        // K(free, prescribed) rate, every dof
  // sqrt(sum over elements of |f_e|^2): a force scale that vanishes only in a stress-free mesh.
  double force_scale() const { return force_scale_; }

  std::vector<GroupData>& groups() { return groups_; }
  const std::vector<GroupData>& groups() const { return groups_; }
  std::array<long, kStatuses> count_points() const;  // committed states of active groups

 private:
  Outcome evaluate_group(GroupData& data, const Eigen::VectorXd& du, LinearSolver* solver);
  void add_to_globals(const GroupData& data, int element, const double* f, const double* K,
                      LinearSolver* solver);

  const Model* model_;
  const Scene* scene_;
  WorkCounters* work_;
  std::vector<GroupData> groups_;
  int equations_ = 0;
  std::vector<int> equation_of_dof_, dof_of_equation_;
  ElementEquations element_equations_;
  Eigen::VectorXd rate_, internal_, coupling_;
  double force_scale_ = 0.0, scale_sum_ = 0.0;
  std::vector<double> scratch_geometry_, scratch_K_, scratch_f_, scratch_du_;
  Eigen::Matrix2Xd scratch_x_;
};

}  // namespace sage
