#include "sage/app/plot_states.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "sage/app/input.hpp"
#include "sage/app/run_source.hpp"

namespace sage::app {

namespace {

constexpr std::string_view kStrain = "strain=";

// An increment of a stage, from 1 (increment 0 = the stage's last, stage 0 = the file's last), or a strain.
struct Moment {
  int stage = 0, increment = 0;
  std::optional<double> strain;
};

template <class Number>
bool whole_number(std::string_view digits, Number& value) {
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size();
}

// Throws std::invalid_argument that says what is wanted.
Moment moment_from(std::string_view text) {
  Moment moment;
  const auto wrong = [&] {
    throw std::invalid_argument("--at " + std::string(text) +
                                ": wanted STAGE[:INCREMENT], both from 1, or strain=VALUE");
  };
  if (text.starts_with(kStrain)) {
    double strain = 0.0;
    if (!whole_number(text.substr(kStrain.size()), strain) || !std::isfinite(strain)) wrong();
    moment.strain = strain;
    return moment;
  }
  const std::size_t colon = text.find(':');
  if (colon != 0 && (!whole_number(text.substr(0, colon), moment.stage) || moment.stage < 1)) wrong();
  if (colon != std::string_view::npos &&
      (!whole_number(text.substr(colon + 1), moment.increment) || moment.increment < 1))
    wrong();
  return moment;
}

// Mean displacement along y of the deck's nodes of a report.
double mean_uy(const Model& model, const Report& report, const Solution& solution) {
  double sum = 0.0;
  int count = 0;
  for (int node : report.nodes) {
    if (node >= model.mesh.deck_nodes) continue;
    sum += (*solution.u)[DofMap::displacement(node) + 1];
    ++count;
  }
  return count > 0 ? sum / count : NAN;
}

std::size_t state_at_strain(const StoredRun& run, const std::string& text, double strain) {
  constexpr double kSame = 1e-6;  // strains on a command line have fewer digits
  std::string known;
  for (std::size_t i = 0; i < run.stored.states().size(); ++i) {
    const std::optional<double> here = run.axial_strain(run.stored.frame(run.model, i));
    if (!here) continue;
    if (std::abs(*here - strain) <= kSame) return i;
    known += fmt::format(" {:.6g}", *here);
  }
  throw UsageError(run.file + ": --at " + text +
                   (known.empty() ? ": the deck has no triaxial report, whose strain it could be"
                                  : ": the file has no such state; its strains are" + known));
}

std::size_t state_at(const StoredRun& run, const std::string& text) {
  const Moment moment = moment_from(text);
  if (moment.strain) return state_at_strain(run, text, *moment.strain);
  const auto& states = run.stored.states();
  const int stage = moment.stage > 0 || states.empty() ? moment.stage : states.back().stage + 1;
  std::string known;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto& state = states[i];
    if (state.stage + 1 == stage &&
        (moment.increment == 0 ? run.ends_its_stage(i) : state.increment == moment.increment))
      return i;
    known += fmt::format(" {}:{}", state.stage + 1, state.increment);
  }
  throw UsageError("--at " + text + ": the file has no such state; it has" + known);
}

}  // namespace

StoredRun::StoredRun(const std::string& name, const Catalogue& catalogue)
    : file(name),
      stored((keep_input(name), name)),
      model(model_of(stored.source(), stored.deck_name(), catalogue)) {
  stored.expect_model(model);
  label = model.title;
}

bool StoredRun::ends_its_stage(std::size_t state) const {
  const auto& states = stored.states();
  return state + 1 == states.size() || states[state + 1].stage != states[state].stage;
}

std::optional<double> StoredRun::axial_strain(const Frame& frame) const {
  for (const Report& report : model.reports) {
    if (report.kind != ReportKind::triaxial) continue;
    if (frame.report().stage < report.stage) return std::nullopt;
    double start = 0.0;
    for (std::size_t i = 0; i < stored.states().size() && stored.states()[i].stage < report.stage; ++i)
      if (ends_its_stage(i)) start = mean_uy(model, report, stored.frame(model, i).view());
    return -(mean_uy(model, report, frame.view()) - start) / report.height;
  }
  return std::nullopt;
}

std::string moment_error(const std::string& text) {
  try {
    moment_from(text);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

std::vector<std::size_t> states_of(const StoredRun& run, const std::vector<std::string>& at) {
  std::vector<std::size_t> chosen;
  for (const std::string& text : at) chosen.push_back(state_at(run, text));
  if (at.empty())
    for (std::size_t i = 0; i < run.stored.states().size(); ++i)
      if (run.ends_its_stage(i)) chosen.push_back(i);
  return chosen;
}

std::string words_of_state(const StoredRun& run, std::size_t state, const Frame& frame) {
  const StepReport& report = frame.report();
  std::string words =
      run.failed(state)
          ? fmt::format("NOT CONVERGED: stage {}, load factor {:.4g}", report.stage + 1, report.load_factor)
      : run.ends_its_stage(state) ? fmt::format("end of stage {}", report.stage + 1)
                                  : fmt::format("stage {}, increment {}", report.stage + 1, report.increment);
  if (const std::optional<double> strain = run.axial_strain(frame))
    words += fmt::format(", axial strain {:.4g}", *strain);
  return words;
}

}  // namespace sage::app
