// sagefe convert: a deck or mesh into another program's input, or into a sage1 deck.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <nlohmann/json.hpp>

#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"
#include "sage/deck/text.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/exchange/mesh_model.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

struct ConvertOptions {
  std::string from, to;
  InputOptions input;
  ForeignMeshOptions mesh;
  bool wide = false, narrow = false;
};

std::string ending(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

bool is_mesh(const std::string& path) {
  const std::string end = lower_case(ending(path));
  return end == ".msh" || end == ".inp";
}

Model read_model(const ConvertOptions& options, const Catalogue& catalogue) {
  if (!is_mesh(options.from))
    return build_model(read_input(options.from, options.input), catalogue, options.input.build);
  const BuildOptions& build = options.input.build;
  if (build.element != 0 || build.refine != 0 || build.refine_graded != 0 || !build.gradings.empty())
    throw InputError("S905", {options.from, 0, 0, 0},
                     "--element, --refine and --grade are for decks: convert to .dat first");
  const std::string text = read_file(options.from);
  ForeignMeshOptions mesh = options.mesh;
  mesh.geometry_given = build.geometry != 0;
  if (build.geometry == 2) mesh.geometry = Geometry::axisymmetric;
  return model_from_mesh(text, options.from, catalogue, mesh);
}

// `ccx STEM` writes its results to STEM.dat, whatever is there.
void warn_of_results(const std::filesystem::path& to, Diagnostics& diagnostics) {
  const std::filesystem::path results = std::filesystem::path(to).replace_extension(".dat");
  std::error_code ignored;
  if (!std::filesystem::exists(results, ignored)) return;
  diagnostics.add({Severity::warning,
                   "S723",
                   {to.string(), 0, 0, 0},
                   "CalculiX would write its results over " + results.string() + ": convert to another name, " +
                       (to.parent_path() / (to.stem().string() + "_ccx.inp")).string(),
                   {}});
}

int convert(const ConvertOptions& options, const Catalogue& catalogue) {
  const std::string to = ending(options.to);
  const bool model_file = is_model_file(options.to);
  if (to != ".dat" && to != ".msh" && to != ".inp" && !model_file) {
    say_error("sagefe",
              options.to +
                  ": the ending tells the format: .dat deck, .sage.toml model file, .msh Gmsh, .inp CalculiX",
              "S904");
    return kUsage;
  }
  std::error_code absent;
  if (std::filesystem::equivalent(options.from, options.to, absent)) {
    say_error("sagefe", options.to + ": is the file to be read; the converted one needs another name", "S602");
    return kUsage;
  }
  Model model = read_model(options, catalogue);
  const FieldWidth width = options.wide     ? FieldWidth::wide
                           : options.narrow ? FieldWidth::narrow
                                            : FieldWidth::as_needed;
  write_file(options.to, model_file     ? model_file_text(model, catalogue, model.diagnostics)
                         : to == ".dat" ? sage1_text(model, model.diagnostics, width)
                         : to == ".msh" ? msh_text(model, model.diagnostics)
                                        : inp_text(model, model.diagnostics));
  if (to == ".inp") warn_of_results(options.to, model.diagnostics);
  if (!model.mesh.arcs.empty())
    model.diagnostics.add(
        {Severity::note,
         "S720",
         {model.file, 0, 0, 0},
         "the arcs of the drawing are left out: finer meshes of what is written don't follow them",
         {}});
  print_diagnostics(model.diagnostics);
  if (Json* json = answer())
    *json = {{"from", json_text(options.from)},
             {"to", json_text(options.to)},
             {"model", model_json(model, analyse_scene(model))}};
  fmt::print("{}: {} nodes, {} groups{}{}\n", options.to, model.mesh.nodes(), model.groups.size(),
             to == ".msh" ? "" : fmt::format(", {} stages", model.stages.size()),
             model.left_out.empty() ? "" : "; PARTIAL: " + left_out_words(model));
  return options.input.strict && model.diagnostics.warnings() > 0 ? kInput : kOk;
}

// --fix NAME=xy and its like: what named parts of a mesh are used for.
void add_use(CLI::App& parser, ForeignMeshOptions& mesh, const std::string& kind, const std::string& about) {
  parser
      .add_option_function<std::vector<std::string>>(
          "--" + kind,
          [&mesh, kind](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) mesh.uses.push_back(mesh_use(kind, text));
          },
          "from a mesh: " + about)
      ->allow_extra_args(false)
      ->check([kind](const std::string& text) {
        try {
          mesh_use(kind, text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
}

void add_mesh_options(CLI::App& parser, ForeignMeshOptions& mesh) {
  parser.add_option("--young", mesh.youngs_modulus, "from a mesh: Young's modulus of all groups")
      ->check(number_in(1e-99, 1e99, "a positive number below 1e99"));
  parser.add_option("--poisson", mesh.poissons_ratio, "from a mesh: Poisson's ratio of all groups");
  parser.add_option("--weight", mesh.unit_weight, "from a mesh: unit weight of all groups");
  parser.add_option("--water-weight", mesh.water_weight, "from a mesh: unit weight of water")
      ->check(number_in(0.0, 1e99, "a number from 0 to 1e99"));
  add_use(parser, mesh, "fix", "NAME=x, NAME=y or NAME=xy supports the nodes of a curve, point or set");
  add_use(parser, mesh, "pressure", "NAME=VALUE applies a pressure to a curve, set or surface");
  add_use(parser, mesh, "force", "NAME=FX,FY applies a force to a point or a set of one node");
  add_use(parser, mesh, "beam", "NAME: a wall or lining along a curve or set");
  add_use(parser, mesh, "bar", "NAME: bars along a curve or set");
  add_use(parser, mesh, "water", "NAME: the water line along a curve or set");
}

}  // namespace

Command convert_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<ConvertOptions>();
  parser.add_option("IN", options->from, "deck of any layout, or a mesh: .msh (MSH 4.1 or 2.2) or .inp")
      ->required();
  parser.add_option("OUT", options->to, "file to write: .dat, .sage.toml, .msh or .inp")->required();
  add_mesh_options(parser, options->mesh);
  CLI::Option* const wide = parser.add_flag(
      "--wide", options->wide, "to .dat: fields of ten and twenty columns (layout sage1_wide) in any case");
  parser
      .add_flag("--narrow", options->narrow,
                "to .dat: real numbers in ten columns; those that have more digits are rounded, with a warning")
      ->excludes(wide);
  add_input_options(parser, options->input);
  add_build_options(parser, options->input.build, catalogue);
  return [options, &catalogue] { return convert(*options, catalogue); };
}

}  // namespace sage::app
