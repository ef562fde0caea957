// What the points that are at their strength dissipate in a step.
#pragma once

#include <vector>

#include "sage/analysis/run_parts.hpp"

namespace sage {

// Of each group of the model: sum of w sigma . deps over the points that the step du (every dof, from the committed state)
// brings to their strength; force x length for each unit of width, or of the full circle.  sigma: in structures that of the
// step.  In ground and joints the committed one, whose work over the whole motion is that of the loads: the step of a
// failed attempt is long, and in ground that has dilated and come back its own stresses mean nothing.  Where the motion
// has so much else in it that nothing positive is left, that of the step all the same.  deps contains what little of the
// step is elastic.  Empty: a law has no answer for the step, which is lost either way.
std::vector<double> dissipation(const RunParts& run, const Eigen::VectorXd& du);

}  // namespace sage
