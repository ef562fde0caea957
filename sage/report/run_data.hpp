// A run as the page's script reads it.
#pragma once

#include "sage/report/encode.hpp"
#include "sage/report/page.hpp"

namespace sage::report {

// Model: groups, materials, stages, supports, loads, water, mesh.
void add_model(const PageRun& run, Json& json);
// States: displacements, fields at points, forces at the ends of structures, as far as there is room beside what the page
// has already.  Gives what there was no room for.
std::vector<std::string> add_states(const PageRun& run, const PageOptions& options, Json& json);
// What lies beside the result file and in it: summary, tables, messages, pictures, deck.
std::vector<std::string> add_papers(const PageRun& run, Json& json);

// A table with its words, of the first rows.
Json table_of_cases(const std::filesystem::path& file, std::vector<std::string>& omitted);

}  // namespace sage::report
