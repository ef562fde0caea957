// A stage of the program's own between those of the deck: trials of strength, earthquakes.
#pragma once

#include "sage/model/model.hpp"

namespace sage::safety {

// The stage (from 0) whose ground is asked about: the chosen one, or where that is negative the deck's last.
int chosen_stage(const Model& model, int stage);

// Puts a stage behind stage `last` (from 0).  Water cards and laws of later stages stay theirs.  Returns its index.
int insert_behind(Model& model, int last, Stage stage);

}  // namespace sage::safety
