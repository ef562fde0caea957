// The model of a run as words and texts, so that its result file can be shown later.
#pragma once

#include "sage/app/input.hpp"
#include "sage/record/result_file.hpp"

namespace sage::app {

// Hands on what it is asked for, and keeps it for RunSource::heads.
HeadReader keeping_heads(HeadReader heads, std::string& kept);

// deck: its characters; layout: the one that read it, asked_layout: as the command line names it.
RunSource source_of(const std::string& deck, const std::string& layout, const std::string& asked_layout,
                    const BuildOptions& build);

// The model of such a source.  Throws InputError as reading and building do.
Model model_of(const RunSource& source, const std::string& deck_name, const Catalogue& catalogue);

}  // namespace sage::app
