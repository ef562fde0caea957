// sagefe plot RESULT... --picture FIELD: a picture each, or panels of one sheet.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "sage/app/answer.hpp"
#include "sage/app/input.hpp"
#include "sage/app/picture_formats.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/plot_states.hpp"
#include "sage/app/screen.hpp"
#include "sage/draw/diagram.hpp"
#include "sage/record/field_reader.hpp"

namespace sage::app {

namespace {

namespace fs = std::filesystem;

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
  const std::string& reason = run.stored.failure();
  if (!reason.empty())
    say_error(run.file, "the run did not converge: " + reason, code_in(reason).value_or(Code("S501")));
}

// Names of the files' pictures before the state: that of the file, and of its folder where others in the same
// folder of pictures bear the same.  Throws UsageError where that is not enough.
std::vector<std::string> stems_of(const PlotOptions& options) {
  const auto same_folder = [&](const std::string& a, const std::string& b) {
    return !options.folder.empty() || fs::weakly_canonical(fs::path(a).parent_path() / ".") ==
                                          fs::weakly_canonical(fs::path(b).parent_path() / ".");
  };
  const auto stem = [](const std::string& file) { return fs::path(file).stem().string(); };
  std::vector<std::string> stems;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const std::string& file = options.files[i];
    const bool alike = std::ranges::any_of(options.files, [&](const std::string& other) {
      return &other != &file && stem(other) == stem(file) && same_folder(other, file);
    });
    const std::string folder = fs::weakly_canonical(file).parent_path().filename().string();
    stems.push_back(alike ? folder + "_" + stem(file) : stem(file));
    for (std::size_t j = 0; j < i; ++j)
      if (stems[j] == stems[i] && same_folder(options.files[j], file))
        throw UsageError("S602",
                         fmt::format("the pictures of {} and {} would bear the same names: draw them into "
                                     "different folders (-o)",
                                     options.files[j], file));
  }
  return stems;
}

// States that complete a stage.
std::vector<std::size_t> stage_ends(const StoredRun& run) {
  std::vector<std::size_t> ends;
  for (std::size_t state = 0; state < run.stored.states().size(); ++state)
    if (run.ends_its_stage(state) && !run.failed(state)) ends.push_back(state);
  return ends;
}

// Throws UsageError.
void expect_envelope(const StoredRun& run, const std::string& name) {
  const std::vector<std::size_t> ends = stage_ends(run);
  const int reached = ends.empty() ? 0 : run.stored.states()[ends.back()].stage + 1;
  if (static_cast<std::size_t>(reached) < run.model.stages.size())
    throw UsageError("S643", fmt::format("{}: {} is of all {} stages, and the run completed {}", run.file, name,
                                         run.model.stages.size(), reached));
  expect_diagram(run, ends, name);
}

// The fields that are drawn, each once.
std::vector<std::string> fields_to_draw(const PlotOptions& options, const StoredRun& run,
                                        const std::vector<std::size_t>& states) {
  const FieldTable table = fields_of(run.model);
  require_fields(options.pictures, {}, {table});
  std::vector<std::string> names;
  for (const std::string& name : options.pictures) {
    if (std::ranges::find(names, name) != names.end()) continue;
    if (is_envelope(name))
      expect_envelope(run, name);
    else if (diagram_of(name) >= 0)
      expect_diagram(run, states, name);
    else
      expect_numbers(run, states, picture_field(table, name), name, ElementKind::solid);
    names.push_back(name);
  }
  return names;
}

// An envelope is of all stages: an option that chooses states means nothing where nothing else is drawn.
void expect_states_mean_something(const PlotOptions& options) {
  if (!options.at.empty() && std::ranges::all_of(options.pictures, is_envelope))
    throw UsageError("S905", "--at and --increment do not go with envelopes alone, which are of all stages");
}

std::vector<EnvelopeEnd> envelope_of(const StoredRun& run, const std::vector<std::size_t>& states) {
  Envelope envelope;
  for (std::size_t state : states) {
    const Frame frame = run.stored.frame(run.model, state);
    envelope.add(run.model, frame.report().stage, frame.view());
  }
  return envelope.rows();
}

// Those of the envelopes at the end of the last stage, each drawn once.
std::vector<fs::path> draw_envelopes(const PlotOptions& options, const StoredRun& run, const std::string& stem,
                                     const PictureOptions& look, const std::vector<std::string>& fields) {
  if (fields.empty()) return {};
  Pictures pictures(plot_folder(options, run.file), stem, fields, look);
  const std::vector<std::size_t> ends = stage_ends(run);
  for (std::size_t state : ends) {
    const Frame frame = run.stored.frame(run.model, state);
    pictures.on_stage_end(run.model, frame.report().stage, {}, frame.view());
  }
  return pictures.files();
}

}  // namespace

