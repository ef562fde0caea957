// From increment to increment: which steps are tried, in which way, and what becomes of those that fail.
#pragma once

#include <vector>

#include "sage/analysis/current_stiffness.hpp"
#include "sage/analysis/damped_steps.hpp"
#include "sage/analysis/free_surface_search.hpp"
#include "sage/analysis/pore_steps.hpp"
#include "sage/analysis/relaxation.hpp"
#include "sage/analysis/stepper.hpp"

namespace sage {

class StepControl {
 public:
  // `run` must outlive it.
  explicit StepControl(const RunParts& run);
  StepControl(const StepControl&) = delete;
  StepControl& operator=(const StepControl&) = delete;

  // StageStart has opened a stage.
  void open_stage();
  // A checkpoint within a stage has been read.
  void resume();
  // The loads at the end of the stage have changed: what is known of the steps so far no longer counts.
  void take_loads();
  // The increments that follow are trials: one is given up where a step of 2^-max_cuts of it finds no equilibrium, after
  // three times the iterations of its stage, and at once where the ground flows.
  void begin_trial(int max_cuts);

  // Takes the increment that `report` names, in parts where it must.  False: no equilibrium was found.  The step of the
  // last attempt is then still in hand (RunState::du), and failed() is how it ended.
  bool take_increment(StepReport& report);
  const NewtonStep& failed() const { return failed_; }
  // NewtonStep::force_left of the last step that converged.
  double force_left() const { return force_left_; }
  // The step in hand will not be committed: forces and unknowns of eliminated dofs become those of the committed state.
  void drop_step();

 private:
  bool advance(StepReport& report, double end, double whole);
  bool advance_by_error(StepReport& report, double end);
  bool record(StepReport& report, const NewtonStep& step, double size) const;
  void accept(StepReport& report, const NewtonStep& step, double to);
  bool fail(StepReport& report, const NewtonStep& step, double size);
  void reject(double next);
  bool tries_otherwise(const NewtonStep& step, bool went_on, double size);
  bool can_relax(const NewtonStep& step, bool last) const;
  bool relax(StepReport& report, double end);
  NewtonStep relax_step(Relaxation& relaxation, StepReport& report, double from, double& to);
  void move_to(double load_factor);
  void keep_step(double size);
  void start_on_last_way(double size);
  double refused_motion(double size, const NewtonStep& step) const;

  const RunParts& run_;
  Stepper stepper_;
  DampedSteps damped_;
  FreeSurfaceSearch search_;
  PoreSteps pore_steps_;
  CurrentStiffness stiffness_;
  NewtonStep failed_, relaxed_;
  double force_left_ = 0.0;
  Eigen::VectorXd last_du_;   // the last step of the stage, if StagePath::last_size > 0
  bool on_last_way_ = false;  // the next attempt starts with the tangent in the middle of that step
  bool is_trial_ = false;
  double refused_at_ = -1.0;  // load factor from which no motion came to rest
  int max_cuts_;
};

}  // namespace sage
