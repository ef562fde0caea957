// sagefe-stress: the program behind `sagefe stress`, the stability stress test.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/program.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/studies.hpp"
#include "sage/record/out_file.hpp"
#include "tests/studies/stress/report.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::app {

namespace {

Json row_json(const stress::Row& row) {
  return {{"name", row.name},
          {"family", json_text(row.family)},
          {"title", json_text(row.title)},
          {"reference", json_text(row.reference)}};
}

// NaN where a trial has no such number.
Json result_json(const stress::Row& row, const stress::RowResult& result) {
  Json trials = Json::array();
  for (const stress::Trial& trial : result.trials)
    trials.push_back({{"label", json_text(trial.label)},
                      {"parameter", trial.parameter},
                      {"expected", json_text(trial.expected)},
                      {"outcome", json_text(trial.outcome)},
                      {"error", trial.error},
                      {"allowed", trial.allowed},
                      {"digits_lost", trial.digits_lost()},
                      {"ok", trial.ok}});
  Json json = row_json(row);
  json["ok"] = result.ok();
  json["thrown"] = json_text(result.thrown);
  json["seconds"] = result.seconds;
  json["trials"] = std::move(trials);
  return json;
}

void answer_row(Json row) {
  if (Json* json = answer()) (*json)["rows"].push_back(std::move(row));
}

int list_rows(const std::vector<stress::Row>& rows) {
  for (const stress::Row& row : rows) {
    if (screen().json) answer_row(row_json(row));
    fmt::print("{:<22} {}\n{:<22}   reference: {}\n", row.name, row.title, "", row.reference);
  }
  return kOk;
}

int run_rows(const StressOptions& options, const Catalogue& catalogue) {
  std::vector<stress::Row> rows = stress::all_rows();
  for (const std::string& name : options.only)
    if (std::none_of(rows.begin(), rows.end(), [&](const stress::Row& row) { return row.name == name; })) {
      say_error("sagefe stress", "no row is called " + name + "; see --list", "S904");
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
  Task task("stress");
  for (const stress::Row& row : rows) {
    task.part(row.name, static_cast<int>(results.size()) + 1, static_cast<int>(rows.size()));
    results.push_back(stress::evaluate(row, bench));
    failed += results.back().ok() ? 0 : 1;
    if (screen().json) answer_row(result_json(row, results.back()));
    const ProgressPause pause;
    fmt::print("{}", stress::row_text(row, results.back(), options.details));
    std::fflush(stdout);
  }
  if (Json* json = answer()) json->update({{"row_count", rows.size()}, {"failed", failed}});
  fmt::print("{} rows, {} failed. Digits lost = log10(error / 1.1e-16) of 16.\n", rows.size(), failed);
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

}  // namespace sage::app

int main(int argc, char** argv) {
  sage::app::studies().stress = sage::app::run_rows;
  return sage::sagefe(argc, argv);
}
