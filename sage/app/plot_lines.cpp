// sagefe plot RESULT... --line or --interface: curves of fields over a place.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "sage/app/input.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/plot_states.hpp"
#include "sage/core/unit_suffix.hpp"
#include "sage/draw/picture_field.hpp"
#include "sage/draw/plot.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

struct Line {
  Vector2 from = Vector2::Zero(), to = Vector2::Zero();
};

// X,Y:X,Y.  Throws std::invalid_argument that says so.
Line line_from(const std::string& text) {
  double numbers[4] = {};
  const char *at = text.data(), *end = text.data() + text.size();
  for (int i = 0; i < 4; ++i) {
    const auto [stop, error] = std::from_chars(at, end, numbers[i]);
    const bool last = i == 3;
    const bool good =
        error == std::errc() && (last ? stop == end : stop < end && *stop == (i == 1 ? ':' : ','));
    if (!good || !std::isfinite(numbers[i])) throw std::invalid_argument("--line " + text + ": wanted X,Y:X,Y");
    at = stop + (last ? 0 : 1);
  }
  const Line line{{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
  if (line.from == line.to) throw std::invalid_argument("--line " + text + ": its ends are one point");
  return line;
}

// The coordinate that places along a line are told apart by.
struct Abscissa {
  int axis = -1;  // 0 or 1; -1: the distance from the first place
  std::string label;
};

Abscissa abscissa_of(const Model& model, const Vector2& along) {
  const AxisNames names = axis_names(model.geometry);
  const std::string& unit = model.units.length;
  if (along.y() == 0.0) return {0, std::string(names.x) + unit_suffix(unit)};
  if (along.x() == 0.0) return {1, std::string(names.y) + unit_suffix(unit)};
  return {-1, "distance along the line" + unit_suffix(unit)};
}

FieldChoice choice_of(const FieldTable& table, const std::string& name) {
  const std::optional<FieldChoice> choice = table.choose(name);
  if (!choice || (choice->entry->place() != FieldPlace::node && choice->entry->place() != FieldPlace::point))
    throw UsageError("S644", "--picture: " + unknown_field(table, name, false));
  return *choice;
}

// What a picture shows along a line; a gap where there is nothing that fills an area.
PlotSeries along_line(const Model& model, const Solution& solution, const FieldChoice& field, const Line& line,
                      NodalRule rule) {
  constexpr int kSamples = 200;
  PlotSeries series;
  const PictureValues values(model, solution, field, rule);
  const Vector2 along = line.to - line.from;
  const int axis = abscissa_of(model, along).axis;
  for (int i = 0; i <= kSamples; ++i) {
    const double part = static_cast<double>(i) / kSamples;
    const Vector2 at = line.from + part * along;
    series.x.push_back(axis < 0 ? part * along.norm() : at[axis]);
    series.y.push_back(values.at(at));
  }
  return series;
}

// From the first to the last integration point of the active interfaces of the model.
Vector2 extent_of_interfaces(const Model& model) {
  Vector2 low = Vector2::Constant(HUGE_VAL), high = -low;
  for (const Group& group : model.groups)
    if (group.entry->kind == ElementKind::interface)
      for (int node : group.nodes) {
        low = low.cwiseMin(model.mesh.x.col(node));
        high = high.cwiseMax(model.mesh.x.col(node));
      }
  return high - low;
}

// For each element of a group of interfaces the first one of its line: elements follow each other where they have an
// entry of the layout in common.
std::vector<int> lines_of_interfaces(const Group& group, const std::vector<int>& entries) {
  std::vector<int> line(static_cast<std::size_t>(group.elements()));
  std::map<int, int> at_entry;  // the last element that has it
  for (int e = 0; e < group.elements(); ++e) {
    line[e] = e;
    for (std::size_t i = 0; i < group.node_count(); ++i) {
      const auto [at, added] =
          at_entry.try_emplace(entries[static_cast<std::size_t>(e) * group.node_count() + i], e);
      if (added) continue;
      const int a = line[at->second], b = line[e];
      if (a != b) std::ranges::replace(line, std::max(a, b), std::min(a, b));
    }
  }
  return line;
}

// At the integration points of the interfaces along x or y, with a gap between groups, and between the two sides of a
// wall in one group.
PlotSeries along_interfaces(const Model& model, const Solution& solution, const FieldChoice& field, int axis) {
  PlotSeries series;
  const std::span<const GroupData> groups = solution.groups();
  const NodalLayout layout = nodal_layout(model, *solution.activity);
  Eigen::Matrix2Xd nodes;
  std::vector<double> values(field.entry->size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (group.entry->kind != ElementKind::interface || solution.activity->group[g] == 0) continue;
    std::map<int, std::vector<std::pair<double, double>>> rows;
    const std::vector<int> line = lines_of_interfaces(group, layout.of_group[g]);
    const int points = group.element->traits().points;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, nodes);
      for (int p = 0; p < points; ++p) {
        read_field(*field.entry, PointState(model.mesh, groups[g], static_cast<std::size_t>(e * points + p)),
                   values.data());
        rows[line[e]].emplace_back(group.element->position(nodes, p)[axis], chosen(field, values.data()));
      }
    }
    for (auto& [first, row] : rows) {
      std::ranges::sort(row, {}, &std::pair<double, double>::first);
      if (!series.x.empty()) row.insert(row.begin(), {row.front().first, kGap});
      for (const auto& [x, y] : row) series.x.push_back(x), series.y.push_back(y);
    }
  }
  return series;
}

