// sagefe safety: factor of safety by strength reduction.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/large_heap.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/csv.hpp"
#include "sage/record/profile_text.hpp"
#include "sage/safety/critical_kh.hpp"
#include "sage/safety/safety_text.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

using safety::FactorTrial;
using safety::Safety;

struct SafetyOptions {
  std::string deck, solver;
  InputOptions input;
  safety::Options search;
  int stage = 0;  // from 1; 0 = the last
  int threads = 0;
  Kernels kernels = Kernels::automatic;
  double converge = 0.0;  // change of the factor from mesh to mesh, relative; 0 = one mesh
  int max_dofs = 60'000;
  int digits = kCsvDigits;
  std::filesystem::path folder = "out";
  bool profile = false;
  std::string earthquake;  // "left", "right": search of the critical k_h; empty = none
};

// One mesh and what was found on it.
struct MeshResult {
  std::string options;  // "--refine 1"; empty = the deck's
  int elements = 0, dofs = 0;
  std::unique_ptr<Model> model;
  Safety found;
  double middle() const { return 0.5 * (*found.lower + *found.upper); }
};

// Of the result files: the deck's name, with that of the set of factors.
std::string stem_of(const SafetyOptions& options) {
  std::string stem = case_name(options.deck);
  for (const PartialFactors& set : options.input.build.factors) stem += "." + factor_word(set);
  return stem;
}

// What was found in the deck.  Throws InputError where warnings count.
void report(const SafetyOptions& options, const Diagnostics& found) {
  print_diagnostics(found);
  if (options.input.strict && found.warnings() > 0)
    throw InputError("S906", {options.deck, 0, 0, 0}, "warnings count as errors (--strict)");
}

// What the factor has to reach under the partial factors of the options.
std::string requirement(const SafetyOptions& options, const Safety& found) {
  if (options.input.build.factors.empty()) return {};
  const PartialFactors& set = options.input.build.factors.front();
  const double required = set.required();
  const char* const verdict = found.lower && *found.lower >= required   ? "fulfilled"
                              : found.upper && *found.upper <= required ? "NOT fulfilled"
                                                                        : "not decided";
  return fmt::format(
      "\nfactors {}: strengths and loads have their design values; the factor has to reach {:.5g} "
      "(effects x resistance): {}\n",
      set.name, required, verdict);
}

MeshResult find_on_mesh(const SafetyOptions& options, const Catalogue& catalogue, int refine, Task& task,
                        double kh = 0.0) {
  const Deck deck = read_input(options.deck, options.input);
  BuildOptions build = options.input.build;
  if (!options.solver.empty()) build.solver = solver_code(catalogue, options.solver);
  build.refine += refine;
  build.dilates = options.search.dilation != DilationRule::none;
  MeshResult result;
  if (refine > 0) result.options = fmt::format("--refine {}", build.refine);
  result.model = std::make_unique<Model>(build_model(deck, catalogue, build));
  if (refine == 0 && kh == 0.0) report(options, result.model->diagnostics);
  for (const Group& group : result.model->groups) result.elements += group.elements();
  result.dofs = DofMap(*result.model).dofs();
  if (refine > 0 && result.dofs > options.max_dofs) return result;
  RunSettings settings;
  settings.threads = threads_for(options.threads);
  settings.kernels = options.kernels;
  settings.choose_solver = choose_solver;
  settings.stop_asked = [] { return interrupted(); };
  settings.pulse = task.pulse();
  safety::Options search = options.search;
  search.stage = options.stage - 1;
  if (kh != 0.0) search.stage = safety::add_earthquake(*result.model, search.stage, kh);
  with_umat_output(options.deck,
                   [&] { result.found = safety::find_safety(*result.model, catalogue, settings, search); });
  return result;
}

// The deck's mesh, and with --converge finer ones until the factor changes no more than asked for.
struct Meshes {
  std::vector<MeshResult> done;
  double change = 0.0;  // of the bracket's middle from the last mesh but one, relative
  std::string ended;    // why no finer mesh came; empty = certain enough, or not asked for
};

