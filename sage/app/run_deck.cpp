#include "sage/app/run_deck.hpp"

#include <algorithm>
#include <optional>

#include "sage/analysis/stream_function.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/run_model.hpp"
#include "sage/app/run_outputs.hpp"
#include "sage/app/run_restart.hpp"
#include "sage/app/run_warnings.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/app/verbose.hpp"
#include "sage/deck/text.hpp"
#include "sage/record/data_file.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/profile_text.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

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
  settings.choose_solver = choose_solver;
  return settings;
}

// One deck on its way; run_deck() names the steps in their order.
class DeckRun {
 public:
  DeckRun(const RunRequest& request, const Catalogue& catalogue)
      : request_(request),
        catalogue_(catalogue),
        task_(case_name(request.deck)),
        profile_(request.profile),
        owner_{request.deck, 0, "run"} {
    profile_.show_in(task_.pulse());
  }

  void make_model();
  bool may_start();
  void lock_results();
  void open_checkpoint();
  void open_outputs();
  void analyse();
  void close_results();
  void report_times();
  // The last step: what has come of it.
  RunOutcome outcome() { return std::move(outcome_); }

  Profile::Scope timed(std::string_view phase) { return {profile_, phase}; }

 private:
  std::vector<Observer*> observers();
  RunResult solve();
  void take(const RunResult& result);
  void close_own_results();
  void write_page();
  void write_profile();

  RunRequest request_;
  const Catalogue& catalogue_;
  Task task_;
  Profile profile_;
  RunOutcome outcome_;
  ResultOwner owner_;
  RunSource source_;
  RunSettings settings_;
  std::optional<ResultFiles> own_;  // where the run is no part of another
  ResultFiles* results_ = nullptr;
  std::optional<Checkpoint> checkpoint_;
  bool has_checkpoint_ = false;
  std::optional<EndOfInterrupted> end_;
  Outputs outputs_;
  std::filesystem::path page_;
  Verbose verbose_{request_};
  RunWarnings warnings_{request_};
};

void DeckRun::make_model() {
  outcome_.model = read_model(request_, catalogue_, owner_, source_, profile_);
  if (!request_.quiet) print_diagnostics(outcome_.model->diagnostics);
}

// False: the outcome says why not.
bool DeckRun::may_start() {
  if (request_.input.strict && outcome_.model->diagnostics.warnings() > 0)
    outcome_.exit_code = kInput;
  else
    outcome_.too_large = request_.max_dofs > 0 && DofMap(*outcome_.model).dofs() > request_.max_dofs;
  return outcome_.exit_code == kOk && !outcome_.too_large;
}

void DeckRun::lock_results() {
  if (request_.results == nullptr) own_.emplace(request_.output.folder, stem_of(request_), owner_);
  results_ = own_ ? &*own_ : request_.results;
  if (!results_->locked() && !request_.quiet)
    say_note(request_.deck,
             request_.output.folder.string() +
                 " lies on a file system without locks: nothing keeps a second run out of it",
             "S603");
}

// Goes on from an earlier one where that is asked for.
void DeckRun::open_checkpoint() {
  settings_ = settings_for(request_);
  settings_.pulse = task_.pulse();
  Checkpoint& checkpoint =
      checkpoint_.emplace(checkpoint_of(request_, *outcome_.model, owner_.deck_sum, catalogue_, *results_));
  has_checkpoint_ = request_.restart && std::filesystem::exists(checkpoint.file());
  EndOfInterrupted& end = end_.emplace(checkpoint.ever_due(), request_.interrupt_patience);
  settings_.stop_asked = [&] {
    return !end.outputs_wait() && (end.stop_now() || (request_.stop_asked && request_.stop_asked()));
  };
  settings_.checkpoint_due = [&] { return end.checkpoint_wanted() || checkpoint.due(); };
  settings_.save_checkpoint = [&](const std::string& state) {
    checkpoint.save(state);
    end.saved();
    has_checkpoint_ = true;
  };
  if (request_.restart) settings_.resume_from = resume_from(checkpoint, request_);
  if (!settings_.resume_from.empty()) end.go_on_from_checkpoint();
}

void DeckRun::open_outputs() {
  outcome_.reports =
      std::make_unique<Reports>(request_.output.folder, stem_of(request_), csv_digits(request_.output));
  outputs_ = make_outputs(request_, catalogue_, *outcome_.reports, source_, *outcome_.model);
}

