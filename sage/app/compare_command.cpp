// sagefe compare: two runs side by side.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/converge.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/large_heap.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/report_page.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/run_source.hpp"
#include "sage/app/run_warnings.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/app/wrap.hpp"
#include "sage/compare/comparison.hpp"
#include "sage/compare/pair_picture.hpp"
#include "sage/model/locate.hpp"
#include "sage/record/data_file.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/result_file.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

// How one side is run.
struct SideOptions {
  std::string deck;
  InputOptions input;
  std::string solver;
  int threads = 0;
  Kernels kernels = Kernels::automatic;
  std::vector<std::string> fields = {};  // of reports of points
};

struct CompareOptions {
  std::vector<std::string> decks;
  bool both = false;
  InputOptions input;  // of both sides, where B has none of its own
  std::string solver;
  int threads = 0;
  Kernels kernels = Kernels::automatic;
  ConvergeOptions converge;
  std::optional<int> formulation_b, element_b, geometry_b;
  std::optional<std::string> solver_b, layout_b;
  std::vector<std::string> lines, pictures, fields;
  int digits = 0;
  std::filesystem::path folder = "out", page;  // page: empty = none is wanted

  bool changes_b() const { return formulation_b || element_b || geometry_b || solver_b || layout_b; }
};

SideOptions side_a(const CompareOptions& o) {
  SideOptions side{o.decks.front(), o.input, o.solver, o.threads, o.kernels, o.fields};
  if (o.both) side.input.build.geometry = 1;
  return side;
}

SideOptions side_b(const CompareOptions& o) {
  SideOptions side{o.decks.back(), o.input, o.solver_b.value_or(o.solver), o.threads, o.kernels, o.fields};
  BuildOptions& build = side.input.build;
  build.formulation = o.formulation_b.value_or(build.formulation);
  build.element = o.element_b.value_or(build.element);
  build.geometry = o.both ? 2 : o.geometry_b.value_or(build.geometry);
  side.input.layout = o.layout_b.value_or(side.input.layout);
  return side;
}

// "A: deck.dat, axisymmetric, quad4 full, clay linear_elastic, solver automatic"
// mesh: options that give it, where it is not the deck's.
std::string label_of(const char* letter, const SideOptions& side, const Model* model,
                     const std::string& mesh = "") {
  std::string text = fmt::format("{}: {}", letter, side.deck);
  if (model == nullptr) return text;
  text += model->geometry == Geometry::axisymmetric ? ", axisymmetric" : ", plane strain";
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Group& group : model->groups) add(group.element_name);
  for (const Group& group : model->groups) add(model->material_of(group).law_name);
  constexpr std::size_t kShown = 6;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += ", " + names[i];
  if (names.size() > kShown) text += ", ...";
  if (!side.solver.empty()) text += ", solver " + side.solver;
  if (!mesh.empty()) text += ", " + mesh;
  return text;
}

// Where both sides and their files go.
struct Place {
  std::filesystem::path folder;
  ResultFiles& results;
  const Catalogue& catalogue;
  bool result_files;  // for the page of both
};

// A side, and what finer and finer meshes found for it, where that was asked for.
struct FinishedSide {
  compare::Side side;
  std::optional<Convergence> convergence = {};
  std::filesystem::path result = {};  // its result file; empty = there is none

  std::vector<compare::CertainValue> certain() const {
    std::vector<compare::CertainValue> values;
    if (convergence)
      for (const ConvergedValue& v : convergence->values)
        values.push_back({v.name, v.value, v.error, v.reached});
    return values;
  }
};

RunRequest converge_request(const SideOptions& options, const Place& place, const std::string& stem) {
  RunRequest request;
  request.deck = options.deck;
  request.stem = stem;
  request.input = options.input;
  request.solver = options.solver;
  request.threads = options.threads;
  request.kernels = options.kernels;
  request.output.folder = place.folder;
  request.output.fields = options.fields;
  request.results = &place.results;
  request.keep_result = true;
  return request;
}