// A run in one state.
struct Shown {
  const StoredRun* run;
  Frame frame;
  std::string label;
};

std::vector<Shown> states_to_show(const PlotOptions& options, const StoredRuns& runs) {
  std::vector<Shown> shown;
  const std::vector<std::string> labels = labels_of(runs, options.labels);
  const bool labelled = runs.size() > 1 || !options.labels.empty();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const StoredRun& run = *runs[i];
    for (std::size_t state : states_of(run, options.at)) {
      Frame frame = run.stored.frame(run.model, state);
      const std::string words = words_of_state(run, state, frame);
      shown.push_back({&run, std::move(frame), labelled ? labels[i] + ": " + words : words});
    }
  }
  return shown;
}

// That some state of every run has the fields at all.
void expect_fields(const PlotOptions& options, const StoredRuns& runs, const std::vector<std::string>& fields,
                   ElementKind kind) {
  for (const auto& run : runs) {
    const FieldTable table = fields_of(run->model);
    const std::vector<std::size_t> states = states_of(*run, options.at);
    for (const std::string& name : fields) expect_numbers(*run, states, choice_of(table, name), name, kind);
  }
}

// Throws UsageError where all of a line lies outside what fills an area.
void expect_on_line(const std::string& line, const StoredRun& run, const std::vector<PlotSeries>& curves) {
  const auto known = [](const PlotSeries& curve) {
    return std::ranges::any_of(curve.y, [](double y) { return std::isfinite(y); });
  };
  if (std::ranges::any_of(curves, known)) return;
  const Eigen::Matrix2Xd& x = run.model.mesh.x;
  throw UsageError(
      "S645",
      fmt::format("--line {}: nothing of {} lies on it; its mesh goes from {:.6g},{:.6g} to {:.6g},{:.6g}",
                  line, run.file, x.row(0).minCoeff(), x.row(1).minCoeff(), x.row(0).maxCoeff(),
                  x.row(1).maxCoeff()));
}

StoredRuns open_runs(const PlotOptions& options, const Catalogue& catalogue) {
  StoredRuns runs;
  for (const std::string& file : options.files) runs.push_back(std::make_unique<StoredRun>(file, catalogue));
  return runs;
}

// A panel a field, a curve a state.
void plot_over_places(const PlotOptions& options, const Catalogue& catalogue,
                      const std::vector<std::string>& fields, const char* what) {
  const StoredRuns runs = open_runs(options, catalogue);
  const std::vector<Shown> shown = states_to_show(options, runs);
  const Model& first = runs.front()->model;
  const bool interfaces = options.line.empty();
  const Line line = interfaces ? Line{} : line_from(options.line);
  Vector2 along = line.to - line.from;
  if (interfaces) {
    along = extent_of_interfaces(first);
    if (!(along.x() >= 0.0))
      throw UsageError("S645", options.files.front() + ": --interface: the model has no interface");
    along[along.x() >= along.y() ? 1 : 0] = 0.0;
  }
  expect_fields(options, runs, fields, interfaces ? ElementKind::interface : ElementKind::solid);
  const FieldTable first_table = fields_of(first);
  PlotSheet sheet;
  sheet.title = options.title.empty() && runs.size() == 1 ? first.title : options.title;
  sheet.note = interfaces ? "at the integration points of the interfaces" : "along the undeformed mesh";
  for (const std::string& name : fields) {
    const std::string rule = rule_text(*choice_of(first_table, name).entry, options.look.rule);
    if (!interfaces && !rule.empty() && sheet.note.find(rule) == std::string::npos) sheet.note += "; " + rule;
    Plot& plot = sheet.panels.emplace_back();
    plot.x_label = abscissa_of(first, along).label;
    plot.y_label = (interfaces ? "interface " : "") + describe(choice_of(first_table, name), first);
    for (const Shown& state : shown) {
      const Model& model = state.run->model;
      const FieldTable table = fields_of(model);
      const FieldChoice field = choice_of(table, name);
      PlotSeries series = interfaces
                              ? along_interfaces(model, state.frame.view(), field, along.x() != 0.0 ? 0 : 1)
                              : along_line(model, state.frame.view(), field, line, options.look.rule);
      series.name = state.label;
      series.markers = true;
      plot.series.push_back(std::move(series));
    }
    std::vector<double*> values;
    for (PlotSeries& series : plot.series)
      for (double& y : series.y) values.push_back(&y);
    unfold_angles(*choice_of(first_table, name).entry, std::move(values));
    if (!interfaces) expect_on_line(options.line, *runs.front(), plot.series);
  }
  const std::string stem = std::filesystem::path(options.files.front()).stem().string();
  write_plot(options, plot_path(options, fmt::format("{}_{}", stem, what)), sheet_svg(sheet));
}

}  // namespace

std::string line_error(const std::string& text) {
  try {
    line_from(text);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

void plot_line(const PlotOptions& options, const Catalogue& catalogue) {
  if (options.pictures.empty()) throw UsageError("S645", "--line: of which fields? --picture FIELD");
  plot_over_places(options, catalogue, options.pictures, "line");
}

void plot_interface(const PlotOptions& options, const Catalogue& catalogue) {
  const std::vector<std::string> usual = {"traction_normal", "traction_shear", "stress_level"};
  plot_over_places(options, catalogue, options.pictures.empty() ? usual : options.pictures, "interface");
}

}  // namespace sage::app
