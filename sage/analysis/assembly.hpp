// Passes over the elements: internal forces, element matrices into the tangent, states of all points.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/eliminated_dofs.hpp"
#include "sage/analysis/equations.hpp"
#include "sage/analysis/iterated_step.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/analysis/skips.hpp"
#include "sage/core/archive.hpp"

namespace sage {

// Makes a solver for so many equations that factorises once; symmetric: the matrix is.
using SolverMaker = std::function<std::unique_ptr<LinearSolver>(int equations, bool symmetric)>;

// Every pass evaluates all active elements, one after the other.  Classes that leave out some of that derive from it
// (skips/).
class Assembly {
 public:
  // All arguments must outlive it.
  Assembly(const Model& model, const Scene& scene, WorkCounters& work) : Assembly(model, scene, work, {}) {}
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;
  virtual ~Assembly() = default;

  // The time and load factor of the evaluations that follow: needed only where a law depends on them, or an element on the
  // loads along it.
  bool wants_step_time() const { return wants_step_time_; }
  // Water flows by a law that is eased (PointContext::easing).
  bool eases() const { return eases_; }
  const Scene& scene() const { return *scene_; }
  void set_step_time(const StepTime& step_time);
  const StepTime& step_time() const { return element_.step_time(); }
  // The loads along elements at the end of the stage in hand have changed: they grow there from what acts at this load
  // factor, below 1.
  void take_spread_loads(double load_factor);
  const Mesh& mesh() const { return model_->mesh; }

  // Passes over the elements call it now and then and throw Stopped.
  void set_stop(StopAsked asked) { element_.set_stop(std::move(asked)); }

  // Passes over many elements may use so many threads.  Results do not depend on it.
  virtual void set_threads(int threads) { threads_ = threads; }
  int threads() const { return threads_; }

  // Equations and element order of a stage.  rate: displacement of every prescribed dof over the stage.
  virtual void enter_stage(const Activity& activity, const Eigen::VectorXd& rate);
  // The same for all of a stage of so many increments: dofs may be eliminated, with a solver of that maker.
  virtual void enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int /*increments*/,
                           const SolverMaker& /*make*/) {
    enter_stage(activity, rate);
  }
  // Loads that the stage adds, every dof.  Needed before its first step, and only where dofs are eliminated.
  virtual void set_stage_loads(const Eigen::VectorXd& /*loads*/) {}
  // A group is activated: free of stress, with its first history.
  void reset_group(std::size_t group);
  // The laws of the model's materials have been replaced, each by one of the same kind: same history, same stiffness as
  // long as nothing yields.
  virtual void take_laws();
  // Sets committed states from outside (initial stress): `set` gets all groups.  any: it will set some.
  template <class Set>
  void start_states(bool any, Set set) {
    if (!begin_states(any)) return;
    set(groups_);
    end_states();
  }

  const DofMap& dof_map() const { return dof_map_; }
  // Committed unknowns, for elements that see them; they must stay where they are.
  void set_committed(const Eigen::VectorXd& u) { element_.set_committed(&u); }

  int equations() const { return equations_.count(); }
  // Of the elements of the system.
  virtual ElementEquations element_equations() const;
  int equation_of(int dof) const { return equations_.of(dof); }
  int dof_of(int equation) const { return equations_.dof(equation); }
  // False: no active element has the node of this dof.
  bool in_use(int dof) const { return equations_.in_use(dof); }
  // Of the stage in hand; by default none are.
  virtual const EliminatedDofs& eliminated() const;
  // Factors of a K that cannot change serve as long as it stands.
  virtual bool keeps_factors() const { return false; }

