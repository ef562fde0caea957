// sagefe plot: pictures from results on disk.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/picture_formats.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/state_choice.hpp"
#include "sage/messages/parse_number.hpp"
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
  const auto number = [](std::string_view digits) { return parse_number<double>(digits).value_or(NAN); };
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

// What a command line asks for.
enum Mode : unsigned { kCurves = 1, kPictures = 2, kSheet = 4, kLine = 8, kInterface = 16 };
constexpr unsigned kDrawn = kPictures | kSheet, kStates = kDrawn | kLine | kInterface;

Mode mode_of(const PlotOptions& options) {
  if (options.interface) return kInterface;
  if (!options.line.empty()) return kLine;
  if (options.pictures.empty()) return kCurves;
  return options.sheet ? kSheet : kPictures;
}

// Where an option means something; elsewhere it is refused, so that none is passed over in silence.
struct OptionPlace {
  const char* option;
  unsigned modes;
  const char* words;
};
constexpr const char *kOfPictures = "pictures (--picture)", *kOfStates = "--picture, --line or --interface";
constexpr OptionPlace kPlaces[] = {
    {"--xy", kCurves, "curves of tables, without --picture, --line and --interface"},
    {"--log-x", kCurves, "curves of tables, without --picture, --line and --interface"},
    {"--at", kStates, kOfStates},
    {"--increment", kStates, kOfStates},
    {"--sheet", kSheet, kOfPictures},
    {"--own-scales", kSheet, "--picture with --sheet"},
    {"--line", kLine, "a line, without --interface"},
    {"--range", kDrawn, kOfPictures},
    {"--levels", kDrawn, kOfPictures},
    {"--extrapolate", kDrawn, kOfPictures},
    {"--no-mesh", kDrawn, kOfPictures},
    {"--deformed", kDrawn, kOfPictures},
    {"--undeformed", kDrawn, kOfPictures},
    {"--mirror", kDrawn, kOfPictures},
    {"--yielded", kDrawn, kOfPictures},
    {"--crosses", kDrawn, kOfPictures},
    {"--arrows", kDrawn, kOfPictures},
    {"--name", kCurves | kSheet | kLine | kInterface,
     "what is one file (curves, --sheet, --line, --interface)"},
};

// Throws UsageError for options that do not go together.
void expect_options_fit(const CLI::App& parser, const PlotOptions& options) {
  const Mode mode = mode_of(options);
  for (const OptionPlace& place : kPlaces)
    if (parser.count(place.option) > 0 && (place.modes & mode) == 0)
      throw UsageError("S905", fmt::format("{} is for {}", place.option, place.words));
  if (!options.labels.empty() && options.labels.size() != options.files.size())
    throw UsageError(
        "S904", fmt::format("--label: {} of them for {} files", options.labels.size(), options.files.size()));
  if (options.own_scales && std::isfinite(options.look.low))
    throw UsageError("S905",
                     "--own-scales does not go with --range LOW:HIGH, which is one scale for all panels");
  for (const std::string& file : options.files)
    if (mode != kCurves && std::filesystem::path(file).extension() == ".csv")
      throw UsageError(
          "S640", file +
                      " is a table: --picture, --line and --interface show result files (STEM.h5 of sagefe "
                      "run DECK --result)");
}

// "x.png" is "x" in that format.
void take_format_of_name(PlotOptions& options) {
  const std::filesystem::path name = options.name;
  const std::string ending = name.extension().string();
  if (ending != ".svg" && ending != ".pdf" && ending != ".png") return;
  options.name = name.stem().string();
  options.formats.push_back(ending.substr(1));
}

// A file's name in the folder of -o.
std::string name_error(const std::string& name) {
  if (!name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos) return "";
  return "--name " + name + ": wanted a file's name; its folder is that of -o";
}

int plot(const CLI::App& parser, PlotOptions options, const Catalogue& catalogue) {
  expect_options_fit(parser, options);
  take_format_of_name(options);
  require_converter(options.formats);
  switch (mode_of(options)) {
    case kInterface:
      plot_interface(options, catalogue);
      break;
    case kLine:
      plot_line(options, catalogue);
      break;
    case kCurves:
      plot_columns(options);
      break;
    case kSheet:
      plot_sheet(options, catalogue);
      break;
    case kPictures:
      plot_pictures(options, catalogue);
      break;
  }
  return kOk;
}