// Warnings, record, reports, what was asked to be kept, the outputs, and the end behind all of them.
std::vector<Observer*> DeckRun::observers() {
  std::vector<Observer*> list{&warnings_, &outcome_.record, outcome_.reports.get()};
  if (request_.output.error) {
    outcome_.error = std::make_unique<DiscretisationError>(*outcome_.reports);
    list.push_back(outcome_.error.get());
  }
  if (request_.keep_result) {
    outcome_.result = std::make_unique<Result>();
    list.push_back(outcome_.result.get());
  }
  for (const auto& output : outputs_) list.push_back(output.get());
  if (request_.watch != nullptr) list.push_back(request_.watch);
  if (screen().verbose) list.push_back(&verbose_);
  list.push_back(&*end_);
  return list;
}

RunResult DeckRun::solve() {
  const std::vector<Observer*> watching = observers();
  const Profile::Scope scope(profile_, phase::kAnalysis);
  RunResult result;
  with_umat_output(request_, [&] { result = run(*outcome_.model, catalogue_, settings_, watching); });
  profile_.add(result.work.profile);
  return result;
}

// Exit code, record and checkpoint of a run that has ended.  Throws where it failed.
void DeckRun::take(const RunResult& result) {
  outcome_.record.result.work = result.work;
  if (result.status == RunStatus::failed) throw AnalysisError(*result.code, result.reason);
  outcome_.exit_code = result.status == RunStatus::completed ? kOk : kNotConverged;
  if (result.status == RunStatus::stopped) {
    outcome_.record.result = result;
    if (interrupted()) outcome_.exit_code = kInterrupted;
    if (interrupted() && has_checkpoint_) outcome_.checkpoint = checkpoint_->file();
    stop(outputs_, *outcome_.reports, result.reason);
  } else {
    checkpoint_->remove();
  }
  if (outcome_.exit_code == kOk && !free_of_warnings(request_, outcome_.record, *outcome_.reports))
    outcome_.exit_code = kInput;
}

void DeckRun::analyse() {
  try {
    take(solve());
  } catch (const std::exception& error) {
    stop(outputs_, *outcome_.reports, error.what());
    if (own_) close_own_results();
    throw;
  }
}

// What an earlier run left is removed.
void DeckRun::close_own_results() {
  const ResultFiles::Left left = own_->close();
  if (!request_.quiet) say_left(request_.deck, left);
}

// Of runs that have written their result file.
void DeckRun::write_page() {
  const std::filesystem::path result = request_.output.folder / (stem_of(request_) + ".h5");
  const bool ended = outcome_.record.result.status != RunStatus::stopped && outcome_.exit_code != kInterrupted;
  if (!request_.write_page || !ended || !std::filesystem::exists(result)) return;
  const Profile::Scope scope(profile_, phase::kFiles);
  page_ = request_.write_page(result);
}

void DeckRun::close_results() {
  write_page();
  if (own_) {
    const Profile::Scope scope(profile_, phase::kFiles);
    close_own_results();
  }
  outcome_.files = files_of(*outcome_.reports, outputs_);
  if (!page_.empty()) outcome_.files.push_back(page_);
}

// After all others: only then is it known what they took.
void DeckRun::write_profile() {
  OutFile file(request_.output.folder / (stem_of(request_) + ".profile.json"));
  file.text() = profile_json(outcome_.record.profile, well_formed(case_name(request_.deck)).text,
                             settings_.threads, outcome_.record.result.kernels);
  file.finish();
  outcome_.files.push_back(file.path());
}

void DeckRun::report_times() {
  profile_.stop();
  outcome_.record.seconds = profile_.seconds_with_all(0);
  profile_.show_in(nullptr);
  outcome_.record.profile = std::move(profile_);
  if (screen().verbose) verbose_.say_times(outcome_.record.profile);
  if (request_.profile) write_profile();
}

}  // namespace

std::string stem_of(const RunRequest& request) {
  return request.stem.empty() ? case_name(request.deck) : request.stem;
}

RunOutcome run_deck(const RunRequest& request, const Catalogue& catalogue) {
  DeckRun run(request, catalogue);
  run.make_model();
  if (!run.may_start()) return run.outcome();
  if (request.output.result) expect_data_module();  // before any file is begun
  {
    const Profile::Scope opening = run.timed(phase::kFiles);
    run.lock_results();
    run.open_checkpoint();
    run.open_outputs();
  }
  run.analyse();
  run.close_results();
  run.report_times();
  return run.outcome();
}

}  // namespace sage::app