void plot_pictures(const PlotOptions& options, const Catalogue& catalogue) {
  expect_states_mean_something(options);
  const std::vector<std::string> stems = stems_of(options);
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const std::string& file = options.files[i];
    const StoredRun run(file, catalogue);
    const std::vector<std::size_t> states = states_of(run, options.at);
    std::vector<std::string> fields = fields_to_draw(options, run, states);
    PictureOptions look = options.look;
    look.title = options.title;
    if (i < options.labels.size()) look.title += (look.title.empty() ? "" : ": ") + options.labels[i];
    const auto envelopes = std::stable_partition(fields.begin(), fields.end(), std::not_fn(is_envelope));
    const std::vector<std::string> of_stages(envelopes, fields.end());
    fields.erase(envelopes, fields.end());
    Pictures pictures(plot_folder(options, file), stems[i], fields, look);
    for (std::size_t state : states) draw(pictures, run, state);
    std::vector<fs::path> files = pictures.files();
    std::ranges::copy(draw_envelopes(options, run, stems[i], look, of_stages), std::back_inserter(files));
    for (const fs::path& picture : files) {
      answer_file(picture);
      fmt::print("{}\n", picture.string());
      for (const auto& other : convert_picture(picture, options.formats)) {
        answer_file(other);
        fmt::print("{}\n", other.string());
      }
    }
    say_failure(run);
  }
}

void plot_sheet(const PlotOptions& options, const Catalogue& catalogue) {
  StoredRuns runs;
  for (const std::string& file : options.files) runs.push_back(std::make_unique<StoredRun>(file, catalogue));
  expect_states_mean_something(options);
  const std::vector<std::string> labels = labels_of(runs, options.labels);
  std::vector<std::unique_ptr<Frame>> frames;
  std::vector<std::unique_ptr<std::vector<EnvelopeEnd>>> envelopes;
  FieldSheet sheet;
  sheet.look = options.look;
  sheet.one_scale = !options.own_scales;
  const bool several = runs.size() > 1;
  sheet.title = several || !options.title.empty() ? options.title : labels.front();
  const bool label_panels = several || (!options.title.empty() && !options.labels.empty());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const StoredRun& run = *runs[i];
    const std::vector<std::size_t> states = states_of(run, options.at);
    const std::vector<std::string> fields = fields_to_draw(options, run, states);
    // Side by side: the fields of a state, or the states of a field; all of a run where there are several.
    constexpr std::size_t kMostBeside = 4;
    const std::size_t of_run = fields.size() * states.size();
    const bool row_each = several && of_run > 1 && of_run <= kMostBeside;
    if (row_each || fields.size() > 1) sheet.columns = static_cast<int>(row_each ? of_run : fields.size());
    for (std::size_t state : states) {
      const Frame& frame = *frames.emplace_back(std::make_unique<Frame>(run.stored.frame(run.model, state)));
      const std::string words = words_of_state(run, state, frame);
      for (const std::string& field : fields) {
        if (is_envelope(field)) continue;
        FieldPanel& panel = sheet.panels.emplace_back(FieldPanel{&run.model, frame.view(), field});
        panel.title = label_panels ? labels[i] : words;
        panel.state = label_panels ? words : "";
      }
    }
    if (std::ranges::any_of(fields, is_envelope)) {
      const std::vector<std::size_t> ends = stage_ends(run);
      envelopes.push_back(std::make_unique<std::vector<EnvelopeEnd>>(envelope_of(run, ends)));
      const Frame& last =
          *frames.emplace_back(std::make_unique<Frame>(run.stored.frame(run.model, ends.back())));
      for (const std::string& field : fields) {
        if (!is_envelope(field)) continue;
        FieldPanel& panel = sheet.panels.emplace_back(FieldPanel{&run.model, last.view(), field});
        panel.envelope = envelopes.back().get();
        panel.title = label_panels ? labels[i] : "all stages";
        panel.state = label_panels ? "all stages" : "";
      }
    }
    say_failure(run);
  }
  constexpr int kBeside = 430;  // px, so that panels of flat models stand side by side
  if (sheet.panels.size() > 2) sheet.look.width = kBeside;
  const std::string stem = std::filesystem::path(options.files.front()).stem().string();
  write_plot(options, plot_path(options, stem + "_" + fmt::format("{}", fmt::join(options.pictures, "_"))),
             sheet_svg(sheet));
}

}  // namespace sage::app
