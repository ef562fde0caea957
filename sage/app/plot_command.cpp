// sagefe plot: pictures from results on disk.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <charconv>
#include <cmath>
#include <memory>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/plot_states.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

// "LOW:HIGH", "full" or "auto".  Throws std::invalid_argument that says so.
void set_range(PictureOptions& look, const std::string& text) {
  if (text == "auto" || text == "full") {
    look.robust = text == "auto";
    return;
  }
  const std::size_t colon = text.find(':');
  const auto number = [&](std::string_view digits) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) value = NAN;
    return value;
  };
  if (colon != std::string::npos) {
    look.low = number(std::string_view(text).substr(0, colon));
    look.high = number(std::string_view(text).substr(colon + 1));
  }
  if (!(look.low < look.high))
    throw std::invalid_argument("--range " + text + ": wanted LOW:HIGH, full or auto");
}

void set_mirror(PictureOptions& look, const std::string& text) {
  look.mirror_left = text != "down";
  look.mirror_down = text != "left";
}

int plot(const PlotOptions& options, const Catalogue& catalogue) {
  if (options.interface)
    plot_interface(options, catalogue);
  else if (!options.line.empty())
    plot_line(options, catalogue);
  else if (options.pictures.empty())
    plot_columns(options);
  else if (options.sheet)
    plot_sheet(options, catalogue);
  else
    plot_pictures(options, catalogue);
  return kOk;
}

// How pictures of fields look.
void add_look_options(CLI::App& parser, PlotOptions& options) {
  PictureOptions& look = options.look;
  parser.add_flag("--sheet", options.sheet,
                  "all pictures as panels of one file, those of a field on one scale of colours");
  parser.add_flag("--own-scales", options.own_scales, "a scale for each panel of the sheet");
  parser
      .add_option_function<std::string>(
          "--range", [&look](const std::string& text) { set_range(look, text); },
          "of the colours: LOW:HIGH; full; auto (default) leaves out what is rare and far off, and says so")
      ->check([](const std::string& text) {
        try {
          PictureOptions tried;
          set_range(tried, text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
  parser.add_option("--levels", look.levels, "bands of colour, about (default: 10)")->check(CLI::Range(2, 100));
  parser.add_flag("!--no-mesh", look.mesh, "no edges of elements");
  parser.add_flag("!--undeformed", look.deformed, "the mesh as it was at the start");
  parser
      .add_option_function<std::string>(
          "--mirror", [&look](const std::string& text) { set_mirror(look, text); },
          "the other halves of a symmetric model: left (of its left side), down (below its lower side), both")
      ->check(CLI::IsMember({"left", "down", "both"}));
  parser.add_flag("--yielded", look.yielded,
                  "integration points, those at strength full: a stress level between them is extrapolated");
  parser.add_flag("--crosses", look.crosses, "principal stresses in the plane");
  parser.add_flag("--arrows", look.arrows, "displacements");
}

}  // namespace

std::filesystem::path plot_folder(const PlotOptions& options, const std::string& file) {
  std::filesystem::path folder = options.folder.empty() ? std::filesystem::path(file).parent_path()
                                                        : std::filesystem::path(options.folder);
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw OutputError("the folder " + folder.string() + " can't be made: " + error.message());
  return folder;
}

std::filesystem::path plot_path(const PlotOptions& options, const std::string& name) {
  return plot_folder(options, options.files.front()) / ((options.name.empty() ? name : options.name) + ".svg");
}

void write_plot(const std::filesystem::path& path, const std::string& svg) {
  write_file(path, svg);
  fmt::print("{}\n", path.string());
}

Command plot_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<PlotOptions>();
  parser.footer(
      "sagefe plot out/a.report1.csv out/b.report1.csv --xy axial_strain:ratio\n"
      "sagefe plot out/footing.report1.csv                      load against displacement\n"
      "sagefe plot out/a.h5 --picture stress_yy --at 1:5\n"
      "sagefe plot out/a.h5 --picture dev --picture conf --at strain=.05 --at strain=.1 --sheet --mirror both\n"
      "sagefe plot out/a.h5 --interface --at strain=.1\n"
      "sagefe plot out/a.h5 out/b.h5 --line 0,0:0,2.8 --picture stress_yy");
  parser
      .add_option("FILE", options->files,
                  "STEM.reportN.csv and other tables of `sagefe run`, for curves; STEM.h5 of `sagefe run DECK "
                  "--result`, for --picture (for curves it stands for STEM.report1.csv beside it)")
      ->required();
  parser
      .add_option("--xy", options->xy,
                  "X:Y[,Y...]: columns to draw against column X, one curve a file and Y; -NAME turns the sign; "
                  "a panel each time it is given (default: stress and ratio against strain, or load against "
                  "displacement)")
      ->allow_extra_args(false);
  parser
      .add_option("--label", options->labels,
                  "name of a file's curves, in the order of the files (default: the deck's title)")
      ->allow_extra_args(false);
  parser.add_option("--title", options->title, "title (default: the deck's, of one file)");
  parser
      .add_option("--picture", options->pictures,
                  "fields to draw: conf (sigma_3), dev (sigma_1 - sigma_3), SL (stress level), " +
                      catalogue.fields.known() + ", or a history variable of a law; may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option(
          "--at", options->at,
          "STAGE[:INCREMENT] of an output increment, or strain=VALUE, the axial strain of the specimen; may "
          "be repeated (default: the end of every stage)")
      ->allow_extra_args(false)
      ->check(moment_error);
  parser
      .add_option("--line", options->line,
                  "X,Y:X,Y: the fields as curves along this line instead, a curve a state and file")
      ->check(line_error);
  parser.add_flag(
      "--interface", options->interface,
      "the fields as curves along the interfaces instead (default: traction_normal, traction_shear, "
      "stress_level)");
  parser
      .add_option_function<std::vector<int>>(
          "--increment",
          [options = options.get()](const std::vector<int>& numbers) {
            for (int number : numbers) options->at.push_back(":" + std::to_string(number));
          },
          "an output increment of the last stage; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber);
  add_look_options(parser, *options);
  parser.add_option("-o,--output", options->folder, "folder of the pictures (default: that of the first file)");
  parser.add_option("--name", options->name,
                    "name of the file of curves, without .svg (default: after its columns)");
  return [options, &catalogue] { return plot(*options, catalogue); };
}

}  // namespace sage::app
