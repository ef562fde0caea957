// The first step of a run: its deck as a model, and what the outputs need to know of it.
#pragma once

#include "sage/app/result_files.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/run_source.hpp"

namespace sage::app {

// The deck as a model; its checksum becomes the owner's, and names of fields' components those of the fields.
// source: for the result file, where there will be one.  Throws InputError and UsageError.
std::unique_ptr<Model> read_model(RunRequest& request, const Catalogue& catalogue, ResultOwner& owner,
                                  RunSource& source, Profile& profile);

}  // namespace sage::app
