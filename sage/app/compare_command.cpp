// sagefe compare: two runs side by side.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <optional>
#include <stdexcept>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/compare/comparison.hpp"
#include "sage/compare/pair_picture.hpp"
#include "sage/model/locate.hpp"
#include "sage/output/out_file.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

namespace {

// How one side is run.
struct SideOptions {
  std::string deck;
  InputOptions input;
  std::string solver;
  int threads = 0;
};

struct CompareOptions {
  std::vector<std::string> decks;
  bool both = false;
  InputOptions input;  // of both sides, where B has none of its own
  std::string solver;
  int threads = 0;
  std::optional<int> formulation_b, element_b, geometry_b;
  std::optional<std::string> solver_b, layout_b;
  std::vector<std::string> lines, pictures;
  int digits = 0;
  std::filesystem::path folder = "out";

  bool changes_b() const { return formulation_b || element_b || geometry_b || solver_b || layout_b; }
};

SideOptions side_a(const CompareOptions& o) {
  SideOptions side{o.decks.front(), o.input, o.solver, o.threads};
  if (o.both) side.input.build.geometry = 1;
  return side;
}

SideOptions side_b(const CompareOptions& o) {
  SideOptions side{o.decks.back(), o.input, o.solver_b.value_or(o.solver), o.threads};
  BuildOptions& build = side.input.build;
  build.formulation = o.formulation_b.value_or(build.formulation);
  build.element = o.element_b.value_or(build.element);
  build.geometry = o.both ? 2 : o.geometry_b.value_or(build.geometry);
  side.input.layout = o.layout_b.value_or(side.input.layout);
  return side;
}

// "A: deck.dat, axisymmetric, quad4 full, clay linear_elastic, solver automatic"
std::string label_of(const char* letter, const SideOptions& side, const Model* model) {
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
  return text;
}

compare::Side run_side(const char* letter, const SideOptions& options, const std::filesystem::path& folder,
                       const std::string& stem, const Catalogue& catalogue) {
  std::optional<Model> model;
  try {
    BuildOptions build = options.input.build;
    build.solver = solver_code(catalogue, options.solver);
    model = build_model(read_input(options.deck, options.input), catalogue, build);
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    return {label_of(letter, options, nullptr), error.what()};
  }
  fmt::print(stderr, "{}: {}\n", letter, options.deck);
  print_diagnostics(model->diagnostics);
  const std::string label = label_of(letter, options, &*model);
  if (options.input.strict && model->diagnostics.warnings() > 0)
    return {label, "warnings count as errors (--strict)"};
  RunSettings settings;
  settings.threads = threads_for(options.threads);
  settings.choose_solver = [](int equations, bool symmetric) { return choose_solver(equations, symmetric); };
  compare::Side side(label, std::move(*model), folder, stem);
  side.run(catalogue, settings);
  if (!side.error().empty()) fmt::print(stderr, "{}: {}\n", options.deck, side.error());
  return side;
}

// A point that neither mesh holds is a mistake.
void require_points(const CompareOptions& o, const compare::Side& a, const compare::Side& b) {
  const auto holds = [](const compare::Side& side, const PointRequest& point) {
    return side.has_model() && !Locator(side.model()).at(point.place).empty();
  };
  for (const PointRequest& point : o.input.build.points)
    if ((a.has_model() || b.has_model()) && !holds(a, point) && !holds(b, point))
      throw InputError({o.decks.front(), 0, 0, 0},
                       fmt::format("the point ({:.10g}; {:.10g}) lies outside the mesh of both runs",
                                   point.place.x(), point.place.y()));
}

int compare_decks(const CompareOptions& o) {
  if (o.decks.size() == 1 && !o.both && !o.changes_b()) {
    fmt::print(stderr, "sagefe compare: one deck needs --both or an option that ends in -b\n");
    return kUsage;
  }
  if (o.both && o.geometry_b) {
    fmt::print(stderr, "sagefe compare: --both sets the geometries itself, --geometry-b does not go with it\n");
    return kUsage;
  }
  if (o.decks.size() == 1) require_file(o.decks.front(), "compare of one deck in two ways");
  std::vector<compare::Line> lines;
  try {
    for (const std::string& text : o.lines) lines.push_back(compare::line_from_text(text));
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "sagefe compare: {}\n", error.what());
    return kUsage;
  }
  const Catalogue catalogue = full_catalogue();
  const SideOptions options[2] = {side_a(o), side_b(o)};
  const std::string name_a = case_name(options[0].deck), name_b = case_name(options[1].deck);
  const std::string stem = name_a == name_b ? name_a : name_a + "_" + name_b;
  for (const SideOptions& side : options) keep_input(side.deck);
  ResultFiles results(o.folder, stem + ".compare", {options[0].deck, 0, "comparison"});
  const compare::Side a = run_side("A", options[0], o.folder, stem + ".a", catalogue);
  const compare::Side b = run_side("B", options[1], o.folder, stem + ".b", catalogue);

