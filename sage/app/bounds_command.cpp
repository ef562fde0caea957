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
#include "sage/app/umat_output.hpp"
#include "sage/bounds/bounds_text.hpp"
#include "sage/record/csv.hpp"
#include "sage/safety/safety.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

enum class Wanted { automatic, load, strength };

struct BoundsOptions {
  std::string deck;
  bool safety = false;          // finite elements beside the bounds
  safety::SearchLimits limits;  // of theirs
  int threads = 0;
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
  const Stage& one = model.stages[stage];
  const bool loads = !one.loads.empty() || !one.pressures.empty() || ground.domain.moved();
  const bounds::Quantity quantity =
      options.wanted == Wanted::strength || (options.wanted == Wanted::automatic && !loads)
          ? bounds::Quantity::strength
          : bounds::Quantity::load;
  if (quantity == bounds::Quantity::strength && ground.domain.moved())
    throw InputError(
        "S616", {options.deck, 0, 0, 0},
        fmt::format(
            "stage {} moves supports: a movement is no load that could exceed the strength, and so has no "
            "factor of safety; --of load bounds the force that moves them",
            one.number));
  if (quantity == bounds::Quantity::load && !ground.has_live)
    throw InputError(
        "S574", {options.deck, 0, 0, 0},
        fmt::format("stage {} adds no weight, load or movement of supports that could be multiplied; "
                    "--of strength bounds the factor of safety",
                    one.number));
  return quantity;
}

RunSettings run_settings(const BoundsOptions& options, Task& task) {
  RunSettings settings;
  settings.threads = threads_for(options.threads);
  settings.choose_solver = choose_solver;
  settings.stop_asked = [] { return interrupted(); };
  settings.pulse = task.pulse();
  return settings;
}

// ---- heads of flow elements

// Keeps all unknowns at the start of one stage.
class StartOfStage final : public Observer {
 public:
  explicit StartOfStage(int stage) : stage_(stage) {}
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }
  void on_stage_start(const Model&, int stage, const Solution& now) override {
    if (stage == stage_) unknowns = *now.u;
  }
  Eigen::VectorXd unknowns;  // empty = the run did not come so far

 private:
  int stage_;
};

// Runs the stages before this one where pore pressures need their heads; empty where none do.
Eigen::VectorXd heads_before(const BoundsOptions& options, const Model& model, const Catalogue& catalogue,
                             int stage, Task& task) {
  if (!bounds::wants_heads(model, stage)) return {};
  StartOfStage start(stage);
  RunSettings settings = run_settings(options, task);
  settings.stop_asked = [&] { return interrupted() || start.unknowns.size() > 0; };
  Observer* const observers[] = {&start};
  RunResult result;
  with_umat_output(options.deck, [&] { result = run(model, catalogue, settings, observers); });
  if (start.unknowns.size() == 0)
    throw InputError(
        "S577", {options.deck, 0, 0, 0},
        fmt::format("the heads at the start of stage {} are not known, since the run ended before it: {}",
                    stage + 1, result.reason));
  return std::move(start.unknowns);
}

// ---- finite elements beside the bounds

std::vector<bounds::MovingPart> mechanism_of(const Model& model, const safety::Safety& found) {
  std::vector<bounds::MovingPart> parts;
  if (!found.mechanism) return parts;
  const Solution motion = found.mechanism->view();
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (motion.activity->group[g] == 0 || !group.solid() || group.overlay) continue;
    for (int e = 0; e < group.elements(); ++e) {
      bounds::MovingPart& part = parts.emplace_back();
      for (const std::vector<int>& edge : group.element->edges()) {
        const int node = group.nodes_of(e)[edge[0]];
        part.corner.emplace_back(model.mesh.x.col(node));
        part.motion.emplace_back((*motion.u)[DofMap::displacement(node, 0)],
                                 (*motion.u)[DofMap::displacement(node, 1)]);
      }
    }
  }
  return parts;
}

// Whether psi = phi would change a material.
bool changes_dilation(const Model& deck, const Model& associated) {
  for (std::size_t m = 0; m < deck.materials.size(); ++m)
    if (deck.materials[m].parameters != associated.materials[m].parameters) return true;
  return false;
}

