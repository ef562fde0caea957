// sagefe bounds: rigorous bounds on collapse loads and factors of safety.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/screen.hpp"
#include "sage/bounds/bounds_text.hpp"
#include "sage/record/csv.hpp"

namespace sage::app {

namespace {

enum class Wanted { automatic, load, strength };

struct BoundsOptions {
  std::string deck;
  InputOptions input;
  bounds::Options search;
  Wanted wanted = Wanted::automatic;
  int stage = 0;  // from 1; 0 = the last
  int from = 0;   // first stage whose loads are multiplied, from 1; 0 = that stage
  int digits = kCsvDigits;
  std::filesystem::path folder = "out";
};

int stage_of(const BoundsOptions& options, const Model& model) {
  const int stages = static_cast<int>(model.stages.size()), stage = options.stage == 0 ? stages : options.stage;
  if (stage < 1 || stage > stages)
    throw InputError("S574", {options.deck, 0, 0, 0},
                     fmt::format("--stage {}: the deck has {} stages", options.stage, stages));
  return stage - 1;
}

int first_live(const BoundsOptions& options, int stage) {
  if (options.from > stage + 1)
    throw InputError("S574", {options.deck, 0, 0, 0},
                     fmt::format("--from {}: later than stage {}", options.from, stage + 1));
  return options.from == 0 ? stage : options.from - 1;
}

// A stage that adds loads or moves supports asks for a load, one that adds weight alone for a factor of safety.
bounds::Quantity quantity_of(const BoundsOptions& options, const Model& model, int stage,
                             const bounds::Ground& ground) {
  const Stage& one = model.stages[static_cast<std::size_t>(stage)];
  const bool loads = !one.loads.empty() || !one.pressures.empty() || ground.domain.moved();
  const bounds::Quantity quantity =
      options.wanted == Wanted::strength || (options.wanted == Wanted::automatic && !loads)
          ? bounds::Quantity::strength
          : bounds::Quantity::load;
  if (quantity == bounds::Quantity::load && !ground.has_live)
    throw InputError(
        "S574", {options.deck, 0, 0, 0},
        fmt::format("stage {} adds no weight, load or movement of supports that could be multiplied; "
                    "--of strength bounds the factor of safety",
                    one.number));
  return quantity;
}

Json bound_json(const bounds::Bound& bound) {
  return {{"value", bound.value ? Json(*bound.value) : Json(nullptr)},
          {"reason", json_text(bound.reason)},
          {"margin", bound.margin},
          {"residual", bound.residual},
          {"reserve", bound.reserve}};
}

Json bounds_json(const BoundsOptions& options, bounds::Quantity quantity, const bounds::Ground& ground,
                 const bounds::Bounds& found) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json meshes = Json::array();
  for (const bounds::Round& round : found.rounds)
    meshes.push_back(
        {{"triangles", round.triangles}, {"lower", number(round.lower)}, {"upper", number(round.upper)}});
  return {{"deck", json_text(options.deck)},  {"quantity", bounds::quantity_words(found.domain, quantity)},
          {"lower", bound_json(found.lower)}, {"upper", bound_json(found.upper)},
          {"notes", json_list(ground.notes)}, {"meshes", std::move(meshes)}};
}

int exit_code_of(const BoundsOptions& options, const bounds::Bounds& found) {
  if (found.stopped) {
    say_error(options.deck, "interrupted: what was found so far stands above", "S511");
    return kInterrupted;
  }
  if (found.lower.value && found.upper.value) return kOk;
  const bool lower = !found.lower.value;
  say_error(options.deck,
            fmt::format("there is no {} bound: {}", lower ? "lower" : "upper",
                        lower ? found.lower.reason : found.upper.reason),
            "S575");
  return kNotConverged;
}

int run_bounds(BoundsOptions options, const Catalogue& catalogue) {
  return guarded(options.deck, [&] {
    keep_input(options.deck);
    const InterruptWatch watch;
    ResultFiles results(options.folder, case_name(options.deck) + ".bounds", {options.deck, 0, "bounds"});
    Task task(options.deck);
    const Model model = build_model(read_input(options.deck, options.input), catalogue, options.input.build);
    print_diagnostics(model.diagnostics);
    if (options.input.strict && model.diagnostics.warnings() > 0)
      throw InputError("S906", {options.deck, 0, 0, 0}, "warnings count as errors (--strict)");
    const int stage = stage_of(options, model);
    const bounds::Ground ground = bounds::make_ground(model, first_live(options, stage), stage);
    options.search.quantity = quantity_of(options, model, stage, ground);
    options.search.stop_asked = [] { return interrupted(); };
    const bounds::Bounds found = bounds::find_bounds(ground.domain, options.search);
    const bounds::Quantity quantity = options.search.quantity;
    const std::string text = bounds::to_text(model, ground, quantity, found);
    std::vector<std::filesystem::path> files;
    const auto write = [&](const char* ending, const std::string& content) {
      files.push_back(options.folder / (case_name(options.deck) + ending));
      write_file(files.back(), content);
    };
    write(".bounds.lst", text);
    write(".bounds.csv", bounds::to_csv(found, options.digits));
    write(".bounds.fields.csv", bounds::fields_csv(found, options.digits));
    write(".bounds.svg", bounds::fields_svg(model, quantity, found));
    say_left(options.deck, results.close());
    const ProgressPause pause;
    fmt::print("{}", text);
    print_files(files);
    if (Json* json = answer()) {
      *json = bounds_json(options, quantity, ground, found);
      (*json)["files"] = files_json(files);
    }
    return exit_code_of(options, found);
  });
}

constexpr const char* kBoundsExamples =
    "Examples:\n"
    "  sagefe bounds slope.dat\n"
    "      lower and upper bound on the factor of safety, stress field and mechanism\n"
    "  sagefe bounds footing.dat --of load --elements 4000\n"
    "  sagefe bounds footing.dat --elements 0\n"
    "      on the mesh of the deck, its quadrilaterals divided into four triangles";

}  // namespace

