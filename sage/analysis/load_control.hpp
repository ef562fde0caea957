// Indirect displacement control: within a step the share of the stage's loads is an unknown beside the displacements, and the
// growth of one displacement, or of a difference of two, is given (docs/theory/analysis.md).
#pragma once

#include <array>

#include <Eigen/Core>

#include "sage/analysis/run_parts.hpp"

namespace sage {

struct StepIteration;

// A displacement and its factor in the one that controls the load; dof -1 = there is none.
struct ControlTerm {
  int dof = -1;
  double factor = 0.0;
};

// The displacement that controls the load, at the committed state.
double controlled_displacement(const RunParts& run);

class ControlledLoad {
 public:
  // Of a step to this share of the stage's displacement.  target: loads that the step begins with, every dof; corrections change
  // them.  `run` and target must outlive it.  Throws AnalysisError (S582) where the displacement is not free.
  ControlledLoad(const RunParts& run, double to, Eigen::VectorXd& target);

  // The step has K^-1 residual as its correction: adds to it, and to its residual and loads, what the change of the load adds.
  void correct(StepIteration& step);
  // Of the load share since the start of the step.
  double change() const { return change_; }

 private:
  const Assembly& assembly_;
  Eigen::VectorXd& target_;
  Eigen::VectorXd direction_;      // loads of the whole stage, every dof
  Eigen::VectorXd load_, motion_;  // of equations: the same, and the displacement that it causes
  std::array<ControlTerm, 2> terms_;
  double goal_ = 0.0;  // growth of the displacement in the step
  double change_ = 0.0;
};

// The load falls so far within a step to this share of the loads that the step may have left the path of equilibria: behind
// a snap-back others are found, further on.
bool drops_off(const RunParts& run, double share);

// The end of a run in a stage whose controlled displacement can't grow any more.
std::string explain_controlled(const RunParts& run, const StepReport& report, const NewtonStep& step);

// Throws InputError (S583): strengths are not reduced where the load is an unknown.
void refuse_controlled_trials(const Model& model);

}  // namespace sage
