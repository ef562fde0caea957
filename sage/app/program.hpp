// The whole program as a function, for a main() with pieces of one's own (docs/manual/own_program.md).
#pragma once

#include <functional>

#include "sage/core/catalogue.hpp"

namespace sage {

using AddToCatalogue = std::function<void(Catalogue&)>;

// From the command line to an exit code (sage/app/exit_codes.hpp): every command of `sagefe`, with what `add`
// puts into the catalogue beside the elements, laws and solvers of the program.  Prints to the standard
// streams; ignores SIGXFSZ from then on, and hears SIGINT and SIGTERM while `run` computes.  Throws nothing.
int sagefe(int argc, char** argv, const AddToCatalogue& add = {});

}  // namespace sage
