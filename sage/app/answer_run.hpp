// What the answers of --json say of models and runs.
#pragma once

#include <filesystem>

#include "sage/analysis/scene.hpp"
#include "sage/app/answer.hpp"
#include "sage/app/run_deck.hpp"

namespace sage::app {

// Title, geometry, units, counts, and what the scene needs.
Json model_json(const Model& model, const Scene& scene);
// "completed", "not_converged", "singular", "failed" or "stopped".
const char* status_word(RunStatus status);
// Everything that the summary shows; numbers are those of the reports, compression positive as there.
Json outcome_json(const RunOutcome& outcome);
Json reports_json(const Model& model, const Reports& reports);
Json files_json(const std::vector<std::filesystem::path>& files);

}  // namespace sage::app
