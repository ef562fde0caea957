// One step of a stage in which a condensed region acts by its interface dofs alone.
#pragma once

#include "sage/analysis/skips/condensed_assembly.hpp"

namespace sage {

class CondensedStep final : public IteratedStep {
 public:
  // As Assembly::begin_step(); the assembly has a condensed region.
  CondensedStep(CondensedAssembly& assembly, const Eigen::VectorXd& target, double rate_part,
                const StageSoFar& so_far);

  Outcome iterate(const Eigen::VectorXd& du, Tangent* tangent) override;
  // Of the whole model where the interface dofs do not prove equilibrium.
  IterationRecord measure(StepIteration& step) override;
  // Of the whole model, as without condensation.
  IterationRecord measure_whole(StepIteration& step);
  // Recovers du of condensed dofs as the last iterate() implies.  Forces and their scale are then those of all elements,
  // and the next iterate() counts from them.
  void complete(Eigen::VectorXd& du);
  // Instead of complete(), where the interface dofs prove that the step is in equilibrium: the residual of the kept dofs is
  // at most `limit` times all forces, and its rounding is far below.  False: the region must be recovered.
  bool wait(const Eigen::VectorXd& du, double out_of_balance, double limit);

 private:
  bool must_fill_in() const;

  CondensedAssembly& all_;
  Condensation& region_;
};

}  // namespace sage
