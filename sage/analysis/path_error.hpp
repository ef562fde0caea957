// How far the stress path of a step may be from that of shorter ones.
#pragma once

#include <vector>

#include "sage/analysis/step_time.hpp"

namespace sage {

// PathError of the trial states, the mean over all points by the work of their stress increments.
// group_linear: one flag per group; their laws have no such error, whether they are evaluated (skips) or not.  moment: of
// the step.
double mean_path_error(const Mesh& mesh, const std::vector<GroupData>& groups,
                       const std::vector<char>& group_linear, const StepTime& step_time);

}  // namespace sage
