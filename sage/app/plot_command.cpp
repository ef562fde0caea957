// sagefe plot: pictures from a result file.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <charconv>
#include <memory>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
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

struct PlotOptions {
  std::string file, folder;
  std::vector<std::string> pictures;
  std::vector<std::string> at;
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

int plot(const PlotOptions& options, const Catalogue& catalogue) {
  keep_input(options.file);
  const StoredResult stored(options.file);
  const Model model = model_of(stored.source(), stored.deck_name(), catalogue);
  stored.expect_model(model);
  require_fields(options.pictures, {}, {fields_of(model)});
  const std::vector<std::size_t> states = states_to_draw(stored, options.at);
  const std::filesystem::path file(options.file),
      folder = options.folder.empty() ? file.parent_path() : std::filesystem::path(options.folder);
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw OutputError("the folder " + folder.string() + " can't be made: " + error.message());
  Pictures pictures(folder, file.stem().string(), options.pictures);
  for (std::size_t state : states) draw(pictures, model, stored, state);
  for (const std::filesystem::path& picture : pictures.files()) fmt::print("{}\n", picture.string());
  if (!stored.failure().empty())
    fmt::print(stderr, "{}: the run did not converge: {}\n", options.file, stored.failure());
  return kOk;
}

}  // namespace

Command plot_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<PlotOptions>();
  parser.add_option("RESULT", options->file, "result file that `sagefe run DECK --result` wrote (STEM.h5)")
      ->required();
  parser
      .add_option(
          "--picture", options->pictures,
          "fields to draw: " + catalogue.fields.known() + ", or a history variable of a law; may be repeated")
      ->required()
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
  parser.add_option("-o,--output", options->folder,
                    "folder of the pictures (default: that of the result file)");
  return [options, &catalogue] { return plot(*options, catalogue); };
}

}  // namespace sage::app
