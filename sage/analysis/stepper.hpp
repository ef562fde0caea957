// One attempt at a step: a part of the stage's loads, solved for with the method and tolerance of the stage.
#pragma once

#include <vector>

#include "sage/analysis/run_parts.hpp"

namespace sage {

class Stepper {
 public:
  // `run` must outlive it.
  explicit Stepper(const RunParts& run) : run_(run), flow_alone_(is_flow_alone(run.model)) {}

  enum class Begin {
    committed,  // at the committed state, unless the policy of the path says otherwise
    here,       // RunState::du is near the answer, except for what supports prescribe
  };
  // Whether Newton's method takes the next attempt, whatever the method of its stage is.
  enum class Newton { by_stage, finer, yes };  // finer: to a hundredth of the stage's tolerance
  // Damped corrections (NewtonSettings::damping_fall).
  struct Damping {
    double fall = 0.0;
    const std::vector<char>* of_solids = nullptr;
  };

  // From one load factor of the stage in hand to another; RunState::du becomes the step.
  NewtonStep attempt(double from, double to, Begin begin);
  NewtonStep attempt_damped(double from, double to, const Damping& damping);
  // A few corrections of Newton's method from a committed state near equilibrium at that load factor.
  NewtonStep attempt_near(double at);

  // Load share at the end of the last attempt, of a stage whose load is controlled.
  double load_share() const { return load_share_; }

  Newton newton() const { return newton_; }
  void set_newton(Newton newton) { newton_ = newton; }

 private:
  NewtonSettings settings() const;
  NewtonStep solve(double from, double to, const NewtonSettings& settings);
  NewtonStep solve_controlled(double from, double to, const NewtonSettings& settings);

  const RunParts& run_;
  bool flow_alone_;
  double load_share_ = 0.0;
  Newton newton_ = Newton::by_stage;
};

}  // namespace sage