// source: for the result file, where there will be one.
Model build_side(const SideOptions& options, const Catalogue& catalogue, RunSource* source = nullptr) {
  BuildOptions build = options.input.build;
  build.solver = solver_code(catalogue, options.solver);
  std::string heads;
  if (source != nullptr && build.heads) build.heads = keeping_heads(build.heads, heads);
  const Deck deck = read_input(options.deck, options.input);
  Model model = build_model(deck, catalogue, build);
  for (Report& report : model.reports) report.fields = options.fields;
  if (source != nullptr) {
    *source = source_of(*deck.source.text(), deck.layout, options.input.layout, build);
    source->heads = std::move(heads);
  }
  return model;
}

FinishedSide run_model(Model model, const std::string& label, const SideOptions& options, const Place& place,
                       const std::string& stem, const RunSource& source) {
  RunSettings settings;
  settings.threads = threads_for(options.threads);
  settings.kernels = options.kernels;
  settings.choose_solver = choose_solver;
  settings.stop_asked = interrupted;
  Task task("compare " + stem);
  settings.pulse = task.pulse();
  compare::Side side(label, std::move(model), place.folder, stem);
  RunRequest request;
  request.deck = options.deck;
  request.input.strict = options.input.strict;
  RunWarnings warnings(request);
  std::vector<Observer*> watching{&warnings};
  std::optional<ResultOutput> result;
  if (place.result_files)
    watching.push_back(
        &result.emplace(place.folder, stem, source, settings.threads, ResultFields{options.fields}));
  with_umat_output(label, [&] { side.run(place.catalogue, settings, watching); });
  side.set_strict_failure(!free_of_warnings(request, side.record(), side.reports()));
  if (!side.error().empty())
    say_error(options.deck, side.error(), code_in(side.error()).value_or(Code("S511")));
  const bool written = result && !result->files().empty();
  return {std::move(side), {}, written ? result->files().front() : std::filesystem::path()};
}

FinishedSide run_side(const char* letter, const SideOptions& options, const Place& place,
                      const std::string& stem) {
  std::optional<Model> model;
  RunSource source;
  try {
    model = build_side(options, place.catalogue, place.result_files ? &source : nullptr);
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    return {{label_of(letter, options, nullptr), error.what()}};
  }
  print_stderr(fmt::format("{}: {}\n", letter, options.deck));
  print_diagnostics(model->diagnostics);
  const std::string label = label_of(letter, options, &*model);
  if (options.input.strict && model->diagnostics.warnings() > 0)
    return {{label, "warnings count as errors (--strict)"}};
  return run_model(std::move(*model), label, options, place, stem, source);
}

// Finer and finer meshes; the best of them is the side.
FinishedSide converge_side(const char* letter, const SideOptions& options, const ConvergeOptions& converge,
                           const Place& place, const std::string& stem) {
  print_stderr(fmt::format("{}: {}\n", letter, options.deck));
  Convergence found;
  const std::string label = label_of(letter, options, nullptr);
  try {
    found = refine_until_converged(converge_request(options, place, stem), converge, place.catalogue);
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    return {{label, error.what()}};
  } catch (const AnalysisError& error) {
    say_error(options.deck, error);
    found.not_reached = error.what();
    return {{label, error.what()}, found};
  }
  if (!found.best_run) return {{label, "NOT REACHED: " + found.not_reached}, found};
  RunOutcome& run = *found.best_run;
  const std::string best_label = label_of(letter, options, run.model.get(), found.options);
  compare::Side side(best_label, std::move(run.model), std::move(run.reports), std::move(run.record),
                     std::move(*run.result));
  side.set_not_reached(found.not_reached);
  return {std::move(side), found};
}

// A point that neither mesh holds is a mistake.
void require_points(const CompareOptions& o, const Model* a, const Model* b) {
  const auto holds = [](const Model* model, const PointRequest& point) {
    return model != nullptr && !Locator(*model, kind_at_points(*model)).at(point.place).empty();
  };
  if ((a == nullptr && b == nullptr) || interrupted()) return;
  for (const PointRequest& point : o.input.build.points)
    if (!holds(a, point) && !holds(b, point))
      throw InputError("S907", {o.decks.front(), 0, 0, 0},
                       fmt::format("the point ({:.10g}; {:.10g}) lies outside the mesh of both runs",
                                   point.place.x(), point.place.y()));
}