bool has_bracket(const MeshResult& mesh) {
  return mesh.found.lower && mesh.found.upper;
}

Meshes find_on_meshes(const SafetyOptions& options, const Catalogue& catalogue) {
  Task task(options.deck);
  Meshes meshes;
  meshes.done.push_back(find_on_mesh(options, catalogue, 0, task));
  for (int refine = 1; options.converge > 0.0; ++refine) {
    const MeshResult& last = meshes.done.back();
    if (last.found.stopped || !has_bracket(last)) {
      meshes.ended = "there is no bracket on this mesh";
      break;
    }
    MeshResult finer = find_on_mesh(options, catalogue, refine, task);
    if (finer.dofs > options.max_dofs) {
      meshes.ended =
          fmt::format("the next mesh has {} dofs, more than --max-dofs {}", finer.dofs, options.max_dofs);
      break;
    }
    const double before = last.middle();
    meshes.done.push_back(std::move(finer));
    if (!has_bracket(meshes.done.back())) continue;
    meshes.change = meshes.done.back().middle() / before - 1.0;
    if (std::abs(meshes.change) <= options.converge) break;
  }
  return meshes;
}

std::string mesh_table(const SafetyOptions& options, const Meshes& meshes) {
  std::string text =
      fmt::format("mesh effect\n{:>10}{:>10}{:>12}{:>12}  options\n", "elements", "dofs", "lower", "upper");
  for (const MeshResult& mesh : meshes.done)
    text += fmt::format("{:>10}{:>10}{:>12}{:>12}  {}\n", mesh.elements, mesh.dofs,
                        mesh.found.lower ? fmt::format("{:.6g}", *mesh.found.lower) : "-",
                        mesh.found.upper ? fmt::format("{:.6g}", *mesh.found.upper) : "-",
                        mesh.options.empty() ? "the deck's mesh" : mesh.options);
  if (meshes.done.size() > 1)
    text += fmt::format(
        "  the last mesh changed the factor by {:+.2g} % (bracket {:.2g} %, asked for {:.2g} %)\n",
        100.0 * meshes.change, 100.0 * options.search.limits.tolerance / meshes.done.back().middle(),
        100.0 * options.converge);
  if (!meshes.ended.empty()) text += "  NOT REACHED: " + meshes.ended + "\n";
  return text;
}

Json trial_json(const Model& model, const FactorTrial& trial) {
  Json json = {{"factor", trial.factor},
               {"from", trial.from},
               {"verdict", safety::verdict_word(trial.verdict)},
               {"reason", json_text(trial.reason)},
               {"displacement", trial.displacement},
               {"node", nullptr},
               {"out_of_balance", trial.out_of_balance},
               {"released", trial.released},
               {"iterations", trial.iterations},
               {"cuts", trial.cuts},
               {"yielding", trial.yielded}};
  if (trial.node >= 0) json["node"] = model.mesh.number[trial.node];
  return json;
}

Json json_or_null(std::optional<double> value) {
  return value ? Json(*value) : Json(nullptr);
}

Json safety_json(const SafetyOptions& options, const Meshes& meshes) {
  const MeshResult& last = meshes.done.back();
  const Safety& found = last.found;
  Json trials = Json::array(), table = Json::array();
  for (const FactorTrial& trial : found.trials) trials.push_back(trial_json(*last.model, trial));
  Json reduce = Json::array(), fails = Json::array();
  for (const PartName& row : kParts)
    if (options.search.divides(row.part)) reduce.push_back(row.name);
  for (const safety::Failing& part : found.failing) {
    const Group& group = last.model->groups[part.group];
    fails.push_back({{"part", name_of(part_of(group).value_or(ModelPart::soil))},
                     {"group", group.number},
                     {"name", json_text(group.name)},
                     {"share", part.share}});
  }
  for (const MeshResult& mesh : meshes.done)
    table.push_back({{"elements", mesh.elements},
                     {"dofs", mesh.dofs},
                     {"lower", json_or_null(mesh.found.lower)},
                     {"upper", json_or_null(mesh.found.upper)},
                     {"options", mesh.options}});
  Json json = {{"deck", json_text(options.deck)},
               {"lower", json_or_null(found.lower)},
               {"upper", json_or_null(found.upper)},
               {"complete", found.complete()},
               {"incomplete", json_text(found.incomplete)},
               {"divided", json_list(found.reduced)},
               {"not_divided", json_list(found.untouched)},
               {"reduce", std::move(reduce)},
               {"fails", std::move(fails)},
               {"trials", std::move(trials)},
               {"meshes", std::move(table)}};
  if (!options.input.build.factors.empty()) json["required"] = options.input.build.factors.front().required();
  return json;
}

