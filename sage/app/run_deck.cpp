#include "sage/app/run_deck.hpp"

#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <atomic>
#include <map>
#include <thread>

#include "sage/analysis/stream_function.hpp"
#include "sage/app/checkpoint.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/run_key.hpp"
#include "sage/app/run_source.hpp"
#include "sage/app/run_warnings.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/state_choice.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/app/verbose.hpp"
#include "sage/deck/text.hpp"
#include "sage/draw/diagram.hpp"
#include "sage/draw/picture.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/record/csv.hpp"
#include "sage/record/data_file.hpp"
#include "sage/record/msh_results.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/profile_text.hpp"
#include "sage/record/result_file.hpp"
#include "sage/record/vtu.hpp"
#include "sage/umat/routine.hpp"
#include "solvers/choose_kernels.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

int csv_digits(const OutputOptions& options) {
  return options.digits > 0 ? options.digits : kCsvDigits;
}

// The outputs that were asked for; the first is always the reports.
std::vector<std::unique_ptr<Output>> make_outputs(const RunRequest& request, const Catalogue& catalogue,
                                                  const Reports& reports, const RunSource& source,
                                                  const Model& model) {
  const OutputOptions& options = request.output;
  const std::string stem = stem_of(request);
  std::vector<std::unique_ptr<Output>> outputs;
  if (options.listing)
    outputs.push_back(std::make_unique<Listing>(options.folder, stem, catalogue,
                                                ListingOptions{options.tables, "", &reports, options.fields}));
  if (options.increments || options.nodes || options.points)
    outputs.push_back(std::make_unique<Csv>(
        options.folder, stem,
        CsvOptions{options.increments, options.nodes, options.points, csv_digits(options), options.fields}));
  if (options.vtu) outputs.push_back(std::make_unique<Vtu>(options.folder, stem));
  if (options.msh) {
    Diagnostics said_before;
    MshMesh mesh = msh_mesh(model, said_before);
    outputs.push_back(std::make_unique<MshResults>(options.folder, stem, mesh.text, std::move(mesh.elements)));
  }
  if (options.result)
    outputs.push_back(std::make_unique<ResultOutput>(options.folder, stem, source, threads_for(request.threads),
                                                     ResultFields{options.fields}));
  if (!options.pictures.empty())
    outputs.push_back(std::make_unique<Pictures>(options.folder, stem, options.pictures));
  return outputs;
}

// A library that was built anew computes something else, whatever it says of its version.
std::string plugin_words(const Catalogue& catalogue) {
  std::string text;
  for (const Plugin& plugin : catalogue.plugins)
    text += fmt::format(" plug-in {} {} {:016x}", plugin.name, plugin.version,
                        checksum_of(plugin.file).value_or(Checksum()).value());
  for (const umat::OpenedLibrary& library : umat::opened_libraries())
    text +=
        fmt::format(" umat {} {:016x}", library.file, checksum_of(library.file).value_or(Checksum()).value());
  return text;
}

// deck_sum: of its text, so that what a fingerprint of the model may not know counts too.
Checkpoint checkpoint_of(const RunRequest& request, const Model& model, std::uint64_t deck_sum,
                         const Catalogue& catalogue, ResultFiles& results) {
  const std::string run = fmt::format("{:016x} {:016x}{}{}", deck_sum, fingerprint(model), options_key(request),
                                      plugin_words(catalogue));
  return {request.output.folder / (stem_of(request) + ".restart"), request.checkpoint_seconds, run,
          choose_kernels(request.kernels).name, results};
}

// The bytes to go on from; empty, with a note, where there are none.
std::string resume_from(Checkpoint& checkpoint, const RunRequest& request) {
  std::optional<std::string> state = checkpoint.load();
  if (!state && !request.quiet)
    say_note(request.deck, "no checkpoint in " + request.output.folder.string() + ": from the start", "S632");
  const std::string kernels = choose_kernels(request.kernels).name;
  if (!request.quiet && checkpoint.earlier_kernels() != kernels)
    say_note(request.deck,
             "what stands before the checkpoint was computed with kernels " + checkpoint.earlier_kernels() +
                 "; the digits are the same",
             "S632");
  for (const Checkpoint::Cut& cut : checkpoint.cut())
    if (!request.quiet)
      say_note(request.deck,
               fmt::format("{} goes on from its checkpoint: the {} bytes behind that are cut off and written "
                           "anew",
                           cut.file.string(), cut.bytes),
               "S632");
  return state.value_or("");
}