// Before refining, which may take long.
void require_points_of_decks(const CompareOptions& o, const SideOptions (&sides)[2],
                             const Catalogue& catalogue) {
  if (o.input.build.points.empty()) return;
  std::optional<Model> models[2];
  for (std::size_t k = 0; k < 2; ++k) {
    try {
      models[k] = build_side(sides[k], catalogue);
    } catch (const InputError&) {
      // The refined runs say what is wrong.
    }
  }
  require_points(o, models[0] ? &*models[0] : nullptr, models[1] ? &*models[1] : nullptr);
}

// Names of fields as require_fields gives them; those that the catalogue lacks may be history variables of either
// side's laws.
std::vector<std::string> fields_asked(const CompareOptions& o, const SideOptions (&sides)[2],
                                      const Catalogue& catalogue) {
  const auto known = [&](const std::string& name) {
    return catalogue.fields.find(name) != nullptr || catalogue.fields.choose(name).has_value();
  };
  if (std::ranges::all_of(o.pictures, known) && std::ranges::all_of(o.fields, known))
    return require_fields(o.pictures, o.fields, {catalogue.fields});
  std::vector<Model> models;
  for (const SideOptions& side : sides) {
    try {
      models.push_back(build_side(side, catalogue));
    } catch (const InputError&) {
      return o.fields;  // said when the side is run
    }
  }
  return require_fields(o.pictures, o.fields, {fields_of(models[0]), fields_of(models[1])});
}

// Fields that were asked for in vain.
void warn_of_fields(const CompareOptions& o, const compare::Side& a, const compare::Side& b) {
  for (const compare::Side* side : {&a, &b}) {
    if (!side->has_model()) continue;
    const Model& model = side->model();
    const bool reports =
        std::ranges::any_of(model.reports, [](const Report& r) { return r.kind == ReportKind::point; });
    const auto has_column = [&](const FieldEntry& row) {
      const bool lives = row.place() == FieldPlace::node || row.place() == FieldPlace::point;
      return (reports || !o.lines.empty()) && lives && row.form == FieldForm::number;
    };
    const std::string text =
        fields_without_column(o.fields, fields_of(model), has_column,
                              "--line and --point have those of nodes and integration points");
    if (!text.empty()) return say_warning("sagefe compare", text, "S610");
  }
}

Json side_json(const FinishedSide& one) {
  const compare::Side& side = one.side;
  Json json = {{"label", json_text(side.label())},
               {"error", json_text(side.error())},
               {"not_reached", json_text(side.not_reached())}};
  if (side.has_model()) {
    json["model"] = model_json(side.model(), side.record().scene);
    json["status"] = status_word(side.record().result.status);
    json["reports"] = reports_json(side.model(), side.reports());
  }
  if (one.convergence) json["convergence"] = convergence_json(*one.convergence);
  return json;
}

Json rows_json(const std::vector<compare::Row>& rows) {
  Json list = Json::array();
  for (const compare::Row& row : rows)
    list.push_back({{"section", json_text(row.section)},
                    {"name", json_text(row.name)},
                    {"unit", json_text(row.unit)},
                    {"a", row.a},
                    {"b", row.b},
                    {"difference", row.difference()},
                    {"relative", row.relative()},
                    {"expected_ratio", row.expected}});
  return list;
}

// NaN where a side does not have a number, or theory expects none.
Json comparison_json(const compare::Comparison& comparison) {
  Json answers = Json::array(), theory = Json::array();
  for (const compare::Answer& one : comparison.answers)
    answers.push_back({{"name", json_text(one.name)},
                       {"unit", json_text(one.unit)},
                       {"a", one.a},
                       {"b", one.b},
                       {"error_a", one.error_a},
                       {"error_b", one.error_b},
                       {"expected_ratio", one.expected},
                       {"why", json_text(one.why)}});
  for (const compare::Expectation& one : comparison.theory)
    theory.push_back({{"what", json_text(one.what)},
                      {"expected", one.expected},
                      {"found", one.found},
                      {"unit", json_text(one.unit)},
                      {"why", json_text(one.why)}});
  return {{"answers", std::move(answers)},
          {"rows", rows_json(comparison.rows)},
          {"details", rows_json(comparison.details)},
          {"theory", std::move(theory)},
          {"notes", json_list(comparison.notes)}};
}

