// sagefe plot: pictures from results on disk.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <charconv>
#include <memory>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/run_source.hpp"
#include "sage/draw/picture.hpp"
#include "sage/record/field_reader.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/stored_result.hpp"

namespace sage::app {

namespace {

// An increment of a stage, from 1; increment 0 = the stage's last.
struct Moment {
  int stage = 0, increment = 0;
};

// STAGE[:INCREMENT].  Throws std::invalid_argument that says what is wanted.
Moment moment_from(const std::string& text) {
  Moment moment;
  const std::size_t colon = text.find(':');
  const auto number = [&](std::string_view digits, int& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < 1)
      throw std::invalid_argument("--at " + text + ": wanted STAGE[:INCREMENT], both from 1");
  };
  number(std::string_view(text).substr(0, colon), moment.stage);
  if (colon != std::string::npos) number(std::string_view(text).substr(colon + 1), moment.increment);
  return moment;
}

bool ends_its_stage(const StoredResult& stored, std::size_t state) {
  const auto& states = stored.states();
  return state + 1 == states.size() || states[state + 1].stage != states[state].stage;
}

std::size_t find_state(const StoredResult& stored, const std::string& text) {
  const Moment moment = moment_from(text);
  const auto& states = stored.states();
  std::string known;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto& state = states[i];
    if (state.stage + 1 == moment.stage &&
        (moment.increment == 0 ? ends_its_stage(stored, i) : state.increment == moment.increment))
      return i;
    known += fmt::format(" {}:{}", state.stage + 1, state.increment);
  }
  throw UsageError("--at " + text + ": the file has no such state; it has" + known);
}

// Those that are asked for; otherwise the ends of all stages, which `run --picture` draws.
std::vector<std::size_t> states_to_draw(const StoredResult& stored, const std::vector<std::string>& at) {
  std::vector<std::size_t> chosen;
  for (const std::string& text : at) chosen.push_back(find_state(stored, text));
  if (at.empty())
    for (std::size_t i = 0; i < stored.states().size(); ++i)
      if (ends_its_stage(stored, i)) chosen.push_back(i);
  return chosen;
}

void draw(Pictures& pictures, const Model& model, const StoredResult& stored, std::size_t state) {
  const Frame frame = stored.frame(model, state);
  const bool last = state + 1 == stored.states().size();
  if (last && !stored.failure().empty())
    pictures.on_failure(model, frame.report(), stored.failure(), frame.view());
  else if (ends_its_stage(stored, state))
    pictures.on_stage_end(model, frame.report().stage, {}, frame.view());
  else
    pictures.draw_increment(model, frame.report(), frame.view());
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw OutputError("the folder " + folder.string() + " can't be made: " + error.message());
}

void plot_fields(const PlotOptions& options, const std::string& name, const Catalogue& catalogue) {
  keep_input(name);
  const StoredResult stored(name);
  const Model model = model_of(stored.source(), stored.deck_name(), catalogue);
  stored.expect_model(model);
  require_fields(options.pictures, {}, {fields_of(model)});
  const std::vector<std::size_t> states = states_to_draw(stored, options.at);
  const std::filesystem::path file(name),
      folder = options.folder.empty() ? file.parent_path() : std::filesystem::path(options.folder);
  make_folder(folder);
  Pictures pictures(folder, file.stem().string(), options.pictures);
  for (std::size_t state : states) draw(pictures, model, stored, state);
  for (const std::filesystem::path& picture : pictures.files()) fmt::print("{}\n", picture.string());
  if (!stored.failure().empty())
    fmt::print(stderr, "{}: the run did not converge: {}\n", name, stored.failure());
}

int plot(const PlotOptions& options, const Catalogue& catalogue) {
  if (options.pictures.empty()) {
    plot_columns(options);
    return kOk;
  }
  for (const std::string& file : options.files) plot_fields(options, file, catalogue);
  return kOk;
}

}  // namespace

std::filesystem::path plot_path(const PlotOptions& options, const std::string& name) {
  const std::filesystem::path first = std::filesystem::path(options.files.front()).parent_path(),
                              folder = options.folder.empty() ? first : std::filesystem::path(options.folder);
  make_folder(folder);
  return folder / ((options.name.empty() ? name : options.name) + ".svg");
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
      "sagefe plot out/a.h5 --picture stress_yy --at 1:5");
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
      .add_option(
          "--picture", options->pictures,
          "fields to draw: " + catalogue.fields.known() + ", or a history variable of a law; may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option("--at", options->at,
                  "STAGE[:INCREMENT] of an output increment; may be repeated (default: the end of every stage)")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        try {
          moment_from(text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
  parser.add_option("-o,--output", options->folder, "folder of the pictures (default: that of the first file)");
  parser.add_option("--name", options->name,
                    "name of the file of curves, without .svg (default: after its columns)");
  return [options, &catalogue] { return plot(*options, catalogue); };
}

}  // namespace sage::app