std::vector<std::filesystem::path> write_files(const SafetyOptions& options, const MeshResult& mesh,
                                               const std::string& text) {
  const std::string stem = stem_of(options);
  std::vector<std::filesystem::path> files;
  const auto write = [&](const char* ending, const std::string& content) {
    if (content.empty()) return;
    files.push_back(options.folder / (stem + ending));
    write_file(files.back(), content);
  };
  std::string listing = text;
  for (const FactorTrial& trial : mesh.found.trials)
    if (!trial.page.empty()) listing += fmt::format("\nF = {:.6g}: {}", trial.factor, trial.page);
  write(".safety.lst", listing);
  write(".safety.csv", safety::to_csv(*mesh.model, mesh.found, options.digits));
  write(".safety.svg", safety::curve_svg(*mesh.model, mesh.found));
  write(".mechanism.svg", safety::mechanism_svg(*mesh.model, mesh.found));
  return files;
}

int exit_code_of(const SafetyOptions& options, const Meshes& meshes) {
  const Safety& found = meshes.done.back().found;
  if (found.stopped) {
    say_error(options.deck, "interrupted: what was found so far stands above", "S511");
    return kInterrupted;
  }
  if (!found.complete()) say_error(options.deck, found.incomplete, "S515");
  if (found.complete() && !meshes.ended.empty())
    say_error(options.deck, "--converge was not reached: " + meshes.ended, "S515");
  return found.complete() && meshes.ended.empty() ? kOk : kNotConverged;
}

int find_one(const SafetyOptions& options, const Catalogue& catalogue) {
  return guarded(options.deck, [&] {
    if (options.converge > 0.0) require_file(options.deck, "--converge");
    keep_input(options.deck);
    const InterruptWatch watch;  // before the first file, so that none stays behind under a temporary name
    ResultFiles results(options.folder, stem_of(options) + ".safety", {options.deck, 0, "safety"});
    keep_heap_in_large_pages();
    const Meshes meshes = find_on_meshes(options, catalogue);
    const MeshResult& last = meshes.done.back();
    std::string text = safety::to_text(*last.model, options.search, last.found);
    if (options.converge > 0.0) text += mesh_table(options, meshes);
    text += requirement(options, last.found);
    const std::vector<std::filesystem::path> files = write_files(options, last, text);
    say_left(options.deck, results.close());
    const ProgressPause pause;
    fmt::print("{}", text);
    if (options.profile) fmt::print("\n{}\n", profile_table(last.found.profile));
    print_files(files);
    if (Json* json = answer()) {
      *json = safety_json(options, meshes);
      (*json)["phases"] = Json::parse(profile_json(last.found.profile, "", 0, ""))["run"];
      (*json)["files"] = files_json(files);
    }
    return exit_code_of(options, meshes);
  });
}

Json critical_json(const SafetyOptions& options, const safety::CriticalKh& found) {
  Json trials = Json::array();
  for (const safety::KhTrial& trial : found.trials)
    trials.push_back({{"kh", trial.kh},
                      {"lower", json_or_null(trial.lower)},
                      {"upper", json_or_null(trial.upper)},
                      {"stands", trial.stands()},
                      {"falls", trial.falls()}});
  return {{"deck", json_text(options.deck)},    {"direction", options.earthquake},
          {"lower", json_or_null(found.lower)}, {"upper", json_or_null(found.upper)},
          {"complete", found.complete()},       {"incomplete", json_text(found.incomplete)},
          {"trials", std::move(trials)}};
}

