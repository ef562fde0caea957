// How far the stress path of a step may be from that of shorter ones.
#pragma once

#include <vector>

#include "sage/analysis/group_data.hpp"

namespace sage {

// Law::path_error of the trial states, the mean over all points by the work of their stress increments.
// group_linear: a flag a group; their laws have no such error, whether they are asked (skips) or not.
double mean_path_error(const std::vector<GroupData>& groups, const std::vector<char>& group_linear);

}  // namespace sage
