// Passes over the elements: internal forces, element matrices into the tangent, states of all points.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "sage/analysis/element_work.hpp"
#include "sage/analysis/eliminated_dofs.hpp"
#include "sage/analysis/iterated_step.hpp"
#include "sage/analysis/recovery.hpp"
#include "sage/analysis/skips.hpp"
#include "sage/analysis/stage_groups.hpp"

namespace sage {

// Makes a solver for so many equations that factorises once; symmetric: the matrix is.
using SolverMaker = std::function<std::unique_ptr<LinearSolver>(int equations, bool symmetric)>;

// Every pass evaluates all active elements, one after the other.  Classes that leave out some of that derive from it
// (skips/).
class Assembly : public StageGroups, public Recovery {
 public:
  // Model, scene and counters must outlive it.
  Assembly(const Model& model, const Scene& scene, WorkCounters& work, const Prepare& prepare = {});

  // The time and load factor of the evaluations that follow: needed only where a law depends on them, or an element on the
  // loads along it.
  bool wants_step_time() const { return wants_step_time_; }
  // Water flows by a law that is eased (PointContext::easing).
  bool eases() const { return eases_; }
  void set_step_time(const StepTime& step_time);
  const StepTime& step_time() const { return element_.step_time(); }
  // The loads that elements see at the end of the stage in hand have changed: they grow there from what acts at this load
  // factor, below 1.
  void take_element_loads(double load_factor);
  const Mesh& mesh() const { return model_->mesh; }

  // Passes over the elements call it now and then and throw Stopped.
  void set_stop(StopAsked asked) { element_.set_stop(std::move(asked)); }
  // Passes over many elements may use so many threads.  Results do not depend on it.
  virtual void set_threads(int threads) { threads_ = threads; }
  int threads() const { return threads_; }
  // Committed unknowns, for elements that see them; they must stay where they are.
  void set_committed(const Eigen::VectorXd& u) { element_.set_committed(&u); }

  using StageGroups::enter_stage;
  // The same for all of a stage of so many increments: dofs may be eliminated, with a solver of that maker.
  virtual void enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int /*increments*/,
                           const SolverMaker& /*make*/) {
    enter_stage(activity, rate);
  }
  // Of the stage in hand; by default none are.
  virtual const EliminatedDofs& eliminated() const;
  // Loads that the stage adds, every dof.  Needed before its first step, and only where dofs are eliminated.
  virtual void set_stage_loads(const Eigen::VectorXd& /*loads*/) {}
  // Factors of a K that cannot change serve as long as it stands.
  virtual bool keeps_factors() const { return false; }

  // Internal forces at committed state + du.  With a tangent, K too.
  virtual Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent);
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

  // Every dof; less what the motion adds to loads on edges.
  const Eigen::VectorXd& internal_force() const { return internal_; }
  // That addition, of the last pass; size 0 where no load follows the motion.
  const Eigen::VectorXd& load_change() const { return element_.load_change(); }
  // sqrt(sum over elements of |f_e|^2), of a field of unknowns: a scale that vanishes only in a stress-free mesh.
  double force_scale(int field) const { return force_scale_[field]; }

 protected:
  WorkCounters* work_;
  ElementWork element_;
  Eigen::VectorXd internal_;
  FieldSums force_scale_{};

 private:
  Outcome evaluate_group(GroupData& data, const Eigen::VectorXd& du, Tangent* tangent, FieldSums& sums);

  Eigen::VectorXd forces_;  // of the pass in hand
  int threads_ = 1;
  bool wants_step_time_ = false, eases_ = false;
  int loads_stage_ = 0;  // whose loads the groups have, from 1
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
