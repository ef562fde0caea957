// A stage that is tried with other laws again and again, each time from the last state in equilibrium (trials.hpp).
#pragma once

#include <vector>

#include "sage/analysis/stage_start.hpp"
#include "sage/analysis/step_control.hpp"
#include "sage/analysis/trials.hpp"

namespace sage {

class TrialRun {
 public:
  // All must outlive it.
  TrialRun(const RunParts& run, StageStart& start, StepControl& control)
      : run_(run), start_(start), control_(control) {}

  // Until Trials::next says that it is enough.  The stages before have been run.
  void run();

 private:
  enum class Side { committed, trial };

  TrialResult try_stage();
  void run_stage(TrialResult& trial);
  void fail(TrialResult& trial);
  void take_motion(const Eigen::VectorXd& u, Side side, TrialResult& trial) const;

  const RunParts& run_;
  StageStart& start_;
  StepControl& control_;
  Eigen::VectorXd start_u_;                        // where the trial began
  std::vector<std::vector<double>> start_strain_;  // likewise
};

}  // namespace sage
