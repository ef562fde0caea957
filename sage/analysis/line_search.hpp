// Shortens the last move of a step where the full correction leads too far.
#pragma once

#include "sage/analysis/step_iteration.hpp"

namespace sage {

// After a full correction in iteration `iteration` (from 1; 1 = the first correction); old_norm: residual_size() before it.
// False: a law has no answer on the way.
bool search_line(StepIteration& step, int iteration, double old_norm);

// The zero of the slope correction . residual is sought by regula falsi within (0, 1), if the full correction keeps more
// than 0.8 of it.
bool search_zero_slope(StepIteration& step, double old_norm);

}  // namespace sage
