#include "sage/analysis/free_surface_search.hpp"

#include <algorithm>
#include <cmath>

#include "sage/analysis/explain.hpp"

namespace sage {

NewtonStep FreeSurfaceSearch::attempt(double from, double to) {
  const bool eased = run_.assembly().eases();
  if (!run_.system.exits().any() && !eased) return stepper_.attempt(from, to, Stepper::Begin::committed);
  run_.state.path.policy->forget(SteppingPolicy::Past::last_step);
  if (run_.system.exits().any()) run_.system.start_exits(run_.state.u, to - from);
  return eased ? settle_surface(from, to) : settle_exits(from, to, false);
}

// Some rounds find the places where water leaves; places that are switched to and fro end the run.
NewtonStep FreeSurfaceSearch::settle_exits(double from, double to, bool from_here) {
  constexpr int kMostRounds = 50;
  RunState& state = run_.state;
  System& system = run_.system;
  std::vector<IterationRecord> iterations;  // of a free surface, all
  for (int round = 0; round < kMostRounds; ++round) {
    NewtonStep step = stepper_.attempt(from, to, from_here ? Stepper::Begin::here : Stepper::Begin::committed);
    if (run_.assembly().eases()) {
      iterations.insert(iterations.end(), step.iterations.begin(), step.iterations.end());
      step.iterations = iterations;
      from_here = true;
    }
    if (step.outcome != StepOutcome::converged) return step;
    if (!system.exits().any() || !system.switch_exits(state.u, state.du, state.target, to - from)) return step;
  }
  throw AnalysisError("S529",
                      chattering_exits(run_.model, run_.stage(), system.exits().switched(), kMostRounds));
}

// The surface is found from far to near: first the soil falls dry over a height many times the true one, then each answer
// starts the next, sharper search.  An answer that is not found is reached in smaller steps.
NewtonStep FreeSurfaceSearch::settle_surface(double from, double to) {
  constexpr double kWidest = 64.0, kSharper = 4.0, kLeast = 1.02;
  double& easing = run_.state.easing;
  struct Restore {
    double& easing;
    ~Restore() { easing = 1.0; }
  } const restore{easing};
  std::vector<IterationRecord> iterations;
  Eigen::VectorXd found;
  double wide = 0.0;  // of the answer in `found`
  double ratio = kSharper;
  for (easing = kWidest;;) {
    NewtonStep step = settle_exits(from, to, found.size() > 0);
    iterations.insert(iterations.end(), step.iterations.begin(), step.iterations.end());
    if (step.outcome == StepOutcome::converged) {
      if (easing <= 1.0) {
        step.iterations = iterations;
        return step;
      }
      if (found.size() > 0 && wide / easing >= 0.99 * ratio) ratio = std::min(kSharper, ratio * ratio);
      wide = easing;
      found = run_.state.du;
    } else {
      ratio = std::sqrt(ratio);
      if (found.size() == 0 || ratio < kLeast) {
        if (flow_alone_) throw AnalysisError("S539", lost_free_surface(run_.stage(), easing, wide));
        step.iterations = iterations;
        return step;
      }
      run_.state.du = found;
    }
    easing = wide / ratio < 1.001 ? 1.0 : wide / ratio;
  }
}

}  // namespace sage
