// Runs a deck in memory with everything the program has.
#pragma once

#include "sage/study/deck_writer.hpp"
#include "sage/study/specimen_deck.hpp"
#include "sage/study/whole_run.hpp"

namespace sage::test {

using namespace sage::study;

WholeRun run_text(const std::string& deck, const BuildOptions& options = {}, const RunSettings& settings = {});

}  // namespace sage::test