constexpr const char *kGroupCurves = "Curves of tables", *kGroupStates = "Fields of result files",
                     *kGroupLook = "Look of pictures";

void add_curve_options(CLI::App& parser, PlotOptions& options) {
  parser
      .add_option(
          "--xy", options.xy,
          "X:Y[,Y...]: columns Y against column X, one curve per file and Y; -NAME changes the sign; each --xy "
          "is a panel.  Default: stress and ratio against strain for a triaxial report, load against "
          "displacement for a node report (a footing).  The error of an unknown name lists the known ones")
      ->allow_extra_args(false)
      ->group(kGroupCurves);
  parser.add_flag("--log-x", options.log_x, "use a logarithmic horizontal axis, as for time")
      ->group(kGroupCurves);
}

// Which fields, of which states, where.
void add_state_options(CLI::App& parser, PlotOptions& options) {
  parser.add_option("--picture", options.pictures, std::string("a field to draw: ") + kPictureNames)
      ->allow_extra_args(false)
      ->group(kGroupStates);
  parser
      .add_option(
          "--at", options.at,
          "states: strain=VALUE[,VALUE...], the axial strain of the specimen (0.05 is 5 %); "
          "load=VALUE[,VALUE...], the load factor of the last stage; or STAGE[:INCREMENT].  May be repeated; "
          "default: the end of every stage.  The file has the states that the deck or sagefe run --states "
          "requests")
      ->allow_extra_args(false)
      ->check([](const std::string& text) { return state_error("--at", text); })
      ->group(kGroupStates);
  parser
      .add_option_function<std::vector<int>>(
          "--increment",
          [&options](const std::vector<int>& numbers) {
            for (int number : numbers) options.at.push_back(":" + std::to_string(number));
          },
          "a state: an increment of the last stage; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber)
      ->group(kGroupStates);
  parser
      .add_flag("--sheet", options.sheet,
                "write one file with one panel per picture; panels of one field share a scale")
      ->group(kGroupStates);
  parser
      .add_option("--line", options.line,
                  "X,Y:X,Y: plot the fields along this line in place of pictures, one curve per state and file")
      ->check(line_error)
      ->group(kGroupStates);
  parser
      .add_flag("--interface", options.interface,
                "plot the fields along the interfaces in place of pictures (default: traction_normal, "
                "traction_shear, stress_level)")
      ->group(kGroupStates);
}

void add_look_options(CLI::App& parser, PlotOptions& options) {
  PictureOptions& look = options.look;
  parser
      .add_option_function<std::string>(
          "--range", [&look](const std::string& text) { set_range(look, text); },
          "range of the colours: LOW:HIGH; full; auto (default) omits rare extreme values, and the legend "
          "notes it")
      ->check([](const std::string& text) {
        try {
          PictureOptions tried;
          set_range(tried, text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      })
      ->group(kGroupLook);
  parser.add_flag("--own-scales", options.own_scales, "give each panel of the sheet its own scale")
      ->group(kGroupLook);
  parser.add_option("--levels", look.levels, "approximate number of colour bands (default: 10)")
      ->check(CLI::Range(2, 100))
      ->group(kGroupLook);
  parser
      .add_flag_callback(
          "--extrapolate", [&look] { look.rule = NodalRule::extrapolated; },
          "extrapolate stresses from the integration points to the nodes (default: means of elements, as in "
          "the source chapter's figures)")
      ->group(kGroupLook);
  parser
      .add_flag_callback(
          "--no-mesh", [&look] { look.mesh = false; }, "draw no element edges")
      ->group(kGroupLook);
  parser
      .add_flag_callback(
          "--deformed", [&look] { look.deformed = true; }, "draw the displaced mesh, magnified")
      ->group(kGroupLook);
  parser
      .add_flag_callback(
          "--undeformed", [&look] { look.deformed = false; }, "draw the initial mesh (default)")
      ->group(kGroupLook);
  parser
      .add_option_function<std::string>(
          "--mirror", [&look](const std::string& text) { set_mirror(look, text); },
          "add the mirrored parts of a symmetric model: left of its left side, down below its lower side, or "
          "both")
      ->check(CLI::IsMember({"left", "down", "both"}))
      ->group(kGroupLook);
  parser
      .add_flag("--yielded", look.yielded,
                "draw the integration points, those that have reached the strength filled")
      ->group(kGroupLook);
  parser.add_flag("--crosses", look.crosses, "draw the principal stresses in the plane as crosses")
      ->group(kGroupLook);
  parser.add_flag("--arrows", look.arrows, "draw displacements as arrows")->group(kGroupLook);
}

constexpr const char* kPlotExamples =
    "Curves, from the tables that every run writes:\n"
    "  sagefe plot out/footing.report1.csv\n"
    "      load against displacement\n"
    "  sagefe plot out/a.report1.csv out/b.report1.csv out/c.report1.csv --xy axial_strain:ratio\n"
    "      measured / correct stress against strain of three runs\n"
    "Pictures, from the file out/a.h5 that `sagefe run a.dat --result --states strain=.05,.1` writes:\n"
    "  sagefe plot out/a.h5 --picture conf --picture dev --at strain=.05,.1 --sheet\n"
    "      contours of sigma_3 and of sigma_1 - sigma_3 at 5 and 10 % of strain, on one sheet\n"
    "  sagefe plot out/a.h5 --picture stress_yy --at 1:5 --mirror both --format png\n"
    "      the whole specimen at increment 5 of stage 1, as SVG and PNG\n"
    "  sagefe plot out/dam.h5 --picture flow_net --picture velocity\n"
    "      lines of equal head and stream lines, and how fast the water flows, of a seepage deck\n"
    "  sagefe plot out/a.h5 --interface --at strain=.1\n"
    "      stresses along the interface\n"
    "  sagefe plot out/a.h5 out/b.h5 --line 0,0:0,2.8 --picture stress_yy\n"
    "      a stress along the axis, of two runs";

}  // namespace

std::filesystem::path plot_folder(const PlotOptions& options, const std::string& file) {
  std::filesystem::path folder = options.folder.empty() ? std::filesystem::path(file).parent_path()
                                                        : std::filesystem::path(options.folder);
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw OutputError("S601", "the folder " + folder.string() + " can't be made: " + error.message());
  return folder;
}

std::filesystem::path plot_path(const PlotOptions& options, const std::string& name) {
  return plot_folder(options, options.files.front()) / ((options.name.empty() ? name : options.name) + ".svg");
}

void write_plot(const PlotOptions& options, const std::filesystem::path& path, const std::string& svg) {
  write_file(path, svg);
  answer_file(path);
  fmt::print("{}\n", path.string());
  for (const std::filesystem::path& other : convert_picture(path, options.formats)) {
    answer_file(other);
    fmt::print("{}\n", other.string());
  }
}

Command plot_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<PlotOptions>();
  parser.footer(kPlotExamples);
  parser
      .add_option(
          "FILE", options->files,
          "STEM.reportN.csv and other tables of sagefe run, for curves; STEM.h5 of sagefe run DECK --result, "
          "for --picture, --line and --interface (for curves it means STEM.report1.csv beside it)")
      ->required();
  parser.add_option("-o,--output", options->folder, "folder of the pictures (default: that of the first file)");
  parser
      .add_option("--name", options->name,
                  "name of the file (default: from its content); the ending .png or .pdf adds that format")
      ->check(name_error);
  add_format_option(parser, options->formats);
  parser.add_option("--title", options->title, "title (default, for one file: that of its deck)");
  parser
      .add_option(
          "--label", options->labels,
          "name of a file in legends and panels, one for each file in their order (default: the deck's title)")
      ->allow_extra_args(false);
  add_curve_options(parser, *options);
  add_state_options(parser, *options);
  add_look_options(parser, *options);
  return [options, &parser, &catalogue] { return plot(parser, *options, catalogue); };
}

}  // namespace sage::app
