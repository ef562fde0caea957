// The bytes from which a run goes on to the same results, bit for bit.
#pragma once

#include "sage/analysis/audience.hpp"
#include "sage/analysis/run_state.hpp"
#include "sage/analysis/system.hpp"

namespace sage {

// Everything that a checkpoint holds beside what the observers have gathered.
struct Resumable {
  const Model& model;
  System& system;
  RunState& state;
  RunResult& result;
  Audience& audience;
};

// After an increment (place.increment > 0), or between two stages.
std::string checkpoint_bytes(const Resumable& run, RunPlace place);

// To the state of a checkpoint, and on_start.  Throws InputError where the bytes are not those of this model.
RunPlace resume_from(const Resumable& run, const std::string& bytes);

}  // namespace sage
