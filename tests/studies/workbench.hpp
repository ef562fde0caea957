// To run decks that tests and studies write themselves, with all pieces of the program.
#pragma once

#include "sage/app/commands.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::app {

scenes::Workbench make_workbench(const Catalogue& catalogue = full_catalogue());

}  // namespace sage::app
