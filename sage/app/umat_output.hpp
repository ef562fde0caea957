// What user materials print and do, beside a run's results.
#pragma once

#include <functional>

#include "sage/app/run_deck.hpp"

namespace sage::app {

// Does `work`.  Where UMATs are loaded, what they print meanwhile goes to STEM.umat.log, its first 256 KiB, and
// what is to be said of them to standard error.
void with_umat_output(const RunRequest& request, const std::function<void()>& work);

}  // namespace sage::app
