// sagefe stress: the stability stress test.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <cstdio>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/record/out_file.hpp"
#include "sage/stress/report.hpp"

namespace sage::app {

namespace {

struct StressOptions {
  std::vector<std::string> only;
  bool list = false, details = false;
  std::string csv, page;
};

int list_rows(const std::vector<stress::Row>& rows) {
  for (const stress::Row& row : rows)
    fmt::print("{:<22} {}\n{:<22}   reference: {}\n", row.name, row.title, "", row.reference);
  return kOk;
}

int run_rows(const StressOptions& options, const Catalogue& catalogue) {
  std::vector<stress::Row> rows = stress::all_rows();
  for (const std::string& name : options.only)
    if (std::none_of(rows.begin(), rows.end(), [&](const stress::Row& row) { return row.name == name; })) {
      fmt::print(stderr, "sagefe stress: no row is called {}; see --list\n", name);
      return kUsage;
    }
  if (!options.only.empty())
    std::erase_if(rows, [&](const stress::Row& row) {
      return std::find(options.only.begin(), options.only.end(), row.name) == options.only.end();
    });
  if (options.list) return list_rows(rows);
  const scenes::Workbench bench = make_workbench(catalogue);
  std::vector<stress::RowResult> results;
  int failed = 0;
  fmt::print("{}", stress::heading());
  for (const stress::Row& row : rows) {
    results.push_back(stress::evaluate(row, bench));
    failed += results.back().ok() ? 0 : 1;
    fmt::print("{}", stress::row_text(row, results.back(), options.details));
    std::fflush(stdout);
  }
  fmt::print(
      "{} rows, {} failed. Digits lost = log10(error / 1.1e-16) of 16. Not part of the program, so not tested: "
      "consolidation.\n",
      rows.size(), failed);
  if (!options.csv.empty()) write_file(options.csv, stress::to_csv(rows, results));
  if (!options.page.empty()) {
    const std::filesystem::path page(options.page), folder = page.parent_path() / page.stem();
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (const std::string svg = stress::plot(rows[i], results[i]); !svg.empty())
        write_file(folder / (rows[i].name + ".svg"), svg);
    write_file(page, stress::to_markdown(rows, results, page.stem().string()));
  }
  return failed == 0 ? kOk : kNotConverged;
}

}  // namespace

Command stress_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<StressOptions>();
  parser.add_flag("--list", options->list, "the rows and their references; computes nothing");
  parser.add_option("--only", options->only, "these rows only");
  parser.add_flag("--details", options->details, "every trial, not only those that failed");
  parser.add_option("--csv", options->csv, "write every trial to this file");
  parser.add_option("--write", options->page, "write a Markdown page, and plots into a folder beside it");
  return [options, &catalogue] { return run_rows(*options, catalogue); };
}

}  // namespace sage::app