  require_points(o, a, b);
  const compare::Comparison comparison = compare::compare(a, b, lines);
  std::vector<std::filesystem::path> files{o.folder / (stem + ".compare.csv")};
  write_file(files.front(), compare::to_csv(comparison, a, b, o.digits > 0 ? o.digits : kCsvDigits));
  for (const std::string& name : o.pictures) {
    if (!a.has_state() && !b.has_state()) break;
    files.push_back(o.folder / fmt::format("{}.compare_{}.svg", stem, name));
    write_file(files.back(), compare::pair_svg(a, b, field_from_name(name).value()));
  }
  results.close();
  fmt::print("{}", compare::to_text(comparison, a, b));
  for (const compare::Side* side : {&a, &b})
    if (side->has_model())
      for (const std::filesystem::path& file : side->reports().files()) files.push_back(file);
  for (std::size_t i = 0; i < files.size(); ++i)
    fmt::print("{:<7}{}\n", i == 0 ? "files:" : "", files[i].string());
  if (!a.has_model() || !b.has_model()) return kInput;
  return a.error().empty() && b.error().empty() ? kOk : kNotConverged;
}

}  // namespace

Command compare_command(CLI::App& parser) {
  auto o = std::make_shared<CompareOptions>();
  parser.add_option("DECK", o->decks, "deck A, and deck B unless one deck is run in two ways")
      ->required()
      ->expected(1, 2);
  parser.add_flag("--both", o->both, "A in plane strain, B in axisymmetry");
  add_input_options(parser, o->input);
  add_build_options(parser, o->input.build);
  o->input.build.points_outside = true;  // of one of the two
  parser.add_option("--solver", o->solver, "solver by name (see sagefe list solvers)")->check(unknown_solver);
  add_threads_option(parser, o->threads);
  parser.add_option("--formulation-b", o->formulation_b, "formulation code of B, where it differs from A");
  parser.add_option("--element-b", o->element_b, "element code that replaces 4-node quadrilaterals in B");
  parser.add_option("--geometry-b", o->geometry_b, "geometry of B: 1 plane strain, 2 axisymmetric")
      ->check(CLI::Range(1, 2));
  parser.add_option("--solver-b", o->solver_b, "solver of B by name")->check(unknown_solver);
  parser.add_option("--layout-b", o->layout_b, "card layout of B");
  parser.add_option("--line", o->lines,
                    "x1,y1,x2,y2[:name[:n]]: displacement and stress at n places (default 11)");
  add_digits_option(parser, o->digits);
  parser
      .add_option("--picture", o->pictures,
                  "SVG of both fields on one scale of colours (names as in sagefe run)")
      ->check([](const std::string& name) {
        return field_from_name(name) ? std::string() : "unknown field " + name;
      });
  parser.add_option("-o,--output", o->folder, "folder for results (default: out)");
  return [o] { return compare_decks(*o); };
}

}  // namespace sage::app