  // Internal forces at committed state + du.  With a tangent, K too.
  virtual Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);
  // The elastic K into the tangent: solids at the committed state, interfaces closed and stuck, structures without force.
  // Internal forces then mean nothing until the next evaluation.
  Outcome evaluate_elastic(Tangent& tangent);
  // PathError of the trial states, the mean over all points by the work of their stress increments.
  double path_error() const;
  // One step of the stage and its iterations.  target: loads at the step's end, every dof.  rate_part: its part of the
  // prescribed displacements.  The assembly must outlive it, and stay in its stage.
  virtual std::unique_ptr<IteratedStep> begin_step(const Eigen::VectorXd& target, double rate_part,
                                                   const StageSoFar& so_far);
  // Trial states become committed; du as in the evaluation before.
  virtual void commit(const Eigen::VectorXd& du) { commit_again(du); }
  // The same for a step that a checkpoint has counted already.
  virtual void commit_again(const Eigen::VectorXd& du);

  // Forces and displacements of eliminated dofs are those of an earlier step.
  virtual bool is_behind() const { return false; }
  // The step in hand will not be committed.
  virtual void drop_step() {}
  // Then, where dofs are behind: recovers them at the committed state u, whose loads are `target`, at that load factor of
  // the stage, which started with the unknowns `start`.
  virtual void catch_up(const Eigen::VectorXd& /*target*/, double /*load_factor*/,
                        const Eigen::VectorXd& /*start*/, Eigen::VectorXd& /*u*/) {}
  // The committed state as if it were recovered: the motion that eliminated dofs still lack, and internal forces.  A copy:
  // it changes nothing in the run.  After the commit of the step in hand.
  virtual void show_recovered(Eigen::VectorXd& /*motion*/, Eigen::VectorXd& /*forces*/) {}
  // Recovers states that are not computed in every step: at the committed state plus that motion, ...
  virtual void recover_states_at(const Eigen::VectorXd& /*motion*/) {}
  // ... and for good at the committed state.  Before the first call, stress and strain of such groups may not be allocated.
  virtual void recover_states() {}
  // The same for structures alone.
  virtual void recover_structures() {}

  // Every dof; less what the motion adds to loads on edges.
  const Eigen::VectorXd& internal_force() const { return internal_; }
  // That addition, of the last pass; size 0 where no load follows the motion.
  const Eigen::VectorXd& load_change() const { return element_.load_change(); }
  // sqrt(sum over elements of |f_e|^2), of a field of unknowns: a scale that vanishes only in a stress-free mesh.
  double force_scale(int field) const { return force_scale_[field]; }

  // States of all groups and what goes with them.  before_step: those of active groups as they were before the
  // last commit (reading gives them back as committed).
  virtual void exchange(Archive& archive, bool before_step);

  std::vector<GroupData>& groups() { return groups_; }
  const std::vector<GroupData>& groups() const { return groups_; }
  std::array<long, kStatuses> count_points() const;  // committed states of active groups

 protected:
  // What a group is besides, before its states are allocated.
  using Prepare = std::function<void(GroupData&, std::size_t group)>;
  Assembly(const Model& model, const Scene& scene, WorkCounters& work, const Prepare& prepare);

  virtual bool in_system(const GroupData& data) const { return data.active; }
  virtual bool begin_states(bool /*any*/) { return true; }
  virtual void end_states() {}
  void number_elements();
  static void exchange_states(GroupData& data, Archive& archive, bool before_step);

  const Model* model_;
  const Scene* scene_;
  WorkCounters* work_;
  DofMap dof_map_;
  std::vector<GroupData> groups_;
  ElementWork element_;
  Equations equations_;
  int elements_ = 0;  // of the system
  Eigen::VectorXd internal_;
  FieldSums force_scale_{};

 private:
  Outcome evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent, FieldSums& sums);

  Eigen::VectorXd forces_;  // of the pass in hand
  int threads_ = 1;
  bool wants_step_time_ = false, eases_ = false;
  int spread_stage_ = 0;  // that the groups have the loads along their elements of, from 1
};

// Leaves out what the scene does not need, as far as the skips allow; in a build without skips, nothing.
std::unique_ptr<Assembly> make_assembly(const Model& model, const Scene& scene, const Skips& skips,
                                        WorkCounters& work);

// Of each field: sqrt(a + b), the scale of forces from sums of squares.
FieldSums scales_of(const FieldSums& a, const FieldSums& b);
bool all_finite(const FieldSums& values);

// Some element sees the committed unknowns.
bool sees_unknowns(const Assembly& assembly);
// Water flows in the step in hand: internal forces change with the time alone.
bool water_flows(const Assembly& assembly);
// K depends on nothing but the size of the step.
bool linear_in_step(const Assembly& assembly);

}  // namespace sage
