// One step of a stage as its iterations evaluate it.
#pragma once

#include <Eigen/Core>

#include "sage/analysis/records.hpp"
#include "sage/core/law.hpp"

namespace sage {

class Assembly;
class Tangent;
struct StepIteration;

// How far a stage has come: load factor, and unknowns of every dof at its start and now, those of eliminated dofs where they
// were recovered last.
struct StageSoFar {
  double share = 0.0;
  const Eigen::VectorXd *start = nullptr, *now = nullptr;
};

class IteratedStep {
 public:
  explicit IteratedStep(Assembly& assembly) : assembly_(&assembly) {}
  virtual ~IteratedStep() = default;

  // As Assembly::evaluate.
  virtual Outcome iterate(const Eigen::VectorXd& du, Tangent* tangent);
  // Measures the iterate for the test of convergence.
  virtual IterationRecord measure(StepIteration& step);

 protected:
  Assembly* assembly_;
};

}  // namespace sage