bounds::OtherAnswer answer_of(const BoundsOptions& options, const Catalogue& catalogue, Model& model,
                              const bounds::Bounds& found, Task& task) {
  safety::Options search;
  search.limits = options.limits;
  // Ground that fails as it is: the search begins below.
  if (found.lower.value)
    search.limits.start = std::clamp(0.9 * *found.lower.value, search.limits.smallest, 1.0);
  search.stage = options.stage - 1;
  search.reduce = {ModelPart::soil, ModelPart::joints};  // as the bounds do
  safety::Safety safety;
  with_umat_output(options.deck, [&] {
    safety = safety::find_safety(model, catalogue, run_settings(options, task), search);
  });
  bounds::OtherAnswer answer;
  answer.lower = safety.lower;
  answer.upper = safety.upper;
  answer.remark = safety.incomplete;
  answer.mechanism = mechanism_of(model, safety);
  return answer;
}

// With psi = phi, and with the deck's psi where that is another.
// model: of the deck; the search for a factor changes those that it is given.
std::vector<bounds::OtherAnswer> finite_elements(const BoundsOptions& options, const Catalogue& catalogue,
                                                 const Deck& deck, const Model& model,
                                                 const bounds::Bounds& found, Task& task) {
  std::vector<bounds::OtherAnswer> answers;
  if (!options.safety || found.stopped) return answers;
  BuildOptions build = options.input.build;
  build.associated = true;
  Model associated = build_model(deck, catalogue, build);
  const bool two = changes_dilation(model, associated);
  answers.push_back(answer_of(options, catalogue, associated, found, task));
  answers.back().name = "finite elements, psi = phi";
  if (!two) return answers;
  Model own = build_model(deck, catalogue, options.input.build);
  answers.push_back(answer_of(options, catalogue, own, found, task));
  answers.back().name = "finite elements, psi of the deck";
  answers.back().associated = false;
  return answers;
}

Json bound_json(const bounds::Bound& bound) {
  return {{"value", bound.value ? Json(*bound.value) : Json(nullptr)},
          {"reason", json_text(bound.reason)},
          {"margin", bound.margin},
          {"residual", bound.residual},
          {"reserve", bound.reserve}};
}

Json bounds_json(const BoundsOptions& options, bounds::Quantity quantity, const bounds::Ground& ground,
                 const bounds::Bounds& found, const std::vector<bounds::OtherAnswer>& others) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json meshes = Json::array(), answers = Json::array();
  for (const bounds::OtherAnswer& other : others)
    answers.push_back({{"answer", other.name},
                       {"associated", other.associated},
                       {"lower", number(other.lower)},
                       {"upper", number(other.upper)},
                       {"incomplete", json_text(other.remark)}});
  for (const bounds::Round& round : found.rounds)
    meshes.push_back(
        {{"triangles", round.triangles}, {"lower", number(round.lower)}, {"upper", number(round.upper)}});
  return {{"deck", json_text(options.deck)},      {"quantity", bounds::quantity_words(found.domain, quantity)},
          {"lower", bound_json(found.lower)},     {"upper", bound_json(found.upper)},
          {"notes", json_list(ground.notes)},     {"meshes", std::move(meshes)},
          {"finite_elements", std::move(answers)}};
}

int exit_code_of(const BoundsOptions& options, const bounds::Bounds& found,
                 const std::vector<bounds::OtherAnswer>& others) {
  if (found.stopped || interrupted()) {
    say_error(options.deck, "interrupted: what was found so far stands above", "S511");
    return kInterrupted;
  }
  int code = kOk;
  if (!found.lower.value || !found.upper.value) {
    const bool lower = !found.lower.value;
    say_error(options.deck,
              fmt::format("there is no {} bound: {}", lower ? "lower" : "upper",
                          lower ? found.lower.reason : found.upper.reason),
              "S575");
    code = kNotConverged;
  }
  for (const bounds::OtherAnswer& other : others) {
    if (!other.remark.empty()) say_error(options.deck, other.name + ": " + other.remark, "S515");
    if (bounds::contradicts(found, other))
      say_error(options.deck,
                fmt::format("{} find no equilibrium at {:.6g}, below the lower bound {:.6g}", other.name,
                            *other.upper, *found.lower.value),
                "S578");
    if (!other.remark.empty() || bounds::contradicts(found, other)) code = kNotConverged;
  }
  return code;
}

