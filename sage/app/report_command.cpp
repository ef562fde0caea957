// sagefe report: one HTML file that shows finished runs.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/report_page.hpp"
#include "sage/app/run_source.hpp"
#include "sage/app/screen.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> runs;
  std::string folder, name;
  double megabytes = 0.0;
  report::PageOptions page;
};

constexpr std::size_t kMostRuns = 8;

// A result file and the model of its run.
struct RunOnPage {
  StoredResult stored;
  Model model;

  RunOnPage(const fs::path& file, const Catalogue& catalogue)
      : stored(file), model(model_of(stored.source(), stored.deck_name(), catalogue)) {
    stored.expect_model(model);
  }
};

// Throws UsageError for a field that no run has.
void expect_fields(const std::vector<std::string>& fields,
                   const std::vector<std::unique_ptr<RunOnPage>>& runs) {
  for (const std::string& name : fields) {
    std::vector<std::string> known;
    const bool there = std::ranges::any_of(runs, [&](const std::unique_ptr<RunOnPage>& run) {
      const std::vector<std::string> names = report::page_fields(run->model);
      known.insert(known.end(), names.begin(), names.end());
      return std::ranges::find(names, name) != names.end();
    });
    if (there) continue;
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    throw UsageError("S622", fmt::format("--field {}: no run has such a field; there are: {}", name,
                                         fmt::join(known, ", ")));
  }
}

fs::path page_path(const ReportOptions& options, const std::vector<fs::path>& results) {
  fs::path folder = options.folder.empty() ? results.front().parent_path() : fs::path(options.folder);
  std::string name = options.name;
  if (name.ends_with(".html")) name.resize(name.size() - 5);
  if (name.empty())
    for (const fs::path& file : results) name += (name.empty() ? "" : "_") + file.stem().string();
  return folder / (name + ".html");
}

// What was written, on the screen.
int say_page(const fs::path& path, std::uintmax_t size) {
  answer_file(path);
  fmt::print("{} ({:.2f} MB)\n", path.string(), static_cast<double>(size) / 1e6);
  return kOk;
}

std::uintmax_t save_page(const fs::path& path, report::Page made) {
  for (const std::string& words : made.omitted) say_note(path.string(), words, "S621");
  const std::uintmax_t size = made.html.size();
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  if (error)
    throw OutputError("S601",
                      "the folder " + path.parent_path().string() + " can't be made: " + error.message());
  write_file(path, std::move(made.html));
  return size;
}

// STUDY.sweep.csv of a sweep, or another table.
int make_table_report(const ReportOptions& options) {
  if (options.runs.size() > 1)
    throw UsageError("S621", "a page shows runs, or one table of cases: " + options.runs.front() +
                                 " and others don't go together");
  const fs::path table(options.runs.front());
  keep_input(table);
  const fs::path path = page_path(options, {table});
  return say_page(path, save_page(path, report::make_table_page(table)));
}

int make_report(const ReportOptions& options, const Catalogue& catalogue) {
  if (std::ranges::any_of(options.runs, [](const std::string& run) { return run.ends_with(".csv"); }))
    return make_table_report(options);
  if (options.runs.size() > kMostRuns)
    throw UsageError("S621", fmt::format("{} runs: a page shows at most {}", options.runs.size(), kMostRuns));
  std::vector<fs::path> results;
  for (const std::string& run : options.runs) results.push_back(result_file_of(run));
  report::PageOptions page = options.page;
  page.room = static_cast<std::size_t>(options.megabytes * 1e6);
  const fs::path path = page_path(options, results);
  for (const fs::path& file : results) keep_input(file);
  return say_page(path, write_report_page(results, path, page, catalogue));
}

constexpr const char* kReportExamples =
    "Examples:\n"
    "  sagefe run deck.dat --report\n"
    "      computes, and writes out/deck.html\n"
    "  sagefe report out/deck.h5\n"
    "      the page of a run with --result\n"
    "  sagefe report out/full.h5 out/b_bar.h5 --name locking\n"
    "      two runs side by side, in out/locking.html\n"
    "  sagefe report out/deck.h5 --field stress --field stress_level --size 8\n"
    "      these fields alone, in at most about 8 MB";

}  // namespace

fs::path result_file_of(const std::string& name) {
  std::error_code error;
  const fs::path path(name);
  if (fs::is_directory(path, error)) {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
      if (entry.path().extension() == ".h5") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    if (found.size() == 1) return found.front();
    std::string names;
    for (const fs::path& file : found) names += " " + file.filename().string();
    throw UsageError(
        "S620", found.empty() ? name + ": the folder has no result file (STEM.h5 of sagefe run DECK --result)"
                              : name + ": the folder has several result files, name one:" + names);
  }
  const fs::path with_ending(name + ".h5");
  if (path.extension() != ".h5" && fs::exists(with_ending, error)) return with_ending;
  if (path.extension() == ".h5" || !fs::exists(path, error)) {
    if (fs::exists(path, error)) return path;
    throw UsageError("S620", name + ": there is no such result file (STEM.h5 of sagefe run DECK --result)");
  }
  throw UsageError("S620", name +
                               " is no result file: a page is made of STEM.h5, which sagefe run DECK --result "
                               "or --report writes");
}

std::uintmax_t write_report_page(const std::vector<fs::path>& results, const fs::path& page,
                                 const report::PageOptions& options, const Catalogue& catalogue) {
  std::vector<std::unique_ptr<RunOnPage>> runs;
  for (const fs::path& file : results) runs.push_back(std::make_unique<RunOnPage>(file, catalogue));
  expect_fields(options.fields, runs);
  std::vector<report::PageRun> parts;
  for (std::size_t i = 0; i < runs.size(); ++i)
    parts.push_back(report::page_run(results[i], runs[i]->stored, runs[i]->model));
  return save_page(page, report::make_page(parts, options));
}

Command report_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<ReportOptions>();
  parser.footer(kReportExamples);
  parser
      .add_option(
          "RUN", options->runs,
          "result files (STEM.h5 of sagefe run DECK --result), the same without .h5, or folders with one; "
          "or STUDY.sweep.csv of sagefe sweep; tables, listing and pictures of the run are read where they lie "
          "beside it")
      ->required();
  parser.add_option("-o,--output", options->folder, "folder of the page (default: that of the first run)");
  parser.add_option("--name", options->name, "name of the page (default: from those of the runs)")
      ->check([](const std::string& name) {
        return name.empty() || name.find('/') != std::string::npos
                   ? "--name " + name + ": wanted a file's name; its folder is that of -o"
                   : std::string();
      });
  parser
      .add_option("--field", options->page.fields,
                  "show these fields alone, besides the displacement (see sagefe list fields); may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option("--size", options->megabytes,
                  "megabytes of a run, about (default: 4, or 80 bytes an element where that is more)")
      ->check(CLI::Range(0.1, 1000.0));
  return [options, &catalogue] { return make_report(*options, catalogue); };
}

}  // namespace sage::app
