// sagefe-figures: the program behind `sagefe figures`: the source chapter's figures 7.1 to 7.40, with verdicts on what it says about them.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/picture_formats.hpp"
#include "sage/app/program.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/studies.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/out_file.hpp"
#include "tests/studies/figures/page.hpp"
#include "tests/studies/figures/pictures.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::app {

namespace {

std::vector<int> chosen_figures(const FiguresOptions& options) {
  std::vector<int> chosen;
  for (const std::string& text : options.only) chosen.push_back(figure_from(text));
  if (chosen.empty())
    for (const figures::Caption& caption : figures::captions()) chosen.push_back(caption.figure);
  return chosen;
}

std::vector<figures::Check> checks_of(const std::vector<int>& chosen) {
  std::vector<figures::Check> list;
  for (const figures::Check& check : figures::checks())
    if (std::ranges::find(chosen, check.figure) != chosen.end()) list.push_back(check);
  return list;
}

Json check_json(const figures::Check& check) {
  return {{"figure", fmt::format("7.{}", check.figure)},
          {"quote", json_text(check.quote)},
          {"limits", json_text(figures::limits_of(check))}};
}

Json result_json(const figures::Result& result) {
  Json outcomes = Json::array();
  for (const figures::Outcome& outcome : result.outcomes) {
    const auto side = [&](std::size_t elements) {
      return Json{{"everywhere", outcome.number[elements][0]},
                  {"everywhere_passes", outcome.pass[elements][0]},
                  {"away_from_corner", outcome.number[elements][1]},
                  {"away_from_corner_passes", outcome.pass[elements][1]}};
    };
    outcomes.push_back({{"k_j", outcome.k_j > 0.0 ? Json(outcome.k_j) : Json(nullptr)},
                        {"full", side(0)},
                        {"b_bar", side(1)}});
  }
  Json json = check_json(*result.check);
  json["what"] = json_text(figures::what_of(*result.check));
  json["verdict"] = figures::name_of(result.verdict);
  json["near_limit"] = result.near_limit;
  json["b_bar_only"] = result.b_bar_only;
  json["outcomes"] = std::move(outcomes);
  return json;
}

int list_figures(const std::vector<int>& chosen) {
  for (int figure : chosen) {
    fmt::print("7.{}  {}\n", figure, figures::caption_of(figure).title);
    for (const figures::Check& check : figures::checks())
      if (check.figure == figure) {
        if (Json* json = answer()) (*json)["checks"].push_back(check_json(check));
        fmt::print("      \"{}\": {}\n", check.quote, figures::limits_of(check));
      }
  }
  return kOk;
}

// K_j of Table 7.2, about the one that Table 7.3 needs, and the one that meets Figure 7.18 if there is one.
std::vector<figures::StiffnessChoice> stiffness_choices(const scenes::Workbench& bench) {
  std::vector<figures::StiffnessChoice> choices{{"Table 7.2", 120.0}, {"about that of Table 7.3", 5.0}};
  if (const double fitted = figures::fitted_k_j(bench); fitted > 0.0)
    choices.push_back({"3 percent in Figure 7.18", fitted});
  return choices;
}

bool any_lubricated(const std::vector<figures::Check>& checks) {
  return std::ranges::any_of(
      checks, [](const figures::Check& check) { return figures::scene_named(check.a.scene).lubricated(); });
}

int run_figures(const FiguresOptions& options, const Catalogue& catalogue) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<int> chosen = chosen_figures(options);
  if (options.list) return list_figures(chosen);
  require_converter(options.formats);
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error)
    throw OutputError("S601", "the folder " + options.folder.string() + " can't be made: " + error.message());

  Task task("figures");
  const scenes::Workbench bench = make_workbench(catalogue);
  figures::Runs runs(bench);
  const std::vector<figures::Check> checks = checks_of(chosen);
  const std::vector<figures::StiffnessChoice> choices =
      any_lubricated(checks) ? stiffness_choices(bench) : std::vector<figures::StiffnessChoice>{};
  figures::Evaluation all{chosen, figures::evaluate(runs, checks, choices), {}};
  if (options.only.empty()) all.stiffness = figures::stiffness_rows(runs, choices);
  int number = 0;
  for (int figure : chosen) {
    task.part(fmt::format("figure 7.{}", figure), ++number, static_cast<int>(chosen.size()));
    const std::filesystem::path file = options.folder / figures::file_of(figure);
    write_file(file, figures::figure_svg(figure, runs, choices));
    const ProgressPause pause;
    answer_file(file);
    for (const std::filesystem::path& other : convert_picture(file, options.formats)) answer_file(other);
    fmt::print("{}  {}\n", file.string(), figures::tally(all.results, figure));
  }
  write_file(options.folder / "figures.md", figures::page_text(all, "svg"));
  write_file(options.folder / "figures.csv", figures::csv_text(all.results));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (Json* json = answer()) {
    for (const figures::Result& result : all.results) (*json)["checks"].push_back(result_json(result));
    (*json)["runs"] = runs.size();
    (*json)["page"] = json_text((options.folder / "figures.md").string());
  }
  const ProgressPause pause;
  fmt::print("{} checks: {}\n{} runs, {:.1f} s; {}\n", all.results.size(), figures::tally(all.results, 0),
             runs.size(), seconds.count(), (options.folder / "figures.md").string());
  return kOk;
}

}  // namespace

}  // namespace sage::app

int main(int argc, char** argv) {
  sage::app::studies().figures = sage::app::run_figures;
  return sage::sagefe(argc, argv);
}
