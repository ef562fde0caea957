// Which run a checkpoint belongs to.
#pragma once

#include <string>

#include "sage/app/run_deck.hpp"

namespace sage::app {

// A text that differs wherever results or output files of the two requests may: every option counts but those that
// run_key.cpp names as unable to change them.  The deck's meaning is the model's fingerprint, which is not in it.
std::string options_key(const RunRequest& request);

}  // namespace sage::app
