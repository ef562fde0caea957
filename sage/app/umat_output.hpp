// What user materials print and do, beside a run's results.
#pragma once

#include <functional>
#include <string>

#include "sage/app/run_deck.hpp"

namespace sage::app {

// Does `work`.  Where UMATs are loaded, what they print meanwhile goes to STEM.umat.log, its first 256 KiB, and
// what is to be said of them to standard error.
void with_umat_output(const RunRequest& request, const std::function<void()>& work);

// The same for commands without files of a run: what is printed goes to standard error at the end, its first 8 KiB.
// who: for messages.
void with_umat_output(const std::string& who, const std::function<void()>& work);

}  // namespace sage::app
