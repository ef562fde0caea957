// sagefe sweep: many cases of one deck, by names of its numbers.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/outside_workers.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/result_files.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/stored_heads.hpp"
#include "sage/deck/source.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/csv.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/report.hpp"
#include "sage/report/live_page.hpp"
#include "sage/sweep/table.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

struct SweepCommand {
  std::string study;
  std::vector<std::string> collect;
  int jobs = 0, digits = kCsvDigits;
  std::filesystem::path folder = "out";
  std::string part;             // "K/N": a worker of others
  int parallel = 0, slurm = 0;  // workers; 0 = none
  bool report = false;          // a page for each case
};

// "2/8" as {1, 8}.
std::pair<int, int> part_of(const SweepCommand& command) {
  if (command.part.empty()) return {0, 1};
  int part = 0, parts = 0;
  char slash = ' ', more = ' ';
  std::istringstream in(command.part);
  if (!(in >> part >> slash >> parts) || slash != '/' || in >> more || part < 1 || part > parts)
    throw UsageError("S904", "--part " + command.part + ": wanted K/N, K from 1 to N");
  return {part - 1, parts};
}

sweep::Study study_of(const SweepCommand& command) {
  sweep::Study study = sweep::read_study(command.study);
  for (const std::string& list : command.collect)
    for (const std::string_view name : split_at(',', list))
      if (std::ranges::find(study.collect, name) == study.collect.end()) study.collect.emplace_back(name);
  return study;
}

// Of the program's own bytes: outcomes of another program are not taken for its own.
std::uint64_t own_sum() {
  const std::optional<Checksum> sum = checksum_of("/proc/self/exe");
  return sum ? sum->value() : 0;
}

void answer_sweep(const sweep::Sweep& all, const sweep::SweepResult& result,
                  const std::vector<std::filesystem::path>& files) {
  Json* json = answer();
  if (json == nullptr) return;
  Json rules = Json::array();
  for (const sweep::FailureRow& row : sweep::failure_rows(all, result))
    rules.push_back({{"combination", json_text(row.combination)},
                     {"failures", row.failures},
                     {"cases", row.cases},
                     {"without_answer", row.without},
                     {"probability", row.probability.value},
                     {"low", row.probability.low},
                     {"high", row.probability.high}});
  Json names = Json::array();
  for (const std::filesystem::path& file : files) names.push_back(json_text(file.string()));
  *json = {{"study", json_text(all.study().file)},
           {"deck", json_text(all.study().deck)},
           {"cases", result.rows.size()},
           {"computed", result.ran},
           {"kept", result.kept},
           {"failures", std::ranges::count_if(
                            result.rows, [](const sweep::CaseRow& row) { return row.outcome.status != "ok"; })},
           {"probability", std::move(rules)},
           {"files", std::move(names)}};
}

// What the files of a case are called: not by its number, which another study gives to another case.
std::string stem_of_case(const std::string& study, sweep::CaseKey key) {
  return fmt::format("{}.case_{:016x}", study, key);
}

// Tables and page of a case.  None where the page is there.
std::vector<std::unique_ptr<Observer>> page_of_case(const SweepCommand& command, const std::string& stem,
                                                    const std::string& title, const std::string& deck) {
  std::vector<std::unique_ptr<Observer>> observers;
  std::error_code absent;
  if (std::filesystem::exists(command.folder / (stem + ".html"), absent)) return observers;
  observers.push_back(std::make_unique<Reports>(command.folder, stem, command.digits));
  observers.push_back(std::make_unique<Csv>(command.folder, stem));
  observers.push_back(std::make_unique<report::LivePage>(command.folder / (stem + ".h5"), title, deck,
                                                         report::LivePage::kAtTheEnd));
  return observers;
}

void ask_for_pages(const SweepCommand& command, const sweep::Sweep& all, const std::string& name,
                   sweep::SweepOptions& options) {
  options.observers = [&command, &all, name, deck = read_file(all.study().deck)](std::size_t index,
                                                                                 sweep::CaseKey key) {
    return page_of_case(command, stem_of_case(name, key),
                        all.study().deck + " with " + sweep::case_words(all.study(), index), deck);
  };
}