int exit_code_of(const FinishedSide& a, const FinishedSide& b) {
  int code = kOk;
  for (const FinishedSide* one : {&a, &b}) {
    if (!one->side.has_model() && !one->convergence) return kInput;
    if (!one->side.error().empty() || (one->convergence && !one->convergence->not_reached.empty()))
      code = kNotConverged;
    else if (one->side.strict_failure() && code == kOk)
      code = kInput;
  }
  return code;
}

// Whether the options go together; says why not.  The lines that they name are added to `lines`.
bool go_together(const CompareOptions& o, std::vector<compare::Line>& lines) {
  const auto wrong = [](const char* what, Code code) {
    say_error("sagefe compare", what, code);
    return false;
  };
  if (o.decks.size() == 1 && !o.both && !o.changes_b())
    return wrong("one deck needs --both or an option that ends in -b", "S903");
  if (o.both && o.geometry_b)
    return wrong("--both sets the geometries itself, --geometry-b does not go with it", "S905");
  if (!o.page.empty() && o.converge.asked())
    return wrong("--report shows the runs of the meshes of both decks, --converge does not go with it", "S905");
  if (o.decks.size() == 1) require_file(o.decks.front(), "compare of one deck in two ways");
  try {
    for (const std::string& text : o.lines) lines.push_back(compare::line_from_text(text));
  } catch (const std::invalid_argument& error) {
    return wrong(error.what(), "S904");
  }
  return true;
}

// The page of the sides that have a result file, and these files.  Empty where there are none.
std::vector<std::filesystem::path> write_page(const CompareOptions& o, const FinishedSide& a,
                                              const FinishedSide& b, const Catalogue& catalogue) {
  std::vector<std::filesystem::path> files;
  for (const FinishedSide* one : {&a, &b})
    if (!one->result.empty()) files.push_back(one->result);
  if (files.empty() || interrupted()) return files;
  std::filesystem::path page = o.page;
  if (page.extension() != ".html") page += ".html";
  write_report_page(files, page, {}, catalogue);
  files.push_back(page);
  return files;
}

