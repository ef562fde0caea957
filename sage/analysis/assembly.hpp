// Passes over the elements: internal forces, element matrices into the tangent, states of all points.
// Active groups form two regions: changing ones, whose laws are evaluated, and constant ones (skip 'elements').
// In a step a constant region may act by its interface dofs alone (skip 'condensation').
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "sage/analysis/changing_region.hpp"
#include "sage/analysis/condensation.hpp"
#include "sage/analysis/constant_region.hpp"
#include "sage/analysis/deferred_states.hpp"
#include "sage/analysis/equations.hpp"
#include "sage/analysis/records.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/analysis/skips.hpp"

namespace sage {

class Assembly {
 public:
  // All arguments but the skips must outlive it.
  Assembly(const Model& model, const Scene& scene, const Skips& skips, WorkCounters& work);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

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
  void set_threads(int threads) {
    threads_ = threads;
    changing_.set_threads(threads);
    constant_.set_threads(threads);
  }
  int threads() const { return threads_; }

  // Equations and element order of a stage.  rate: displacement of every prescribed dof over the stage.
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate);
  // The same, and condenses the constant region where that pays in so many increments.
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int increments,
                   const SolverMaker& make);
  // Loads that the stage adds, every dof.  Needed before its first step, and only with a condensed region.
  void set_stage_loads(const Eigen::VectorXd& loads);
  // A group is activated: free of stress, with its first history.
  void reset_group(std::size_t group);
  // The laws of the model's materials have been replaced, each by one of the same kind: same history, same stiffness as
  // long as nothing yields.
  void take_laws();
  // Sets committed states from outside (initial stress): `set` gets all groups.  any: it will set some.
  template <class Set>
  void start_states(bool any, Set set) {
    if (deferred_.behind()) {
      if (!any) return;  // the forces of constant groups stay
      recover_states();
    }
    set(groups_);
    constant_.take_states();
  }

  const DofMap& dof_map() const { return dof_map_; }
  // Some element sees the committed unknowns.
  bool sees_unknowns() const;
  // Those unknowns; they must stay where they are.
  void set_committed(const Eigen::VectorXd& u) { element_.set_committed(&u); }

  int equations() const { return equations_.count(); }
  // Of the elements of the system: all active ones, or with a condensed region those of changing groups and the
  // region's dense matrix last.
  ElementEquations element_equations() const;
  int equation_of(int dof) const { return equations_.of(dof); }
  int dof_of(int equation) const { return equations_.dof(equation); }
  // False: no active element has the node of this dof.
  bool in_use(int dof) const { return equations_.in_use(dof); }
  const Condensation* condensation() const { return condensation_.get(); }

  // Internal forces at committed state + du.  With a tangent, K too.  While a condensed region is behind, its forces are
  // those of its border in the step in hand.
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);
  // The elastic K into the tangent: solids at the committed state, interfaces closed and stuck, structures without force.
  // Internal forces then mean nothing until the next evaluation.
  Outcome evaluate_elastic(Tangent& tangent);
  // PathError of the trial states, the mean over all points by the work of their stress increments.
  double path_error() const;
  // Trial states become committed; du as in the evaluation before.
  void commit(const Eigen::VectorXd& du);
  // The same for a step that a checkpoint has counted already.
  void commit_again(const Eigen::VectorXd& du);

  // The recovery of a condensed region is deferred: forces and displacements of its inner nodes are those of an earlier
  // step.
  bool region_is_behind() const { return condensation_ != nullptr && condensation_->predictor().is_behind(); }
  // The step in hand will not be committed.
  void drop_step() { region_step_ = RegionStep::open; }
  // Then, where the region is behind: recovers it at the committed state u, whose loads are `target`, at that load factor
  // of the stage, which started with the unknowns `start`.
  void catch_up(const Eigen::VectorXd& target, double share, const Eigen::VectorXd& start, Eigen::VectorXd& u);
  // The committed state as if it were recovered: the motion that condensed dofs still lack, and internal forces.  A copy:
  // it changes nothing in the run.  After the commit of the step in hand.
  void show_region(Eigen::VectorXd& motion, Eigen::VectorXd& forces);
  // Recovers the states of constant groups at the committed state plus that motion.
  void recover_states_at(const Eigen::VectorXd& motion);
  // Brings the states of constant groups up to date; those of others always are.  Before the first call, stress and strain
  // of constant groups may not be allocated.
  void recover_states() { deferred_.recover(groups_, element_, *work_, threads_); }
  // The same for structures alone.
  void recover_structures() { deferred_.recover_structures(groups_, element_, *work_); }

  const Eigen::VectorXd& internal_force() const { return internal_; }  // every dof
  // sqrt(sum over elements of |f_e|^2), of a field of unknowns: a scale that vanishes only in a stress-free mesh.
  double force_scale(int field) const { return force_scale_[static_cast<std::size_t>(field)]; }

  // States of all groups and what goes with them.  before_step: those of active groups as they were before the
  // last commit (reading gives them back as committed).
  void exchange(Archive& archive, bool before_step);

  std::vector<GroupData>& groups() { return groups_; }
  const std::vector<GroupData>& groups() const { return groups_; }
  std::array<long, kStatuses> count_points() const;  // committed states of active groups

 private:
  friend class IteratedStep;

  bool in_system(const GroupData& data) const { return data.active && !(condensation_ && data.constant); }
  void number_elements();
  bool constant_groups_change(const Activity& activity) const;
  void make_room_for_matrices(std::size_t group);
  Outcome evaluate_changing(const Eigen::VectorXd& du, Tangent* tangent);
  void add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to);
  Outcome evaluate_with_border(const Eigen::VectorXd& du, Tangent* tangent);
  void fill_in(Eigen::VectorXd& du, Eigen::VectorXd& forces);
  void take_constant_force();
  void commit_constant();
  void fill(Tangent& tangent) const;

  // What the step in hand has for the inner dofs of a condensed region.
  enum class RegionStep { open, filled_in, waits };

  const Model* model_;
  const Scene* scene_;
  Skips skips_;
  WorkCounters* work_;
  DofMap dof_map_;
  std::vector<GroupData> groups_;
  ElementWork element_;
  ChangingRegion changing_;
  int threads_ = 1;
  ConstantRegion constant_;
  DeferredStates deferred_;
  std::unique_ptr<Condensation> condensation_;
  RegionStep region_step_ = RegionStep::open;
  Equations equations_;
  bool wants_step_time_ = false, eases_ = false;
  int spread_stage_ = 0;  // that the groups have the loads along their elements of, from 1
  int elements_ = 0;      // of the system
  Eigen::VectorXd rate_, internal_;
  Eigen::VectorXd constant_force_;  // of a condensed region, at its last recovery
  Eigen::VectorXd motion_;          // work space
  FieldSums force_scale_{};
};

