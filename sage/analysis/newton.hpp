// One step of the nonlinear equilibrium: find du with  F - f(u0 + du) = 0  on the free equations.
#pragma once

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/iteration_policy.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

// Where the iterations of a step begin.
enum class NewtonStart {
  committed,  // at the state before the step, with the tangent at hand
  nearby,     // du is near the answer, except for what supports prescribe
};

class ControlledLoad;

struct NewtonSettings {
  Method method = Method::newton;
  int max_iterations = 25;
  double tolerance = 1e-8;  // force and energy; displacement sqrt(tolerance)
  bool line_search = true;
  const Eigen::VectorXd* committed = nullptr;  // unknowns at the start of the step, every dof; null = zero
  StageSoFar so_far{};                         // from which eliminated dofs are extrapolated
  Pulse* pulse = nullptr;                      // receives every iteration; null = none does
  bool stop_at_flow = false;                   // gives up a step that turns into flow (NewtonStep::flows)
  NewtonStart start = NewtonStart::committed;
  IterationPolicy* policy = nullptr;  // null = the plain one
  bool refine = false;                // a first correction is not enough, even if it leaves only rounding
  // Every correction is held back by a share of the elastic stiffness (ElasticMatrices), which falls with the
  // residual: for steps that Newton's corrections find no end of.  The largest part of the share that a correction
  // leaves to the next one; 0 = no damping.
  double damping_fall = 0.0;
  const std::vector<char>* of_solids = nullptr;  // by dof: a solid has it; damped alone
  ControlledLoad* control = nullptr;  // the load is an unknown (load_control.hpp); null = it is given
  // Of the model: its unknowns, and its size, the longest arm that a force has; null: moments have no measure in forces.
  const std::vector<UnknownField>* unknowns = nullptr;
  double size = 0.0;
};

enum class StepOutcome { converged, not_converged, law_cut, singular };

struct NewtonStep {
  StepOutcome outcome = StepOutcome::not_converged;
  bool crept = false;     // its larger part has been committed before (StepControl::creep, relax)
  bool finished = false;  // a kept tangent was replaced by the consistent one at the end
  bool flows =
      false;  // stop_at_flow: corrections only increase the residual, beyond a good part of all stress; damped: Creep::flows
  bool moved = false;          // `flows` by motion (StepReport::proved)
  bool spares_ground = false;  // damped, not converged: Creep::spares_ground
  std::vector<IterationRecord> iterations;
  WorstDof worst;               // of the last iteration, or where none converged, of the best
  double predicted_work = 0.0;  // residual at the start times the first correction
  // Relative residual at the end, of the fields that have more to balance than rounding: moments that are zero have not.
  double force_left = 0.0;
  int singular_equation = -1;
  std::string message;
};

// target: external force at the end of the step, every dof.  rate_part: part of the stage's prescribed
// displacement in this step.  du: in, size of all dofs; out, the increment found.
NewtonStep newton_step(Assembly& assembly, Tangent& tangent, const Eigen::VectorXd& target,
                       const Eigen::VectorXd& rate, double rate_part, const NewtonSettings& settings,
                       WorkCounters& work, Eigen::VectorXd& du);

}  // namespace sage
