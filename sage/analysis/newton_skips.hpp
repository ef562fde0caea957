// What the skips 'repeats' and 'prediction' change in a step (skips.hpp).
#pragma once

#include "sage/analysis/step_iteration.hpp"

namespace sage {

// The skip 'repeats': the step before once more, if it leaves next to nothing unbalanced.  It costs one force pass.  False:
// it does not; the step is to be solved.
bool repeat_step(StepIteration& step);

// The skip 'prediction', for steps that start in the direction of the last one (NewtonStart::last_way):
// The next correction will be the last: K at this place would serve no correction.
bool ends_with_next_correction(const StepIteration& step);
// The direction leads nowhere: the residual does not become ten times smaller in five corrections.
bool strays(const StepIteration& step);
// One more correction for a step that ends just within the tolerance.
void polish(StepIteration& step);

}  // namespace sage
