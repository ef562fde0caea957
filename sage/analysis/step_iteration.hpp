// What all methods of newton_step() work with: the iterate of one step, and the operations that lead to the next one.
#pragma once

#include <limits>

#include "sage/analysis/step_measures.hpp"

namespace sage {

// Vectors have one entry per equation, du and target one per dof.  References must outlive it.
struct StepIteration {
  StepIteration(Assembly& assembly_of_step, Tangent& tangent_of_step, const Eigen::VectorXd& target_of_step,
                double part, const NewtonSettings& settings_of_step, WorkCounters& counters,
                Eigen::VectorXd& step);

  // Forces and residual at du; with_K: the tangent, too.  cut_step: a law has no answer there.
  Outcome assemble(bool with_K);
  // The tangent at du, where the last pass did not make it.
  Outcome form_tangent();
  void form_residual();
  // correction = K^-1 residual.
  void solve();
  // du moves by this factor times the correction.
  void move(double factor);
  // du moves by the correction, whose work counts for the energy measure.
  void advance();
  // Records the iteration; true once the step is in equilibrium.
  bool converged();

  // First correction, from where the iterations begin.  False: a law has no answer there.
  bool predict(const Eigen::VectorXd& rate);
  // Of du: all that has no equation.
  void take_prescribed(const Eigen::VectorXd& rate);
  Eigen::VectorXd free_part_of_du() const;
  IterationRecord measure() { return measures.measure(correction, residual, step_length); }
  bool is_in_equilibrium(const IterationRecord& record) const {
    return criterion.is_met(measures.measured(), record, result.iterations, measures);
  }
  double residual_size() const { return measures.size_of(residual); }
  double work_left() const { return measures.work_left(correction, residual); }
  bool is_hopeless() const { return measures.is_hopeless(residual); }

  // Newton's method with a tangent that changes.
  bool full_newton() const {
    return (settings.method == Method::newton || settings.method == Method::dogleg) && !tangent.constant();
  }
  // Modified Newton and initial stiffness, accelerated.
  bool accelerated() const { return !full_newton() && !tangent.linear(); }

  Assembly& assembly;
  Tangent& tangent;
  const Eigen::VectorXd& target;
  const NewtonSettings& settings;
  WorkCounters& work;
  Eigen::VectorXd& du;
  std::unique_ptr<IteratedStep> pass;
  IterationPolicy plain_policy;
  IterationPolicy& policy;  // the plain one, or that of the settings
  double rate_part;         // of the stage's prescribed displacements
  StepMeasures measures;
  ConvergenceCriterion criterion;

  Eigen::VectorXd residual, correction;
  Eigen::VectorXd start_residual;  // that at du = 0, if it is known
  bool start_known = false;
  bool K_is_here = false;  // the last pass made it
  double slope = 0.0;      // correction . residual before the last move
  double step_length = 1.0;
  double best = std::numeric_limits<double>::infinity();  // smallest residual_size() so far
  double damping = 1.0;                                   // share of the elastic stiffness
  NewtonStep result;

 private:
  bool start_from_committed();
  bool start_from_du(const Eigen::VectorXd& rate);
};

// Methods other than newton.cpp's own.  Each starts behind the first correction, and leaves its answer in `result`.
void iterate_with_dogleg(StepIteration& step);
void iterate_damped(StepIteration& step);
// With a tangent that was kept the step is in equilibrium; the consistent tangent takes the rest.
void finish_with_newton(StepIteration& step);

}  // namespace sage