Command bounds_command(CLI::App& parser, const Catalogue& catalogue) {
  parser.footer(std::string(kBoundsExamples) + "\n\n" + parser.get_footer());
  auto o = std::make_shared<BoundsOptions>();
  static const std::map<std::string, Wanted> wanted{
      {"auto", Wanted::automatic}, {"load", Wanted::load}, {"strength", Wanted::strength}};
  parser.add_option("DECK", o->deck, "deck to be analysed")->required();
  parser
      .add_option_function<std::string>(
          "--of", [o](const std::string& name) { o->wanted = wanted.at(name); },
          "what is bounded: load (multiplier of what the stage adds), strength (factor of safety), auto (the "
          "default: "
          "load where the stage adds loads or moves supports)")
      ->check(CLI::IsMember(wanted));
  parser
      .add_option("--stage", o->stage,
                  "last stage whose loads act, and are multiplied, from 1 (default: the deck's last)")
      ->check(CLI::Range(1, 100'000));
  parser
      .add_option("--from", o->from,
                  "first stage whose loads are multiplied, from 1 (default: that of --stage)")
      ->check(CLI::Range(1, 100'000));
  parser
      .add_option(
          "--elements", o->search.elements,
          "triangles up to which the mesh is refined where the bounds part (default 2000; 0: not refined)")
      ->check(CLI::Range(0, 200'000));
  parser
      .add_option("--gap", o->search.gap, "relative distance of the bounds that ends refining (default 0.01)")
      ->check(number_in(1e-4, 1.0, "a relative distance from 0.0001 to 1"));
  add_digits_option(parser, o->digits);
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  add_input_options(parser, o->input);
  add_build_options(parser, o->input.build, catalogue);
  return [o, &catalogue] { return run_bounds(*o, catalogue); };
}

}  // namespace sage::app
