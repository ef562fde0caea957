// Runs a deck in memory with everything the program has.
#pragma once

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::test {

using namespace sage::scenes;

WholeRun run_text(const std::string& deck, const BuildOptions& options = {}, const RunSettings& settings = {});

}  // namespace sage::test