// Water flows in the step in hand: internal forces change with the time alone.
bool water_flows(const Assembly& assembly);
// K depends on nothing but the size of the step.
bool linear_in_step(const Assembly& assembly);

// One step of the stage and its iterations.  A condensed region acts by its interface dofs alone in it.
class IteratedStep {
 public:
  // target: loads at the step's end, every dof.  rate_part: its part of the prescribed displacements.  The
  // assembly must outlive it, and stay in its stage.
  IteratedStep(Assembly& assembly, const Eigen::VectorXd& target, double rate_part, const StageSoFar& so_far);

  // As Assembly::evaluate.
  Outcome iterate(const Eigen::VectorXd& du, Tangent* tangent);
  // Recovers du of condensed dofs as the last iterate() implies.  Forces and their scale are then those of all elements,
  // and the next iterate() counts from them.  Does nothing where no region is condensed.
  void complete(Eigen::VectorXd& du);
  // A region is condensed, and must be recovered at the end of the step.
  bool must_fill_in() const;
  // No step of the stage is complete: of a condensed region only the forces from before are known.
  bool begins_stage() const { return region_ != nullptr && region_->predictor().begins_stage(); }
  // Instead of complete(), where the interface dofs prove that the step is in equilibrium: the residual of the kept dofs is
  // at most `limit` times all forces, and its rounding is far below.  False: the region must be recovered.
  bool wait(const Eigen::VectorXd& du, double out_of_balance, double limit);
  // |correction| of all free dofs; correction: an equation each.
  double whole_norm(const Eigen::VectorXd& correction);

 private:
  Assembly* assembly_;
  Condensation* region_;  // nullptr = none is condensed
};

}  // namespace sage
