// How stiff the model still is along its motion (Bergan's current stiffness): it falls to nothing at a limit load.
#pragma once

#include "sage/analysis/run_parts.hpp"

namespace sage {

class CurrentStiffness {
 public:
  // `run` must outlive it.
  explicit CurrentStiffness(const RunParts& run) : run_(run) {}

  // Internal forces at the committed state; not needed in linear scenes.
  void set_committed(const Eigen::VectorXd& force) { committed_force_ = force; }

  // Of the converged step in hand, of that size: where supports move, the growth of their forces along their own motion;
  // else the growth of the loads over the motion along them.  Kept in StagePath.
  void measure(double size);
  // After a failed attempt, as a share of the largest of the stage: that of the last step, and under loads that of the
  // attempt where it ran away.  Before any step the attempt's first correction, which is elastic, counts as the largest.
  // Negative: not known.
  double share(double size, const NewtonStep& step) const;

 private:
  double load_work() const;

  const RunParts& run_;
  Eigen::VectorXd committed_force_;
};

}  // namespace sage
