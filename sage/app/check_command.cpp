// sagefe check: reads and validates, draws nothing, solves nothing.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/analysis/initial_balance.hpp"
#include "sage/analysis/scene.hpp"
#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

struct CheckOptions {
  std::vector<std::string> decks;
  InputOptions input;
  std::string solver;
};

// What the run's first stage will let go.
Diagnostics balance_note(const Model& model) {
  Diagnostics notes;
  const InitialImbalance imbalance = initial_imbalance(model);
  if (imbalance.counts())
    notes.note("S528", model.stages.front().where, "stage 1: " + explain_imbalance(model, 0, imbalance));
  return notes;
}

Json deck_json(const std::string& path, const Deck& deck, const Model& model, const Scene& scene, int code) {
  return {{"deck", json_text(path)},
          {"ready", code == kOk},
          {"layout", json_text(deck.layout)},
          {"model", model_json(model, scene)}};
}

int check(const std::string& path, const InputOptions& options, const Catalogue& catalogue) {
  const Task task("check " + case_name(path));
  try {
    const Deck deck = read_input(path, options);
    say_detail(path, fmt::format("layout: {} ({})", deck.layout,
                                 options.layout.empty() ? "found from the deck" : "asked for by --layout"));
    const Model model = build_model(deck, catalogue, options.build);
    print_diagnostics(model.diagnostics);
    print_diagnostics(balance_note(model));
    const Scene scene = analyse_scene(model);
    const ProgressPause pause;
    fmt::print("{}: {} nodes, {} elements in {} groups, {} stages; {}, {}: ready to run{}\n", path,
               model.mesh.nodes(), scene.elements, model.groups.size(), model.stages.size(),
               model.geometry == Geometry::axisymmetric ? "axisymmetric" : "plane strain", describe(scene),
               model.left_out.empty() ? "" : ", but PARTIAL: " + left_out_words(model));
    const int code = options.strict && model.diagnostics.warnings() > 0 ? kInput : kOk;
    if (Json* json = answer()) (*json)["decks"].push_back(deck_json(path, deck, model, scene, code));
    return code;
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    if (Json* json = answer()) (*json)["decks"].push_back({{"deck", json_text(path)}, {"ready", false}});
    return kInput;
  }
}

}  // namespace

Command check_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<CheckOptions>();
  parser.add_option("DECK", options->decks, "deck files")->required();
  add_input_options(parser, options->input);
  add_build_options(parser, options->input.build, catalogue);
  parser.add_option("--solver", options->solver, "solver by name, as for `run`")
      ->check(known_solver(catalogue));
  return [options, &catalogue] {
    int worst = kOk;
    if (!options->solver.empty()) options->input.build.solver = solver_code(catalogue, options->solver);
    for (const std::string& path : options->decks)
      worst = std::max(worst, check(path, options->input, catalogue));
    return worst;
  };
}

}  // namespace sage::app
