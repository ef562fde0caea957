// Model files beside the answers of a study.
#pragma once

#include <filesystem>

#include "sage/builder/model_input.hpp"

namespace sage::app {

// Throws OutputError.
void write_study_model(const ModelInput& input, const std::filesystem::path& path, const Catalogue& catalogue);

}  // namespace sage::app