// What an earlier run left is removed.
void close_results(ResultFiles& results, const RunRequest& request) {
  const ResultFiles::Left left = results.close();
  if (!request.quiet) say_left(request.deck, left);
}

// When an interrupted run ends: behind the checkpoint of the increment in hand, if there can be one and the
// increment ends soon.  A run that goes on from a checkpoint ends no sooner than all outputs have gone on with their
// files: what stands in those would be lost.  Asked by the thread that runs the analysis only; the last observer.
class EndOfInterrupted final : public Observer {
 public:
  EndOfInterrupted(bool checkpoints, double patience)
      : checkpoints_(checkpoints), patience_(patience), before_start_(interrupted()) {}

  void go_on_from_checkpoint() { outputs_wait_ = true; }
  void exchange(Archive&) override { outputs_wait_ = false; }

  bool checkpoint_wanted() const { return checkpoints_ && interrupted(); }
  void saved() { ready_ = ready_ || interrupted(); }
  bool stop_now() { return interrupted() && (before_start_ || !checkpoints_ || ready_ || waited_enough()); }
  bool outputs_wait() const { return outputs_wait_; }

  // With initial stiffness checkpoints stand between stages only: there is nothing to wait for.
  void on_increment(const Model& model, const StepReport& report, const Solution&) override {
    const Stage& stage = model.stages[static_cast<std::size_t>(report.stage)];
    if (stage.method == Method::initial_stiffness && report.increment < report.increments) saved();
  }
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }

 private:
  bool waited_enough() const { return seconds_since_interrupt() >= patience_; }

  bool checkpoints_;
  double patience_;  // s
  bool before_start_, outputs_wait_ = false;
  std::atomic<bool> ready_{false};
};

}  // namespace

std::string stem_of(const RunRequest& request) {
  return request.stem.empty() ? case_name(request.deck) : request.stem;
}

void add_threads_option(CLI::App& parser, int& threads) {
  parser
      .add_option("--threads", threads,
                  "threads of the linear solver and of large nonlinear groups (default: one for each "
                  "processor, where that gains); results are the same to the last bit")
      ->check(CLI::Range(0, 256));
}

void add_kernels_option(CLI::App& parser, Kernels& kernels) {
  static const std::map<std::string, Kernels> names{
      {"auto", Kernels::automatic}, {"avx2", Kernels::avx2}, {"avx512", Kernels::avx512}};
  const auto suits = [](const std::string& name) {
    const auto found = names.find(name);
    return found == names.end() ? "expected auto, avx2 or avx512" : why_no_kernels(found->second);
  };
  parser
      .add_option_function<std::string>(
          "--kernels", [&kernels](const std::string& name) { kernels = names.at(name); },
          "instructions of the processor that the solvers use: auto (default, the fastest it has), avx2, "
          "avx512; results are the same to the last bit")
      ->check(suits);
}

