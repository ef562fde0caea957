// Sweeps from Python.
#pragma once

#include <string>
#include <vector>

#include "sage/python/python_catalogue.hpp"

namespace sage::python {

// All cases of a study; the text of its table, which is written to the folder as well.  jobs: cases at a time, 0 = one for each
// processor.  module: the file of the extension module, which tells programs apart.  Throws what Ctrl-C has raised.
std::string run_sweep(const std::string& study, const std::string& folder, int jobs,
                      const std::vector<std::string>& collect, const std::string& module);

}  // namespace sage::python
