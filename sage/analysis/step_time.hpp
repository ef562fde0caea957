// The time and load factor of an evaluation, and what laws that depend on them receive.
#pragma once

#include "sage/analysis/group_data.hpp"

namespace sage {

// As in PointContext.
struct StepTime {
  int stage = 1, increment = 0;
  double time = 0.0, dt = 0.0, stage_start = 0.0;
  double easing = 1.0;
  double load_factor = 0.0, share = 0.0;  // of the stage: at the end of the step, and what the step takes of it
  double flow_dt = 0.0, theta = 1.0;      // as in ElementIn
};

// At a load factor of a stage (0-based), at the end of a step of that share of the stage (0: a state at rest).
StepTime step_time_at(const Model& model, int stage, int increment, double load_factor, double share,
                      double easing = 1.0);

// x: coordinates of the element's nodes.
PointContext context_of(const GroupData& data, int element, const Eigen::Matrix2Xd& x, int point,
                        const StepTime& step_time);

}  // namespace sage
