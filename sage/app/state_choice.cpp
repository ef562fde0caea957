#include "sage/app/state_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sage/analysis/external_loads.hpp"
#include "sage/messages/parse_number.hpp"
#include "sage/model/activity.hpp"

namespace sage::app {

namespace {

constexpr std::string_view kStrain = "strain=", kLoad = "load=";
constexpr double kSame = 1e-6;  // strains and load factors on a command line have fewer digits

template <class Number>
bool whole_number(std::string_view digits, Number& value) {
  const std::optional<Number> read = parse_number<Number>(digits);
  value = read.value_or(value);
  return read.has_value();
}

// keyword: "strain=", "load=" or empty.
bool read_choice(std::string_view keyword, std::string_view text, StateChoice& choice) {
  choice.words = std::string(keyword) + std::string(text);
  if (!keyword.empty()) {
    double value = 0.0;
    if (!whole_number(text, value) || !std::isfinite(value)) return false;
    (keyword == kStrain ? choice.strain : choice.load) = value;
    return true;
  }
  const std::size_t colon = text.find(':');
  if (colon != 0 && (!whole_number(text.substr(0, colon), choice.stage) || choice.stage < 1)) return false;
  return colon == std::string_view::npos ||
         (whole_number(text.substr(colon + 1), choice.increment) && choice.increment >= 1);
}

// Axial strains of the first specimen of the deck's reports at the ends of the increments of its last stage: what
// is prescribed of its end since the start of the report's stage.
std::vector<double> strains_of_last_stage(const Model& model) {
  const auto report = std::ranges::find(model.reports, ReportKind::triaxial, &Report::kind);
  if (report == model.reports.end())
    throw std::invalid_argument(
        "the deck has no triaxial report, whose strain it could be; load=VALUE or STAGE:INCREMENT name states "
        "of "
        "any deck");
  const std::vector<int> nodes = report_nodes(model, *report);
  Activity activity(model);
  double before = 0.0, last = 0.0;
  for (int s = 0; s < static_cast<int>(model.stages.size()); ++s) {
    const Stage& stage = model.stages[s];
    activity.enter(stage);
    if (s < report->stage) continue;
    const Eigen::VectorXd added = prescribed_rate(stage, activity.dof_map);
    before += last;
    last = 0.0;
    for (int node : nodes) {
      if (!activity.holds(node, 1))
        throw std::invalid_argument(
            "the deck loads the specimen's end and does not move it, so that its strain is not known before "
            "the "
            "run; name the state by load=VALUE (part of the last stage's load) or STAGE:INCREMENT");
      last += added[DofMap::displacement(node) + 1] / static_cast<double>(nodes.size());
    }
  }
  const int increments = model.stages.back().increments;
  std::vector<double> strains;
  for (int i = 1; i <= increments; ++i) strains.push_back(-(before + last * i / increments) / report->height);
  return strains;
}

// Increment of the last stage, from 1, whose value is nearest; a note where it is another.
int nearest(const std::vector<double>& values, double wanted, const StateChoice& choice, const char* what,
            std::vector<std::string>& notes) {
  const auto away = [&](double value) { return std::abs(value - wanted); };
  const auto at = std::ranges::min_element(values, {}, away);
  const auto [low, high] = std::ranges::minmax(values);
  const double step = (high - low) / static_cast<double>(values.size());
  if (wanted < std::min(0.0, low) - step - kSame || wanted > high + step + kSame)
    throw std::invalid_argument(
        fmt::format("{}: the {} of the last stage goes from {:.6g} to {:.6g}", choice.words, what, low, high));
  const int increment = static_cast<int>(at - values.begin()) + 1;
  if (away(*at) > kSame)
    notes.push_back(fmt::format("--states {}: no increment ends there; the nearest is increment {}, {} {:.6g}",
                                choice.words, increment, what, *at));
  return increment;
}

std::vector<double> load_factors(const Stage& stage) {
  std::vector<double> factors;
  for (int i = 1; i <= stage.increments; ++i) factors.push_back(static_cast<double>(i) / stage.increments);
  return factors;
}

// The stage of the model that a choice means, and its increment.
std::pair<Stage*, int> place_of(Model& model, const StateChoice& choice, std::vector<std::string>& notes) {
  const int stages = static_cast<int>(model.stages.size());
  if (stages == 0) throw std::invalid_argument("the deck has no stage");
  if (choice.strain)
    return {&model.stages.back(),
            nearest(strains_of_last_stage(model), *choice.strain, choice, "axial strain", notes)};
  if (choice.load && model.stages.back().is_controlled())
    throw std::invalid_argument(
        choice.words +
        ": a displacement controls the load of the last stage, so that its load factors are not "
        "known before the run; name the state by STAGE:INCREMENT");
  if (choice.load)
    return {&model.stages.back(),
            nearest(load_factors(model.stages.back()), *choice.load, choice, "load factor", notes)};
  const int stage = choice.stage > 0 ? choice.stage : stages;
  if (stage > stages)
    throw std::invalid_argument(fmt::format("{}: the deck has {} stages", choice.words, stages));
  Stage& found = model.stages[stage - 1];
  if (choice.increment > found.increments)
    throw std::invalid_argument(
        fmt::format("{}: stage {} has {} increments", choice.words, stage, found.increments));
  return {&found, choice.increment > 0 ? choice.increment : found.increments};
}

}  // namespace

std::vector<StateChoice> state_choices(const std::string& text) {
  std::string_view rest = text, keyword;
  for (std::string_view known : {kStrain, kLoad})
    if (rest.starts_with(known)) keyword = known;
  rest.remove_prefix(keyword.size());
  std::vector<StateChoice> choices;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    std::string_view one = rest.substr(0, comma);
    if (!keyword.empty() && one.starts_with(keyword)) one.remove_prefix(keyword.size());
    if (!read_choice(keyword, one, choices.emplace_back()))
      throw std::invalid_argument(text + ": wanted " + kStatesWanted);
    if (more) rest.remove_prefix(comma + 1);
  }
  return choices;
}

std::string state_error(const std::string& option, const std::string& text) {
  try {
    state_choices(text);
    return "";
  } catch (const std::invalid_argument& error) {
    return option + " " + error.what();
  }
}

std::vector<int> report_nodes(const Model& model, const Report& report) {
  std::vector<int> nodes;
  std::ranges::copy_if(report.nodes, std::back_inserter(nodes),
                       [&](int node) { return node < model.mesh.deck_nodes; });
  return nodes;
}

std::vector<std::string> ask_for_states(Model& model, const std::vector<std::string>& texts) {
  std::vector<std::string> notes;
  for (const std::string& text : texts)
    for (const StateChoice& choice : state_choices(text)) {
      const auto [stage, increment] = place_of(model, choice, notes);
      stage->output_at.push_back(increment);
    }
  for (Stage& stage : model.stages) {
    std::ranges::sort(stage.output_at);
    stage.output_at.erase(std::unique(stage.output_at.begin(), stage.output_at.end()), stage.output_at.end());
  }
  return notes;
}

}  // namespace sage::app