int finish_sweep(const SweepCommand& command, const sweep::Sweep& all, const sweep::SweepResult& result,
                 const std::filesystem::path& stem) {
  std::vector<std::filesystem::path> files{stem.string() + ".sweep.csv", stem.string() + ".sweep.svg"};
  std::function<std::string(sweep::CaseKey)> page;
  if (command.report)
    page = [&](sweep::CaseKey key) {
      const std::string file = stem_of_case(stem.filename().string(), key) + ".html";
      std::error_code absent;
      return std::filesystem::exists(command.folder / file, absent) ? file : std::string();
    };
  write_file(files[0], sweep::csv_text(all, result, command.digits, page));
  write_file(files[1], sweep::plot_text(all, result));
  if (command.report) {
    files.emplace_back(stem.string() + ".sweep.html");
    write_file(files[2], report::make_table_page(files[0]).html);
  }
  const ProgressPause pause;
  fmt::print("{}", sweep::summary_text(all, result));
  print_files(files);
  answer_sweep(all, result, files);
  return kOk;
}

int run_sweep(const SweepCommand& command, const Catalogue& catalogue) {
  return guarded(command.study, [&] {
    const auto [part, parts] = part_of(command);
    keep_input(command.study);
    const InterruptWatch watch;
    const sweep::Study study = study_of(command);
    keep_input(study.deck);
    InputOptions input;
    input.layout = study.layout;
    input.build.heads = stored_heads(catalogue);
    const Deck deck = read_input(study.deck, input);
    const sweep::Sweep all(study, deck, catalogue, input.build);
    if (parts == 1) print_diagnostics(all.model().diagnostics);
    const std::string name = std::filesystem::path(command.study).stem().string();
    if (command.parallel > 0) run_parallel(command.study, command.folder, command.collect, command.parallel);
    if (command.slurm > 0) run_slurm(command.study, name, command.folder, command.collect, command.slurm);
    sweep::Journal journal(command.folder, name, parts > 1 ? part + 1 : 0);
    Task task(command.study);
    sweep::SweepOptions options;
    options.threads = threads_for_cases(command.jobs);
    options.part = part;
    options.parts = parts;
    options.program = own_sum();
    options.stop_asked = [] { return interrupted(); };
    if (command.report) ask_for_pages(command, all, name, options);
    options.choose_solver = choose_solver;
    options.progress = [&](std::size_t done, std::size_t count) {
      task.part("cases", static_cast<int>(std::min(done + 1, count)), static_cast<int>(count));
    };
    const sweep::SweepResult result = all.run(journal, options);
    if (interrupted()) {
      say_error(command.study,
                fmt::format("interrupted with {} of {} cases left; the same command goes on", result.left,
                            result.rows.size()),
                "S511");
      return kInterrupted;
    }
    if (parts > 1) return kOk;
    return finish_sweep(command, all, result, command.folder / name);
  });
}

constexpr const char* kSweepExamples =
    "Examples:\n"
    "  sagefe sweep study.toml --collect report1.ratio\n"
    "      all cases of the study, on all processors; out/study.sweep.csv and a plot\n"
    "  sagefe sweep study.toml\n"
    "      the same again computes only what is not finished yet\n"
    "  sagefe sweep study.toml --slurm 16\n"
    "      as an array job of 16, whose results are merged into the same table";

}  // namespace

Command sweep_command(CLI::App& parser, const Catalogue& catalogue) {
  parser.footer(std::string(kSweepExamples) + "\n\n" + parser.get_footer());
  auto o = std::make_shared<SweepCommand>();
  parser.add_option("STUDY", o->study, "TOML file with deck, names and values (docs/manual/sweep.md)")
      ->required();
  parser
      .add_option("--collect", o->collect,
                  "quantities, beside those of the study: report1.ratio,safety.factor; may be repeated")
      ->allow_extra_args(false);
  parser.add_option("-j,--jobs", o->jobs, "cases at a time (default: one for each processor)")
      ->check(CLI::Range(1, 1024));
  add_digits_option(parser, o->digits);
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  CLI::Option* part = parser.add_option("--part", o->part,
                                        "K/N: compute only every N-th case from the K-th on; write no table");
  CLI::Option* parallel =
      parser.add_option("--parallel", o->parallel, "number of worker processes, started by GNU parallel")
          ->check(CLI::Range(1, 10'000));
  CLI::Option* slurm =
      parser.add_option("--slurm", o->slurm, "number of tasks of an array job, submitted by sbatch")
          ->check(CLI::Range(1, 10'000));
  parser
      .add_flag("--report", o->report,
                "also write an HTML page for each case, and STUDY.sweep.html, whose rows lead to them (not "
                "with --parallel and --slurm)")
      ->excludes(parallel)
      ->excludes(slurm);
  part->excludes(parallel)->excludes(slurm);
  parallel->excludes(slurm);
  return [o, &catalogue] { return run_sweep(*o, catalogue); };
}

}  // namespace sage::app