// --critical-kh: at which horizontal acceleration the factor is 1.
int find_kh(const SafetyOptions& options, const Catalogue& catalogue) {
  return guarded(options.deck, [&] {
    keep_input(options.deck);
    const InterruptWatch watch;
    const std::string stem = stem_of(options) + ".critical_kh";
    ResultFiles results(options.folder, stem, {options.deck, 0, "safety"});
    Task task(options.deck);
    const double sign = options.earthquake == "left" ? -1.0 : 1.0;
    const safety::CriticalKh found = safety::find_critical_kh(
        [&](double kh) { return find_on_mesh(options, catalogue, 0, task, sign * kh).found; },
        options.search.limits.tolerance);
    const std::filesystem::path file = options.folder / (stem + ".csv");
    write_file(file, safety::to_csv(found, options.digits));
    say_left(options.deck, results.close());
    const ProgressPause pause;
    fmt::print("{}: factor of safety under a horizontal acceleration k_h g to the {}\n{}", options.deck,
               options.earthquake, safety::to_text(found));
    print_files({file});
    if (Json* json = answer()) {
      *json = critical_json(options, found);
      (*json)["files"] = files_json({file});
    }
    if (found.stopped) say_error(options.deck, "interrupted: what was found so far stands above", "S511");
    if (!found.stopped && !found.complete()) say_error(options.deck, found.incomplete, "S515");
    return found.stopped ? kInterrupted : found.complete() ? kOk : kNotConverged;
  });
}

// One search per set of factors.
int run_safety(const SafetyOptions& options, const Catalogue& catalogue) {
  const std::vector<PartialFactors>& sets = options.input.build.factors;
  const auto find = [&](const SafetyOptions& one) {
    return one.earthquake.empty() ? find_one(one, catalogue) : find_kh(one, catalogue);
  };
  if (sets.size() < 2) return find(options);
  if (answer() != nullptr) {
    say_error(options.deck, "--json holds one answer: give one set of --factors at a time", "S742");
    return kUsage;
  }
  int worst = kOk;
  for (const PartialFactors& set : sets) {
    SafetyOptions one = options;
    one.input.build.factors = {set};
    worst = std::max(worst, find(one));
    if (worst == kInterrupted) break;
  }
  return worst;
}