int threads_for(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

// A warning about the fields that were asked for in vain.
void warn_of_fields(const OutputOptions& o, Model& model) {
  const bool tables = o.listing && o.tables != Tables::none, all = o.vtu || o.msh || o.result;
  const bool reports =
      std::ranges::any_of(model.reports, [](const Report& r) { return r.kind == ReportKind::point; });
  const auto has_column = [&](const FieldEntry& row) {
    const bool in_reports = reports && row.form == FieldForm::number;
    switch (row.place()) {
      case FieldPlace::node:
        return o.nodes || tables || in_reports || all;
      case FieldPlace::point:
        return o.points || tables || in_reports || all;
      case FieldPlace::increment:
        return o.increments || o.result;
      case FieldPlace::element:
        return all;
    }
    return true;
  };
  const std::string text = fields_without_column(
      o.fields, fields_of(model), has_column,
      "ask for --nodes (fields of nodes), --points (of integration points) or --result (all)");
  if (!text.empty()) model.diagnostics.add({Severity::warning, "S610", {model.file, 0, 0, 0}, text, {}});
}

// Pictures of integration points that no element has that is drawn would be empty, but for structures, which are drawn in
// every picture.
void expect_drawn(const std::vector<std::string>& pictures, const Model& model) {
  const bool structures =
      std::ranges::any_of(model.groups, [](const Group& group) { return group.structure(); });
  const bool moves = std::ranges::any_of(
      model.groups, [](const Group& group) { return group.entry->moves() && group.elements() > 0; });
  const FieldTable table = fields_of(model);
  const auto of_motion = [](const FieldEntry& field) {
    return field.name == "displacement" || field.name == "external_force" || field.name == "reaction";
  };
  const auto is_drawn = [&](const FieldEntry& field, bool diagram) {
    if (field.place() == FieldPlace::node) return moves || !of_motion(field);
    return std::ranges::any_of(model.groups, [&](const Group& group) {
      const ElementKind kind = diagram ? ElementKind::structure : ElementKind::solid;
      return drawn_as(group) == kind && group.elements() > 0 &&
             applies(field, group, model.material_of(group).law_ref());
    });
  };
  for (const std::string& name : pictures) {
    const FieldChoice field = picture_field(table, name);
    const bool diagram = diagram_of(name) >= 0;
    if (is_drawn(*field.entry, diagram) || (structures && !diagram)) continue;
    std::string there;
    for (const FieldEntry& row : table.rows()) {
      const bool shown = row.place() == FieldPlace::node || row.place() == FieldPlace::point;
      if (shown && row.form == FieldForm::number && is_drawn(row, false))
        there += (there.empty() ? "" : ", ") + row.name;
    }
    throw UsageError("S644", "--picture " + name + ": no " +
                                 (diagram ? "structure" : "element that fills an area") +
                                 " of this deck has it, the picture would be empty; there are: " + there);
  }
}

// The deck as a model; its checksum becomes the owner's, and names of fields' components those of the fields.
std::unique_ptr<Model> model_of(RunRequest& request, const Catalogue& catalogue, ResultOwner& owner,
                                RunSource& source, Profile& profile) {
  const Deck deck = [&] {
    const Profile::Scope scope(profile, phase::kReading);
    return read_input(request.deck, request.input);
  }();
  const Profile::Scope scope(profile, phase::kModel);
  BuildOptions build = request.input.build;
  if (!request.solver.empty()) build.solver = solver_code(catalogue, request.solver);
  std::string heads;
  if (request.output.result && build.heads) build.heads = keeping_heads(build.heads, heads);
  auto model = std::make_unique<Model>(build_model(deck, catalogue, build));
  owner.deck_sum = checksum(*deck.source.text());
  if (request.output.result) source = source_of(*deck.source.text(), deck.layout, request.input.layout, build);
  source.heads = std::move(heads);
  if (request.output.vtu || request.output.result) warn_of_vtu(*model, model->diagnostics);
  if (request.output.msh) msh_mesh(*model, model->diagnostics);
  request.output.fields = require_fields(request.output.pictures, request.output.fields, {fields_of(*model)});
  expect_drawn(request.output.pictures, *model);
  warn_of_fields(request.output, *model);
  for (Report& report : model->reports) report.fields = request.output.fields;
  try {
    for (const std::string& note : ask_for_states(*model, request.output.states))
      if (!request.quiet) say_note(request.deck, note, "S643");
  } catch (const std::invalid_argument& error) {
    throw UsageError("S643", std::string("--states: ") + error.what());
  }
  return model;
}

RunSettings settings_for(const RunRequest& request) {
  RunSettings settings;
  settings.skips = request.skips;
  settings.threads = threads_for(request.threads);
  settings.kernels = request.kernels;
  settings.refinement = request.refinement;
  settings.condition = request.condition;
  const auto named = [](const std::vector<std::string>& names) {
    return std::ranges::find(names, kStreamFunction) != names.end();
  };
  settings.stream_function = named(request.output.fields) || named(request.output.pictures);
  settings.profile_memory = request.profile;
  settings.choose_solver = [](int equations, bool symmetric) { return choose_solver(equations, symmetric); };
  return settings;
}

void note_missing_locks(const RunRequest& request) {
  say_note(request.deck,
           request.output.folder.string() +
               " lies on a file system without locks: nothing keeps a second run out of it",
           "S603");
}

std::vector<std::filesystem::path> files_of(const Reports& reports,
                                            const std::vector<std::unique_ptr<Output>>& outputs) {
  std::vector<std::filesystem::path> files = reports.files();
  for (const auto& output : outputs)
    for (const std::filesystem::path& file : output->files()) files.push_back(file);
  return files;
}

// False: the outcome says why not.
bool may_run(const RunRequest& request, const Model& model, RunOutcome& outcome) {
  if (request.input.strict && model.diagnostics.warnings() > 0)
    outcome.exit_code = kInput;
  else
    outcome.too_large = request.max_dofs > 0 && DofMap(model).dofs() > request.max_dofs;
  return outcome.exit_code == kOk && !outcome.too_large;
}

// Record, reports, what was asked to be kept, the outputs, and the end behind all of them.
std::vector<Observer*> observers_of(const RunRequest& request,
                                    const std::vector<std::unique_ptr<Output>>& outputs, Verbose& verbose,
                                    EndOfInterrupted& end, RunOutcome& outcome) {
  std::vector<Observer*> observers{&outcome.record, outcome.reports.get()};
  if (request.output.error) {
    outcome.error = std::make_unique<DiscretisationError>(*outcome.reports);
    observers.push_back(outcome.error.get());
  }
  if (request.keep_result) {
    outcome.result = std::make_unique<Result>();
    observers.push_back(outcome.result.get());
  }
  for (const auto& output : outputs) observers.push_back(output.get());
  if (request.watch != nullptr) observers.push_back(request.watch);
  if (screen().verbose) observers.push_back(&verbose);
  observers.push_back(&end);
  return observers;
}

RunResult analyse(const RunRequest& request, const Model& model, const Catalogue& catalogue,
                  const RunSettings& settings, const std::vector<Observer*>& observers, Profile& profile) {
  const Profile::Scope scope(profile, phase::kAnalysis);
  RunResult result;
  with_umat_output(request, [&] { result = run(model, catalogue, settings, observers); });
  profile.add(result.work.profile);
  return result;
}

// The files of a run that did not come to its end say why.
void stop(const std::vector<std::unique_ptr<Output>>& outputs, Reports& reports, const std::string& reason) {
  for (const auto& output : outputs) output->stop(reason);
  reports.stop(reason);
}

// The arguments but the settings outlive the run.
void listen_to(EndOfInterrupted& end, const RunRequest& request, const Checkpoint& checkpoint,
               RunSettings& settings) {
  settings.stop_asked = [&] {
    return !end.outputs_wait() && (end.stop_now() || (request.stop_asked && request.stop_asked()));
  };
  settings.checkpoint_due = [&] { return end.checkpoint_wanted() || checkpoint.due(); };
}

// After all others: only then is it known what they took.
void write_profile(const RunRequest& request, int threads, RunOutcome& outcome) {
  OutFile file(request.output.folder / (stem_of(request) + ".profile.json"));
  file.text() = profile_json(outcome.record.profile, well_formed(case_name(request.deck)).text, threads,
                             outcome.record.result.kernels);
  file.finish();
  outcome.files.push_back(file.path());
}

void tell_times(const RunRequest& request, int threads, const Verbose& verbose, Profile& profile,
                RunOutcome& outcome) {
  profile.stop();
  outcome.record.seconds = profile.seconds_with_all(0);
  profile.show_in(nullptr);
  outcome.record.profile = std::move(profile);
  if (screen().verbose) verbose.say_times(outcome.record.profile);
  if (request.profile) write_profile(request, threads, outcome);
}

// Exit code, record and checkpoint of a run that has ended.  Throws where it failed.
void take_result(const RunRequest& request, const RunResult& result, Checkpoint& checkpoint,
                 bool has_checkpoint, const std::vector<std::unique_ptr<Output>>& outputs,
                 RunOutcome& outcome) {
  outcome.record.result.work = result.work;
  if (result.status == RunStatus::failed) throw AnalysisError(*result.code, result.reason);
  outcome.exit_code = result.status == RunStatus::completed ? kOk : kNotConverged;
  if (result.status == RunStatus::stopped) {
    outcome.record.result = result;
    if (interrupted()) outcome.exit_code = kInterrupted;
    if (interrupted() && has_checkpoint) outcome.checkpoint = checkpoint.file();
    stop(outputs, *outcome.reports, result.reason);
  } else {
    checkpoint.remove();
  }
  if (outcome.exit_code == kOk && !free_of_warnings(request, outcome.record, *outcome.reports))
    outcome.exit_code = kInput;
}

}  // namespace

