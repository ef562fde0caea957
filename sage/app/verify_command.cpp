// sagefe verify: the verification book.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <cstdio>
#include <filesystem>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/core/error.hpp"
#include "sage/record/out_file.hpp"
#include "sage/verify/book.hpp"

namespace sage::app {

namespace {

using namespace verify;

struct VerifyOptions {
  std::string only, csv, write;
  bool list = false, rows = false;
};

bool chosen(const VerifyOptions& options, const Section& section, const Case& one) {
  return options.only.empty() || one.name.find(options.only) != std::string::npos ||
         section.title.find(options.only) != std::string::npos;
}

int list_cases(const VerifyOptions& options, const std::vector<Section>& sections) {
  for (const Section& section : sections) {
    fmt::print("{}\n", section.title);
    for (const Case& one : section.cases)
      if (chosen(options, section, one))
        fmt::print("  {:<26} {}; {} ({})\n", one.name, one.title, one.source, name_of(one.grade));
  }
  return kOk;
}

// The case that runs, on a terminal only.
void show_progress(const std::string& name) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r\033[K{}", name);
  std::fflush(stderr);
}

void write_book(OutFile& book, const std::vector<Chapter>& chapters) {
  const std::string folder = book.path().stem().string();
  for (const NamedPicture& picture : pictures(chapters))
    write_file(book.path().parent_path() / folder / picture.file, picture.svg);
  book.text() = markdown_text(chapters, folder);
  book.finish();
}

int run_book(const VerifyOptions& options, const Catalogue& catalogue) {
  const std::vector<Section> sections = book();
  if (options.list) return list_cases(options, sections);
  if (!options.write.empty() && !options.only.empty()) {
    fmt::print(stderr, "sagefe verify: --write writes the whole book; leave --only away\n");
    return kUsage;
  }
  OutFile csv, written;  // opened first: an unwritable folder shows before anything is computed
  if (!options.csv.empty()) csv = OutFile(options.csv);
  if (!options.write.empty()) written = OutFile(options.write);
  const scenes::Workbench bench = make_workbench(catalogue);
  std::vector<Chapter> chapters;
  int cases = 0, rows = 0, failing = 0;
  double seconds = 0.0;
  for (const Section& section : sections) {
    Chapter& chapter = chapters.emplace_back();
    chapter.title = section.title;
    for (const Case& one : section.cases) {
      if (!chosen(options, section, one)) continue;
      show_progress(one.name);
      chapter.outcomes.push_back(run_case(one, bench));
      const CaseResult& outcome = chapter.outcomes.back();
      if (cases++ == 0) fmt::print("{}", table_header());
      rows += static_cast<int>(outcome.rows.size());
      failing += outcome.pass() ? 0 : 1;
      seconds += outcome.seconds;
      show_progress("");
      fmt::print("{}", table_text({section.title, {outcome}}, options.rows));
      std::fflush(stdout);
    }
  }
  if (cases == 0) {
    fmt::print(stderr, "sagefe verify: no case matches {}; see sagefe verify --list\n", options.only);
    return kUsage;
  }
  fmt::print(
      "{} cases, {} rows, {} failing; {:.1f} s. Signs: pressures and loads compression positive; forces per "
      "unit "
      "thickness or full circle; consistent units\n",
      cases, rows, failing, seconds);
  if (csv.open()) {
    csv.text() = csv_text(chapters);
    csv.finish();
  }
  if (written.open()) write_book(written, chapters);
  return failing > 0 ? kNotConverged : kOk;
}

}  // namespace

Command verify_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<VerifyOptions>();
  parser.add_flag("--list", options->list, "the cases, computing nothing");
  parser.add_option("--only", options->only, "cases (or sections) whose name contains this");
  parser.add_flag("--rows", options->rows, "every row, not only the one closest to its gate");
  parser.add_option("--csv", options->csv, "all rows as CSV");
  parser
      .add_option("--write", options->write,
                  "the book as Markdown with plots beside it (default docs/verification.md)")
      ->expected(0, 1)
      ->default_str("docs/verification.md");
  return [options, &catalogue] { return run_book(*options, catalogue); };
}

}  // namespace sage::app
