// The multifrontal solver of frontal.hpp where repeated fronts are eliminated and stored once.
#pragma once

#include "sage/core/catalogue.hpp"

namespace sage {

// For SolverEntry::make_with_repeats: empty in a program without skips (no_repeated_fronts.cpp).
SolverFactory frontal_with_repeats(bool symmetric);

}  // namespace sage
