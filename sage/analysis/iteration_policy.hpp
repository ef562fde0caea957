// What may be decided otherwise within a step (newton.cpp): where its iterations begin, when K is made, when they end.
#pragma once

#include <Eigen/Core>

namespace sage {

struct StepIteration;

// The plain decisions.  Others derive from it and pass on what they do not change.
class IterationPolicy {
 public:
  enum class Pass { correction, line_search };  // what a pass over the elements follows

  virtual ~IterationPolicy() = default;

  // Finds the first correction and moves by it.  False: the step ends here with its result.
  virtual bool begin(StepIteration& step, const Eigen::VectorXd& rate);
  // Whether the next pass makes K together with the forces.
  virtual bool makes_K(const StepIteration& step, Pass pass) const;
  // Whether the next correction needs K of this iterate, which no pass has made.  Residuals: here and one correction ago.
  virtual bool needs_K(const StepIteration& step, double norm, double old_norm) const;
  // Further iterations are not worth while.
  virtual bool gives_up(const StepIteration& step) const;
  // The step has converged with the tangent of its method.
  virtual void end(StepIteration& step);
};

}  // namespace sage
