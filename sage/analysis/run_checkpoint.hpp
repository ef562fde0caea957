// The bytes from which a run goes on to the same results, bit for bit.
#pragma once

#include "sage/analysis/run_parts.hpp"

namespace sage {

// After an increment (place.increment > 0), or between two stages.
std::string checkpoint_bytes(const RunParts& run, RunPlace place);

// To the state of a checkpoint, and on_start.  Throws InputError where the bytes are not those of this model.
RunPlace resume_from(const RunParts& run, const std::string& bytes);

}  // namespace sage