RunOutcome run_deck(const RunRequest& asked, const Catalogue& catalogue) {
  RunRequest request = asked;
  Task task(case_name(request.deck));
  Profile profile(request.profile);
  profile.show_in(task.pulse());
  RunOutcome outcome;
  ResultOwner owner{request.deck, 0, "run"};
  RunSource source;
  outcome.model = model_of(request, catalogue, owner, source, profile);
  const Model& model = *outcome.model;
  if (!request.quiet) print_diagnostics(model.diagnostics);
  if (!may_run(request, model, outcome)) return outcome;
  if (request.output.result) expect_data_module();  // before any file is begun
  RunSettings settings = settings_for(request);
  settings.pulse = task.pulse();
  std::optional<Profile::Scope> opening(std::in_place, profile, phase::kFiles);
  std::optional<ResultFiles> own;
  if (request.results == nullptr) own.emplace(request.output.folder, stem_of(request), owner);
  ResultFiles& results = own ? *own : *request.results;
  if (!results.locked() && !request.quiet) note_missing_locks(request);
  Checkpoint checkpoint = checkpoint_of(request, model, owner.deck_sum, catalogue, results);
  bool has_checkpoint = request.restart && std::filesystem::exists(checkpoint.file());
  EndOfInterrupted end(checkpoint.ever_due(), request.interrupt_patience);
  listen_to(end, request, checkpoint, settings);
  if (request.restart) settings.resume_from = resume_from(checkpoint, request);
  if (!settings.resume_from.empty()) end.go_on_from_checkpoint();
  outcome.reports =
      std::make_unique<Reports>(request.output.folder, stem_of(request), csv_digits(request.output));
  std::vector<std::unique_ptr<Output>> outputs =
      make_outputs(request, catalogue, *outcome.reports, source, model);
  settings.save_checkpoint = [&](const std::string& state) {
    checkpoint.save(state);
    end.saved();
    has_checkpoint = true;
  };
  Verbose verbose(request);
  RunWarnings warnings(request);
  std::vector<Observer*> observers = observers_of(request, outputs, verbose, end, outcome);
  observers.insert(observers.begin(), &warnings);
  opening.reset();
  try {
    const RunResult result = analyse(request, model, catalogue, settings, observers, profile);
    take_result(request, result, checkpoint, has_checkpoint, outputs, outcome);
  } catch (const std::exception& error) {
    stop(outputs, *outcome.reports, error.what());
    if (own) close_results(*own, request);
    throw;
  }
  if (own) {
    const Profile::Scope scope(profile, phase::kFiles);
    close_results(*own, request);
  }
  outcome.files = files_of(*outcome.reports, outputs);
  tell_times(request, settings.threads, verbose, profile, outcome);
  return outcome;
}

}  // namespace sage::app
