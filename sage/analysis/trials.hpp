// A stage of a model that is tried with other laws again and again, from the last state in equilibrium: strength
// reduction.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/newton.hpp"
#include "sage/analysis/observer.hpp"

namespace sage {

// The result of a trial.
struct TrialResult {
  bool equilibrium = false;
  // Of the last attempt.
  StepOutcome outcome = StepOutcome::not_converged;
  StepReport
      report;  // load_factor: share of what the new laws no longer carry that was released in equilibrium
  std::string reason;      // without equilibrium: a page for a person
  Eigen::VectorXd motion;  // since the start of the trial, every dof: at its end, or of the last attempt
  std::vector<std::vector<double>>
      strain;                       // the same of strain, of each group: law_size x points; empty = none
  std::vector<double> dissipation;  // without equilibrium: of the motion (dissipation.hpp)
};

class Trials {
 public:
  virtual ~Trials() = default;
  // Which stage of the model, from 0: without loads, in one increment.  Those before it are run first.
  virtual int stage() const = 0;
  // Puts the next laws into the model of the run; false = enough.  last: nullptr before the first trial.  now: the
  // last state in equilibrium, from which the next one starts; it is gone when the call returns.
  virtual bool next(const TrialResult* last, const Solution& now) = 0;
  // The trial is given up when 2^-max_cuts of it finds no equilibrium, after three times the iterations of its stage,
  // and at once where it flows.
  virtual int max_cuts() const = 0;
  // A failure must be proved by motion, or be found to be none (Relaxation).
  virtual bool proves() const { return false; }
  // A failure of the stages before the trials leads to weaker laws, whatever its reason is: it is not worth much work.
  virtual bool descends() const { return false; }
  // A stage before the trials found no equilibrium.  u: where its last attempt went, every dof; dissipation: of the motion
  // of that attempt (dissipation.hpp).
  virtual void lost(const Eigen::VectorXd& /*u*/, std::vector<double> /*dissipation*/) {}
};

}  // namespace sage
