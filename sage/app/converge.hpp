// sagefe run --converge: finer and finer meshes until what the deck's reports say is as certain as asked.
#pragma once

#include <string>
#include <vector>

#include "sage/app/run_deck.hpp"

namespace sage::app {

struct ConvergeOptions {
  double tolerance = 0.0;  // relative, of every reported quantity; 0 = not asked for
  int max_dofs = 400'000;
  double max_seconds = 120.0;       // a mesh that is in work then is left
  std::vector<std::string> follow;  // components of reports by name (component_names); empty = the main ones
};

// Prints a row a mesh and the result; writes STEM.convergence.csv and the reports of the best mesh.  Returns
// an exit code: kOk when reached, kNotConverged when a limit came first or a mesh found no equilibrium. Throws
// InputError (also for a deck without reports or with none of a name that is to be followed), OutputError.
int converge(const RunRequest& request, const ConvergeOptions& options, const Catalogue& catalogue);

}  // namespace sage::app
