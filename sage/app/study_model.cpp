#include "sage/app/study_model.hpp"

#include "sage/model_file/model_file.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

void write_study_model(const ModelInput& input, const std::filesystem::path& path, const Catalogue& catalogue) {
  Model model = build_model(input, catalogue);
  OutFile out(path);
  out.text() = model_file_text(model, catalogue, model.diagnostics);
  out.finish();
}

}  // namespace sage::app