int compare_decks(const CompareOptions& asked, const Catalogue& catalogue) {
  CompareOptions o = asked;
  std::vector<compare::Line> lines;
  if (!go_together(o, lines)) return kUsage;
  SideOptions options[2] = {side_a(o), side_b(o)};
  o.fields = fields_asked(o, options, catalogue);
  for (SideOptions& side : options) side.fields = o.fields;
  const std::string name_a = case_name(options[0].deck), name_b = case_name(options[1].deck);
  const std::string stem = name_a == name_b ? name_a : name_a + "_" + name_b;
  for (const SideOptions& side : options) keep_input(side.deck);
  if (!o.page.empty()) expect_data_module();  // before any file is begun
  const InterruptWatch watch;  // before the first file, so that none stays behind under a temporary name
  ResultFiles results(o.folder, stem + ".compare", {options[0].deck, 0, "comparison"});
  const Place place{o.folder, results, catalogue, !o.page.empty()};
  keep_heap_in_large_pages();
  ConvergeOptions converge = o.converge;
  converge.screen = stderr;  // the answer comes first on the other one
  if (converge.asked()) require_points_of_decks(o, options, catalogue);
  const auto finish = [&](const char* letter, const SideOptions& side, const char* ending) -> FinishedSide {
    if (interrupted()) return {{label_of(letter, side, nullptr), "not run, interrupted before"}};
    return converge.asked() ? converge_side(letter, side, converge, place, stem + ending)
                            : run_side(letter, side, place, stem + ending);
  };
  const FinishedSide side_a = finish("A", options[0], ".a"), side_b = finish("B", options[1], ".b");
  const compare::Side &a = side_a.side, &b = side_b.side;
  require_points(o, a.has_model() ? &a.model() : nullptr, b.has_model() ? &b.model() : nullptr);
  warn_of_fields(o, a, b);
  const compare::Comparison comparison =
      compare::compare(a, b, lines, side_a.certain(), side_b.certain(), o.fields);
  std::vector<std::filesystem::path> files{o.folder / (stem + ".compare.csv")};
  write_file(files.front(), compare::to_csv(comparison, a, b, o.digits > 0 ? o.digits : kCsvDigits));
  for (const std::string& name : o.pictures) {
    if (!a.has_state() && !b.has_state()) break;
    files.push_back(o.folder / fmt::format("{}.compare_{}.svg", stem, name));
    write_file(files.back(), compare::pair_svg(a, b, name));
  }
  const std::vector<std::filesystem::path> page = write_page(o, side_a, side_b, catalogue);
  say_left(o.decks.front(), results.close());
  const ProgressPause pause;
  fmt::print("{}", wrapped(compare::to_text(comparison, a, b), kHelpColumns));
  for (const FinishedSide* one : {&side_a, &side_b}) {
    if (one->convergence && !one->convergence->table.empty()) files.push_back(one->convergence->table);
    if (one->side.has_model())
      for (const std::filesystem::path& file : one->side.reports().files()) files.push_back(file);
  }
  files.insert(files.end(), page.begin(), page.end());
  if (Json* json = answer()) {
    *json = {{"a", side_json(side_a)}, {"b", side_json(side_b)}};
    (*json)["comparison"] = comparison_json(comparison);
    (*json)["files"] = files_json(files);
  }
  print_files(files);
  if (interrupted()) say_error("sagefe compare", "interrupted: what is missing above was not computed", "S511");
  return interrupted() ? kInterrupted : exit_code_of(side_a, side_b);
}

}  // namespace

Command compare_command(CLI::App& parser, const Catalogue& catalogue) {
  auto o = std::make_shared<CompareOptions>();
  parser.add_option("DECK", o->decks, "deck A, and deck B unless one deck is run in two ways")
      ->required()
      ->expected(1, 2);
  parser.add_flag("--both", o->both, "A in plane strain, B in axisymmetry");
  add_input_options(parser, o->input);
  add_build_options(parser, o->input.build, catalogue);
  o->input.build.points_outside = true;  // of one of the two
  parser.add_option("--solver", o->solver, "solver by name (see sagefe list solvers)")
      ->check(known_solver(catalogue));
  add_threads_option(parser, o->threads);
  add_kernels_option(parser, o->kernels);
  CompareOptions& options = *o;
  add_formulation_option(parser, "--formulation-b", "formulation code of B, where it differs from A",
                         [&options](int code) { options.formulation_b = code; });
  add_element_option(parser, catalogue, "--element-b",
                     "element that replaces 4-node quadrilaterals in B, code or name",
                     [&options](int code) { options.element_b = code; });
  parser.add_option("--geometry-b", o->geometry_b, "geometry of B: 1 plane strain, 2 axisymmetric")
      ->check(CLI::Range(1, 2));
  parser.add_option("--solver-b", o->solver_b, "solver of B by name")->check(known_solver(catalogue));
  parser.add_option("--layout-b", o->layout_b, "card layout of B");
  parser
      .add_option("--line", o->lines,
                  "x1,y1,x2,y2[:name[:n]]: displacement and stress at n places (default 11); may be repeated")
      ->allow_extra_args(false);
  add_converge_options(parser, o->converge, "for each side, ");
  add_digits_option(parser, o->digits);
  add_field_options(parser, o->pictures, o->fields, "SVG of both sides on one scale of colours",
                    "lines and reports of points");
  parser.add_option(
      "--report", o->page,
      "write this file, a page of both runs for every browser (sagefe report), and the result files "
      "STEM.a.h5 and STEM.b.h5 that it shows");
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  return [o, &catalogue] { return compare_decks(*o, catalogue); };
}

}  // namespace sage::app