std::vector<std::filesystem::path> write_results(const BoundsOptions& options, const Model& model,
                                                 const std::string& text, const bounds::Bounds& found,
                                                 const std::vector<bounds::OtherAnswer>& others) {
  std::vector<std::filesystem::path> files;
  const auto write = [&](const char* ending, const std::string& content) {
    files.push_back(options.folder / (case_name(options.deck) + ending));
    write_file(files.back(), content);
  };
  const bounds::Quantity quantity = options.search.quantity;
  write(".bounds.lst", text);
  write(".bounds.csv", bounds::to_csv(found, options.digits));
  write(".bounds.fields.csv", bounds::fields_csv(found, options.digits));
  write(".bounds.vtu", bounds::fields_vtu(found, quantity));
  write(".bounds.svg", bounds::fields_svg(model, quantity, found, others));
  if (options.safety) write(".bounds.safety.csv", bounds::answers_csv(found, others, options.digits));
  return files;
}

int run_bounds(BoundsOptions options, const Catalogue& catalogue) {
  if (options.safety && options.wanted == Wanted::load)
    throw UsageError("S904",
                     "--safety compares factors of safety; it goes with --of strength, not with --of load");
  if (options.safety) options.wanted = Wanted::strength;
  return guarded(options.deck, [&] {
    keep_input(options.deck);
    const InterruptWatch watch;
    ResultFiles results(options.folder, case_name(options.deck) + ".bounds", {options.deck, 0, "bounds"});
    Task task(options.deck);
    const Deck deck = read_input(options.deck, options.input);
    const Model model = build_model(deck, catalogue, options.input.build);
    print_diagnostics(model.diagnostics);
    if (options.input.strict && model.diagnostics.warnings() > 0)
      throw InputError("S906", {options.deck, 0, 0, 0}, "warnings count as errors (--strict)");
    const int stage = stage_of(options, model);
    const Eigen::VectorXd heads = heads_before(options, model, catalogue, stage, task);
    bounds::Ground ground = bounds::make_ground(model, first_live(options, stage), stage,
                                                heads.size() > 0 ? &heads : nullptr, options.search.elements);
    const bounds::Quantity quantity = quantity_of(options, model, stage, ground);
    if (quantity == bounds::Quantity::strength)
      ground.domain = bounds::reduced(ground.domain, 1.0 / ground.stated_factor);
    options.search.quantity = quantity;
    options.search.stop_asked = [] { return interrupted(); };
    const bounds::Bounds found = bounds::find_bounds(ground.domain, options.search);
    const std::vector<bounds::OtherAnswer> others =
        finite_elements(options, catalogue, deck, model, found, task);
    const std::string text = bounds::to_text(model, ground, quantity, found, others);
    const std::vector<std::filesystem::path> files = write_results(options, model, text, found, others);
    say_left(options.deck, results.close());
    const ProgressPause pause;
    fmt::print("{}", text);
    print_files(files);
    if (Json* json = answer()) {
      *json = bounds_json(options, quantity, ground, found, others);
      (*json)["files"] = files_json(files);
    }
    return exit_code_of(options, found, others);
  });
}

constexpr const char* kBoundsExamples =
    "Examples:\n"
    "  sagefe bounds slope.dat\n"
    "      lower and upper bound on the factor of safety, stress field and mechanism\n"
    "  sagefe bounds slope.dat --safety\n"
    "      and what sagefe safety finds, with psi = phi and with the deck's psi, in one table and one picture\n"
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
          "default: load if the stage adds loads or moves supports, else strength)")
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
      .add_option("--elements", o->search.elements,
                  "number of triangles up to which the mesh is refined where the bounds differ (default 2000; "
                  "0: no refinement)")
      ->check(CLI::Range(0, 200'000));
  parser
      .add_option("--gap", o->search.gap,
                  "relative difference of the bounds at which refining ends (default 0.01)")
      ->check(number_in(1e-4, 1.0, "a relative distance from 0.0001 to 1"));
  parser.add_flag("--safety", o->safety,
                  "add finite elements: factor of safety by strength reduction with psi = phi and with "
                  "the deck's psi");
  parser
      .add_option("--tolerance", o->limits.tolerance,
                  "with --safety: width of the bracket of finite elements (default 0.005)")
      ->check(number_in(1e-8, 1.0, "a width from 1e-8 to 1"));
  add_threads_option(parser, o->threads);
  add_digits_option(parser, o->digits);
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  add_input_options(parser, o->input);
  add_build_options(parser, o->input.build, catalogue);
  return [o, &catalogue] { return run_bounds(*o, catalogue); };
}

}  // namespace sage::app
