// What the points that are at their strength dissipate in a step.
#pragma once

#include <vector>

#include "sage/analysis/run_parts.hpp"

namespace sage {

// Of each group of the model: sum of w sigma . deps over its points at strength, in the step du (every dof) from the
// committed state; force x length for each unit of width, or of the full circle.  deps contains what little of the step is
// elastic.  Empty: a law has no answer for the step.  The step in hand is lost.
std::vector<double> dissipation(const RunParts& run, const Eigen::VectorXd& du);

}  // namespace sage