void add_search_options(CLI::App& parser, SafetyOptions& o) {
  safety::SearchLimits& limits = o.search.limits;
  parser.add_option("--stage", o.stage, "the last stage that is run, from 1 (default: the deck's last)")
      ->check(CLI::Range(1, 100'000));
  parser
      .add_option("--tolerance", limits.tolerance, "width of the bracket that ends the search (default 0.005)")
      ->check(number_in(1e-8, 1.0, "a width from 1e-8 to 1"));
  parser
      .add_option(
          "--start", limits.start,
          "first factor, for which the stages are run (default 1; lower ones follow if the model fails at it)")
      ->check(number_in(1e-3, 1e3, "a factor from 0.001 to 1000"));
  parser.add_option("--smallest", limits.smallest, "factor below which the search ends (default 0.05)")
      ->check(number_in(1e-3, 1e3, "a factor from 0.001 to 1000"));
  parser.add_option("--largest", limits.largest, "factor above which the search ends (default 20)")
      ->check(number_in(1e-3, 1e3, "a factor from 0.001 to 1000"));
  parser.add_option("--iterations", o.search.iterations, "most iterations of an attempt (default 40)")
      ->check(CLI::Range(2, 100'000));
  parser
      .add_option("--cuts", o.search.cuts,
                  "number of times that the load path to a factor is halved before the factor counts as failed "
                  "(default 5)")
      ->check(CLI::Range(0, 20));
}

// "soil,anchors".  Throws CLI::ValidationError.
std::vector<ModelPart> parts_in(const std::string& list) {
  std::vector<ModelPart> parts;
  for (const std::string_view word : split_at(',', list)) {
    const auto* const row = std::ranges::find(kParts, word, &PartName::name);
    if (row == std::end(kParts))
      throw CLI::ValidationError(
          "--reduce", fmt::format("'{}' is no part; expected a list of soil, joints, anchors and walls", word));
    parts.push_back(row->part);
  }
  return parts;
}

void add_choice_options(CLI::App& parser, SafetyOptions& o) {
  static const std::map<std::string, DilationRule> rules = [] {
    std::map<std::string, DilationRule> names;
    for (const DilationRuleName& row : kDilationRules) names.emplace(row.name, row.rule);
    return names;
  }();
  static const std::map<std::string, safety::Start> starts{{"carried", safety::Start::carried},
                                                           {"anew", safety::Start::anew}};
  parser
      .add_option_function<std::string>(
          "--dilation", [&o](const std::string& name) { o.search.dilation = rules.at(name); },
          "dilation angle: reduced (tan(psi) / F, the default), kept (at most the reduced friction), none (0)")
      ->check(CLI::IsMember(rules));
  parser
      .add_option_function<std::string>(
          "--from", [&o](const std::string& name) { o.search.start = starts.at(name); },
          "where a factor starts: carried (the state of the last stable factor, the default), anew (all stages "
          "again)")
      ->check(CLI::IsMember(starts));
  parser
      .add_option("--group", o.search.groups,
                  "number of a group of the parts in --reduce whose strength is divided; may be repeated "
                  "(default: all)")
      ->allow_extra_args(false);
  parser.add_option_function<std::string>(
      "--reduce", [&o](const std::string& list) { o.search.reduce = parts_in(list); },
      "parts whose strength is divided, separated by commas: soil (the default), joints, anchors (bars and "
      "springs), walls (M_p and N_p of beams)");
  // Flags come after the list, whatever their order.
  const auto add = [&](const char* flag, const std::vector<ModelPart>& parts, const char* what) {
    parser.add_flag_callback(
        flag, [&o, parts] { o.search.reduce.insert(o.search.reduce.end(), parts.begin(), parts.end()); }, what);
  };
  add("--interfaces", {ModelPart::joints}, "add joints to --reduce");
  add("--structures", {ModelPart::anchors, ModelPart::walls}, "add anchors and walls to --reduce");
}

constexpr const char* kSafetyExamples =
    "Examples:\n"
    "  sagefe safety slope.dat\n"
    "      both ends of a bracket of 0.005 for the factor, the reason for each, curve and mechanism\n"
    "  sagefe safety wall.dat --stage 3 --reduce soil,joints --tolerance .005\n"
    "  sagefe safety slope.dat --converge .01\n"
    "      refine the mesh until the factor changes by less than 1 %";

}  // namespace

Command safety_command(CLI::App& parser, const Catalogue& catalogue) {
  parser.footer(std::string(kSafetyExamples) + "\n\n" + parser.get_footer());
  auto o = std::make_shared<SafetyOptions>();
  parser.add_option("DECK", o->deck, "deck to be analysed")->required();
  add_search_options(parser, *o);
  add_choice_options(parser, *o);
  auto* const converge =
      parser
          .add_option("--converge", o->converge,
                      "refine the mesh until the factor changes by less than this share, e.g. 0.01")
          ->check(number_in(1e-6, 0.5, "a relative change from 1e-6 to 0.5"));
  parser
      .add_option("--critical-kh", o->earthquake,
                  "find the horizontal acceleration (in g) to the left or right at which the factor is 1; "
                  "--tolerance is the width of its bracket")
      ->check(CLI::IsMember({"left", "right"}))
      ->excludes(converge);
  parser.add_option("--max-dofs", o->max_dofs, "with --converge: largest model (default 60000)")
      ->check(CLI::PositiveNumber);
  parser.add_option("--solver", o->solver, "solver by name (see sagefe list solvers)")
      ->check(known_solver(catalogue));
  add_threads_option(parser, o->threads);
  add_kernels_option(parser, o->kernels);
  add_digits_option(parser, o->digits);
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  parser.add_flag("--profile", o->profile,
                  "print where time and floating-point operations went, over all trials of the last mesh");
  add_input_options(parser, o->input);
  add_build_options(parser, o->input.build, catalogue);
  return [o, &catalogue] { return run_safety(*o, catalogue); };
}

}  // namespace sage::app
