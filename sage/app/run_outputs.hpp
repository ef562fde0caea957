// What a run writes besides its record: as asked for.
#pragma once

#include "sage/app/run_deck.hpp"
#include "sage/app/run_source.hpp"
#include "sage/record/output.hpp"

namespace sage::app {

using Outputs = std::vector<std::unique_ptr<Output>>;

int csv_digits(const OutputOptions& options);

// All but the reports, which the listing shows.
Outputs make_outputs(const RunRequest& request, const Catalogue& catalogue, const Reports& reports,
                     const RunSource& source, const Model& model);

std::vector<std::filesystem::path> files_of(const Reports& reports, const Outputs& outputs);

// The files of a run that did not come to its end say why.
void stop(const Outputs& outputs, Reports& reports, const std::string& reason);

}  // namespace sage::app
