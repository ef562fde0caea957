#include "sage/record/listing.hpp"

#include <fmt/format.h>

#include "sage/record/extremes.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/values.hpp"
#include "sage/record/water_balance.hpp"

namespace sage {

namespace {

void states(std::string& text, const Model& model, const Solution& solution,
            const std::vector<std::string>& fields) {
  listing::nodes(text, model, solution, fields);
  listing::points(text, model, solution, fields);
  listing::ends(text, model, solution);
}

void indented(std::string& text, const std::string& page) {
  text += "   ";
  for (char c : page) {
    text += c;
    if (c == '\n') text += "   ";
  }
  text += '\n';
}

std::string state_name(const StepReport& report) {
  return fmt::format("stage {}, increment {}, load factor {:.6g} of the stage", report.stage + 1,
                     report.increment, report.load_factor);
}

}  // namespace

Listing::Listing(const std::filesystem::path& folder, const std::string& stem, const Catalogue& catalogue,
                 ListingOptions options)
    : file_(folder / (stem + ".lst")), catalogue_(&catalogue), options_(std::move(options)) {}

std::vector<std::filesystem::path> Listing::files() const {
  if (file_.open()) return {};
  return {file_.path()};
}

void Listing::warn(const Diagnostic& diagnostic) {
  listing::diagnostic(file_.text(), diagnostic);
}

void Listing::on_warning(const Diagnostic& diagnostic) {
  if (started_)
    warn(diagnostic);
  else
    early_.push_back(diagnostic);
}

void Listing::on_start(const Model& model, const Scene& scene, std::string_view solver, int equations) {
  started_ = true;
  std::string& text = file_.text();
  text.reserve(1 << 16);
  listing::banner(text, model, options_.date);
  listing::description(text, model, scene, solver, equations);
  listing::counts(text, model);
  listing::materials(text, model, *catalogue_);
  listing::groups(text, model);
  if (!model.diagnostics.list().empty() || !early_.empty()) listing::heading(text, "WARNINGS AND NOTES");
  for (const Diagnostic& d : model.diagnostics.list()) warn(d);
  for (const Diagnostic& d : early_) warn(d);
  tables_ = options_.tables;
  if (tables_ != Tables::automatic) return;
  tables_ = scene.points > kManyPoints ? Tables::none : Tables::stage_end;
  if (tables_ == Tables::none)
    fmt::format_to(
        std::back_inserter(text),
        "\n   {} integration points: tables of nodes and points are left out.  To get them: --tables stage or "
        "--tables all.\n",
        scene.points);
}

void Listing::on_stage_start(const Model& model, int stage, const Solution& solution) {
  strength_.start(model, stage, solution);
  listing::stage(file_.text(), model, stage);
  columns_shown_ = false;
  if (stage == 0) last_state_ = "the state before the first increment";
}

void Listing::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  std::string& text = file_.text();
  strength_.increment(model, report);
  if (!columns_shown_) listing::increment_columns(text);
  listing::increment(text, report);
  columns_shown_ = true;
  last_state_ = state_name(report);
  const bool last = report.increment == report.increments;  // its tables come with the end of the stage
  if (tables_ == Tables::all && !last && is_output_increment(stage_of(model, report.stage), report)) {
    fmt::format_to(std::back_inserter(text), "\n   STATE: {}\n", last_state_);
    states(text, model, solution, options_.fields);
    columns_shown_ = false;
  }
  file_.checkpoint();
}

void Listing::on_stage_end(const Model& model, int stage, const EquilibriumAudit& audit,
                           const Solution& solution) {
  std::string& text = file_.text();
  strength_.end(model, stage, solution);
  listing::audit(text, model, audit);
  if (tables_ != Tables::none) {
    fmt::format_to(std::back_inserter(text), "\n   STATE: end of stage {}\n", stage + 1);
    states(text, model, solution, options_.fields);
  }
  listing::free_surface(text, model, solution);
  if (model.has_pores() && solution.assembly != nullptr)
    text += water_balance_table(model, water_balance(model, stage, solution));
  const std::vector<ExtremeRow> now = extremes(model, stage, solution);
  if (!now.empty())
    text += "\n   Extremes of structures (compression positive)\n" + extremes_table(model, now, false);
  if (has_structures(model)) {
    structures_.insert(structures_.end(), now.begin(), now.end());
    envelope_.add(model, stage, solution);
  }
  file_.checkpoint();
}

void Listing::on_failure(const Model& model, const StepReport& report, const std::string& reason,
                         const Solution& solution) {
  std::string& text = file_.text();
  strength_.failed(model, report, solution);
  if (!columns_shown_) listing::increment_columns(text);
  listing::increment(text, report);
  listing::heading(text, "NOT CONVERGED");
  indented(text, reason);
  if (report.load_factor > 0.0) last_state_ = state_name(report);
  listing::heading(text, "LAST CONVERGED STATE");
  fmt::format_to(std::back_inserter(text), "   {}\n", last_state_);
  if (options_.tables != Tables::none)
    states(text, model, solution, options_.fields);
  else
    text += "   (no tables: --tables none)\n";
}

void Listing::on_finish(const Model& model, const RunResult& result) {
  std::string& text = file_.text();
  if (!strength_.rows().empty()) {
    listing::heading(text, "STRENGTH DIVIDED BY FACTORS");
    text += strength_table(model, strength_.rows());
  }
  if (model.stages.size() > 1 && !structures_.empty()) {
    listing::heading(text, "ENVELOPE OF STRUCTURES");
    text += "   Of all stages, each at its end (compression positive)\n" +
            extremes_table(model, envelope(structures_), true);
    if (tables_ != Tables::none) text += envelope_table(model, envelope_.rows());
  }
  if (options_.reports != nullptr) listing::report_rows(text, model, *options_.reports);
  listing::work(text, result);
  if (result.status == RunStatus::completed)
    text += model.left_out.empty() ? "\n   RUN COMPLETED\n"
                                   : "\n   RUN COMPLETED, BUT PARTIAL: " + left_out_words(model) + "\n";
  if (const std::string beyond = motion_words(model, result.motion); !beyond.empty())
    text += "\n   " + beyond + "\n";
  if (result.status != RunStatus::completed)
    fmt::format_to(
        std::back_inserter(text),
        "\n   NOT CONVERGED: the run ended before its last stage.\n   Last state in equilibrium: {}\n",
        last_state_);
  file_.finish();
}

void Listing::exchange(Archive& archive) {
  file_.exchange(archive);
  archive(columns_shown_);
  archive(last_state_);
  strength_.exchange(archive);
  archive(structures_);
  envelope_.exchange(archive);
}

void Listing::stop(const std::string& reason) {
  if (!file_.open()) return;
  std::string& text = file_.text();
  for (const Diagnostic& d : started_ ? std::vector<Diagnostic>{} : early_) warn(d);
  listing::heading(text, "RUN STOPPED, NOT COMPLETE");
  indented(text, reason);
  file_.finish();
}

}  // namespace sage
