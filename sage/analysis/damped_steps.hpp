// Steps that Newton's method does not find, with damped corrections (NewtonSettings::damping_fall).
#pragma once

#include <vector>

#include "sage/analysis/stepper.hpp"

namespace sage {

class DampedSteps {
 public:
  // Both must outlive it.
  DampedSteps(const RunParts& run, Stepper& stepper) : run_(run), stepper_(stepper) {}

  void open_stage();
  // The increments that follow are trials, which a factor beyond the last one that stands has not to prove.
  void begin_trial() { is_trial_ = true; }

  bool has_walls() const { return has_walls_; }                      // interfaces or structures
  const std::vector<char>& of_solids() const { return of_solids_; }  // by dof: some solid of the stage has it
  bool descends() const;  // Trials::descends, outside of trial increments
  bool proves() const;    // Trials::proves

  // Newton's step in hand has not converged if it throws ground of a trial with walls out of the model.
  void doubt(NewtonStep& step) const;
  // Whether steps of that length are tried with damping: the shortest ones, and those of trials that rely on it.
  bool due(bool last_cut) const;
  // Whether this one, which failed, can be.  on_last_way: it started with the tangent in the middle of the last step.
  bool suits(const NewtonStep& step, bool on_last_way) const;
  // failed: Newton's attempt at the same step.
  NewtonStep attempt(StepReport& report, double from, double to, const NewtonStep& failed);

 private:
  bool is_far(const NewtonStep& step, double far) const;
  void judge_motion(NewtonStep& step) const;
  NewtonStep creep(StepReport& report, double to, double damping_fall, const NewtonStep& shaken);

  const RunParts& run_;
  Stepper& stepper_;
  std::vector<char> of_solids_;
  Eigen::VectorXd stage_u_;  // at the start of the stage
  bool has_walls_ = false, is_trial_ = false;
};

}  // namespace sage
