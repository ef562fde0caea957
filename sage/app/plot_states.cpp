#include "sage/app/plot_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sage/analysis/stream_function.hpp"
#include "sage/app/input.hpp"
#include "sage/app/run_source.hpp"
#include "sage/app/state_choice.hpp"
#include "sage/draw/diagram.hpp"

namespace sage::app {

namespace {

// Mean displacement along y of the deck's nodes of a report.
double mean_uy(const Model& model, const Report& report, const Solution& solution) {
  const std::vector<int> nodes = report_nodes(model, report);
  double sum = 0.0;
  for (int node : nodes) sum += (*solution.u)[DofMap::displacement(node) + 1];
  return nodes.empty() ? NAN : sum / static_cast<double>(nodes.size());
}

constexpr double kSame = 1e-6;  // strains and load factors on a command line have fewer digits

// value: of a state, nothing where it has none.
template <class Value>
std::size_t state_with(const StoredRun& run, const StateChoice& choice, double wanted, const char* what,
                       const Value& value) {
  std::string known;
  for (std::size_t i = 0; i < run.stored.states().size(); ++i) {
    const std::optional<double> here = value(run.stored.frame(run.model, i));
    if (!here) continue;
    if (std::abs(*here - wanted) <= kSame) return i;
    known += fmt::format(" {:.6g}", *here);
  }
  throw UsageError(
      "S643", fmt::format("{}: --at {}: {}", run.file, choice.words,
                          known.empty() ? fmt::format("no state has {}", what)
                                        : fmt::format("the file has no such state; its {} are{}; sagefe run "
                                                      "--result --states {} writes it",
                                                      what, known, choice.words)));
}

std::size_t state_at(const StoredRun& run, const StateChoice& choice) {
  const auto& states = run.stored.states();
  const int last = states.empty() ? 0 : states.back().stage + 1;
  if (choice.strain)
    return state_with(run, choice, *choice.strain, "strains",
                      [&](const Frame& frame) { return run.axial_strain(frame); });
  if (choice.load)
    return state_with(run, choice, *choice.load, "load factors of the last stage", [&](const Frame& frame) {
      return frame.report().stage + 1 == last ? std::optional(frame.report().load_factor) : std::nullopt;
    });
  const int stage = choice.stage > 0 ? choice.stage : last;
  std::string known;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto& state = states[i];
    if (state.stage + 1 == stage &&
        (choice.increment == 0 ? run.ends_its_stage(i) : state.increment == choice.increment))
      return i;
    known += fmt::format(" {}:{}", state.stage + 1, state.increment);
  }
  throw UsageError(
      "S643", fmt::format("{}: --at {}: the file has no such state; it has{}; sagefe run --result --states "
                          "STAGE:INCREMENT writes more",
                          run.file, choice.words, known));
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

std::vector<std::size_t> states_of(const StoredRun& run, const std::vector<std::string>& at) {
  std::vector<std::size_t> chosen;
  for (const std::string& text : at)
    for (const StateChoice& choice : state_choices(text)) {
      const std::size_t state = state_at(run, choice);
      if (std::ranges::find(chosen, state) == chosen.end()) chosen.push_back(state);
    }
  if (at.empty())
    for (std::size_t i = 0; i < run.stored.states().size(); ++i)
      if (run.ends_its_stage(i)) chosen.push_back(i);
  return chosen;
}

namespace {

// What pictures and lines show: soil, and the elements that water flows through.
bool fills_area(ElementKind kind) {
  return kind == ElementKind::solid || kind == ElementKind::flow;
}

// Whether an active element of one of these kinds has one at any of its points.
template <class OfKind>
bool has_number(const Model& model, const Frame& frame, const FieldChoice& field, const OfKind& of_kind) {
  const Solution now = frame.view();
  std::vector<double> value(field.entry->size());
  for (std::size_t g = 0; g < now.groups().size(); ++g) {
    const GroupData& data = now.groups()[g];
    const ElementKind kind = data.group->entry->kind;
    if (!of_kind(kind) || now.activity->group[g] == 0 || !applies(*field.entry, data)) continue;
    const std::size_t points =
        static_cast<std::size_t>(data.group->elements() * data.group->element->traits().points);
    for (std::size_t p = 0; p < points; ++p) {
      read_field(*field.entry, PointState(model.mesh, data, p), value.data());
      if (std::isfinite(chosen(field, value.data()))) return true;
    }
  }
  return false;
}

void expect_same_units(const StoredRun& a, const StoredRun& b) {
  const auto words = [](const UnitSystem& units) {
    return fmt::format("{}, {}, {}", units.length, units.force, units.stress);
  };
  const std::string of_a = words(a.model.units), of_b = words(b.model.units);
  if (of_a != of_b)
    throw UsageError(
        "S646", fmt::format("{} is in {}, {} in {}: they can't be drawn on one axis or scale; draw them in "
                            "separate files",
                            a.file, of_a, b.file, of_b));
}

// A flow may have none, in all of the states.
void expect_stream_function(const StoredRun& run, const std::vector<std::size_t>& states,
                            const FieldChoice& field) {
  if (field.entry->name != kStreamFunction) return;
  std::string reason;
  for (const std::size_t state : states) {
    const Frame frame = run.stored.frame(run.model, state);
    const StreamFunction stream = stream_function(run.model, frame.view());
    if (std::ranges::any_of(stream.unique, [](char unique) { return unique != 0; })) return;
    reason = stream.reason;
  }
  throw UsageError("S644", fmt::format("{}: no node has a number of {} in these states{}{}", run.file,
                                       kStreamFunction, reason.empty() ? "" : ": ", reason));
}

}  // namespace

void expect_numbers(const StoredRun& run, const std::vector<std::size_t>& states, const FieldChoice& field,
                    const std::string& name, ElementKind kind) {
  const bool areas = fills_area(kind);
  if (areas && field.entry->place() == FieldPlace::node) return expect_stream_function(run, states, field);
  const auto in_any = [&](const auto& of_kind) {
    return std::ranges::any_of(states, [&](std::size_t state) {
      return has_number(run.model, run.stored.frame(run.model, state), field, of_kind);
    });
  };
  const auto is_interface = [](ElementKind one) { return one == ElementKind::interface; };
  const auto is_structure = [](ElementKind one) { return one == ElementKind::structure; };
  if (field.entry->place() == FieldPlace::point && (areas ? in_any(fills_area) : in_any(is_interface))) return;
  const bool flows = std::ranges::any_of(
      run.model.groups, [](const Group& group) { return group.entry->kind == ElementKind::flow; });
  std::string text = fmt::format("{}: no {} has a number of {} in these states", run.file,
                                 !areas  ? "interface"
                                 : flows ? "element that fills an area"
                                         : "solid",
                                 name);
  if (field.entry->place() == FieldPlace::node)
    text += ": it is of nodes; --picture and --line show it";
  else if (areas ? in_any(is_interface) : in_any(fills_area))
    text += areas ? ": it is of interfaces; --interface shows it"
                  : ": it is of solids; --picture and --line show it";
  else if (in_any(is_structure))
    text += end_quantity(field.entry->name) >= 0
                ? ": it is of structures; --picture without --line and --interface draws it along them"
                : ": it is of structures; sagefe run --points writes it";
  throw UsageError("S644", text);
}

void expect_diagram(const StoredRun& run, const std::vector<std::size_t>& states, const std::string& name) {
  const auto quantity = static_cast<std::size_t>(diagram_of(name));
  const auto has_end = [&](std::size_t state) {
    const Frame frame = run.stored.frame(run.model, state);
    for (std::size_t g = 0; g < run.model.groups.size(); ++g)
      for (const ElementEnd& end : element_ends(run.model, frame.view(), g))
        if (!std::isnan(end.value[quantity])) return true;
    return false;
  };
  if (std::ranges::none_of(states, has_end))
    throw UsageError("S644", fmt::format("{}: no structure has {} in these states", run.file, name));
}

std::vector<std::string> labels_of(const StoredRuns& runs, const std::vector<std::string>& asked) {
  std::vector<std::string> labels;
  for (const auto& run : runs) {
    expect_same_units(*runs.front(), *run);
    const auto alike = [&](const auto& other) {
      return other != run && other->model.title == run->model.title;
    };
    const bool title = !run->model.title.empty() && std::ranges::none_of(runs, alike);
    labels.push_back(title ? run->model.title : std::filesystem::path(run->file).replace_extension().string());
  }
  std::ranges::copy(asked, labels.begin());
  const auto other_geometry = [&](const auto& run) {
    return run->model.geometry != runs.front()->model.geometry;
  };
  if (std::ranges::any_of(runs, other_geometry))
    for (std::size_t i = 0; i < runs.size(); ++i)
      labels[i] += runs[i]->model.geometry == Geometry::axisymmetric ? " (axisymmetric)" : " (plane strain)";
  return labels;
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
