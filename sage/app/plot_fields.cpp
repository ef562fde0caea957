// sagefe plot RESULT... --picture FIELD: a picture each, or panels of one sheet.
#include <fmt/format.h>

#include "sage/app/input.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/plot_states.hpp"
#include "sage/record/field_reader.hpp"

namespace sage::app {

namespace {

void draw(Pictures& pictures, const StoredRun& run, std::size_t state) {
  const Frame frame = run.stored.frame(run.model, state);
  if (run.failed(state))
    pictures.on_failure(run.model, frame.report(), run.stored.failure(), frame.view());
  else if (run.ends_its_stage(state))
    pictures.on_stage_end(run.model, frame.report().stage, {}, frame.view());
  else
    pictures.draw_increment(run.model, frame.report(), frame.view());
}

void say_failure(const StoredRun& run) {
  if (!run.stored.failure().empty())
    fmt::print(stderr, "{}: the run did not converge: {}\n", run.file, run.stored.failure());
}

}  // namespace

void plot_pictures(const PlotOptions& options, const Catalogue& catalogue) {
  for (const std::string& file : options.files) {
    const StoredRun run(file, catalogue);
    require_fields(options.pictures, {}, {fields_of(run.model)});
    const std::vector<std::size_t> states = states_of(run, options.at);
    PictureOptions look = options.look;
    look.title = options.title;
    Pictures pictures(plot_folder(options, file), std::filesystem::path(file).stem().string(), options.pictures,
                      look);
    for (std::size_t state : states) draw(pictures, run, state);
    for (const std::filesystem::path& picture : pictures.files()) fmt::print("{}\n", picture.string());
    say_failure(run);
  }
}

void plot_sheet(const PlotOptions& options, const Catalogue& catalogue) {
  std::vector<std::unique_ptr<StoredRun>> runs;
  std::vector<std::unique_ptr<Frame>> frames;
  FieldSheet sheet;
  sheet.title = options.title;
  sheet.look = options.look;
  sheet.one_scale = !options.own_scales;
  // Side by side: the fields of a state, or the states of a field.
  if (options.pictures.size() > 1) sheet.columns = static_cast<int>(options.pictures.size());
  const bool several = options.files.size() > 1;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const StoredRun& run = *runs.emplace_back(std::make_unique<StoredRun>(options.files[i], catalogue));
    require_fields(options.pictures, {}, {fields_of(run.model)});
    const std::string label = i < options.labels.size() ? options.labels[i] : run.label;
    if (!several && sheet.title.empty()) sheet.title = label;
    for (std::size_t state : states_of(run, options.at)) {
      const Frame& frame = *frames.emplace_back(std::make_unique<Frame>(run.stored.frame(run.model, state)));
      const std::string words = words_of_state(run, state, frame);
      for (const std::string& field : options.pictures) {
        FieldPanel& panel = sheet.panels.emplace_back(FieldPanel{&run.model, frame.view(), field});
        panel.title = several ? label : words;
        panel.state = several ? words : "";
      }
    }
    say_failure(run);
  }
  const std::string stem = std::filesystem::path(options.files.front()).stem().string();
  write_plot(plot_path(options, stem + "_" + fmt::format("{}", fmt::join(options.pictures, "_"))),
             sheet_svg(sheet));
}

}  // namespace sage::app
