#include "sage/app/run_outputs.hpp"

#include "sage/draw/picture.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/record/csv.hpp"
#include "sage/record/msh_results.hpp"
#include "sage/record/result_file.hpp"
#include "sage/record/vtu.hpp"

namespace sage::app {

int csv_digits(const OutputOptions& options) {
  return options.digits > 0 ? options.digits : kCsvDigits;
}

Outputs make_outputs(const RunRequest& request, const Catalogue& catalogue, const Reports& reports,
                     const RunSource& source, const Model& model) {
  const OutputOptions& options = request.output;
  const std::string stem = stem_of(request);
  Outputs outputs;
  if (options.listing)
    outputs.push_back(std::make_unique<Listing>(options.folder, stem, catalogue,
                                                ListingOptions{options.tables, "", &reports, options.fields}));
  if (options.increments || options.nodes || options.points)
    outputs.push_back(std::make_unique<Csv>(
        options.folder, stem,
        CsvOptions{options.increments, options.nodes, options.points, csv_digits(options), options.fields}));
  if (options.vtu) outputs.push_back(std::make_unique<Vtu>(options.folder, stem));
  if (options.msh) {
    const MshForm form = options.msh_text ? MshForm::text : MshForm::binary;
    Diagnostics said_before;
    MshMesh mesh = msh_mesh(model, form, said_before);
    outputs.push_back(
        std::make_unique<MshResults>(options.folder, stem, mesh.text, std::move(mesh.elements), form));
  }
  if (options.result)
    outputs.push_back(std::make_unique<ResultOutput>(options.folder, stem, source, threads_for(request.threads),
                                                     ResultFields{options.fields}));
  if (!options.pictures.empty())
    outputs.push_back(std::make_unique<Pictures>(options.folder, stem, options.pictures));
  return outputs;
}

std::vector<std::filesystem::path> files_of(const Reports& reports, const Outputs& outputs) {
  std::vector<std::filesystem::path> files = reports.files();
  for (const auto& output : outputs)
    for (const std::filesystem::path& file : output->files()) files.push_back(file);
  return files;
}

void stop(const Outputs& outputs, Reports& reports, const std::string& reason) {
  for (const auto& output : outputs) output->stop(reason);
  reports.stop(reason);
}

}  // namespace sage::app
