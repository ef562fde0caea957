#include "sage/draw/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "sage/draw/colour_map.hpp"
#include "sage/draw/contour.hpp"
#include "sage/draw/picture_field.hpp"
#include "sage/draw/plot.hpp"
#include "sage/draw/sub_grid.hpp"
#include "sage/draw/svg.hpp"
#include "sage/record/nodal_values.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr int kBands = 10, kMostElements = 6000;
constexpr double kLeft = 70.0, kRight = 130.0, kTop = 108.0, kBottom = 54.0, kLegendText = 70.0;

// Where the deformed mesh stands on the paper.
struct View {
  Vector2 low = Vector2::Zero(), high = Vector2::Zero();  // of the deformed and the undeformed mesh
  double scale = 1.0;                                     // screen units a unit of length
  double deformation = 0.0;
  double height = 0.0;  // of the frame

  Vector2 at(const Vector2& x) const {
    return {kLeft + scale * (x.x() - low.x()), kTop + scale * (high.y() - x.y())};
  }
};

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (double factor : {5.0, 2.0})
    if (factor * power <= value) return factor * power;
  return power;
}

View make_view(const Model& model, const Solution& s, const NodalLayout& layout,
               const PictureOptions& options) {
  View view;
  if (layout.node.empty()) return view;
  view.low = view.high = model.mesh.x.col(layout.node.front());
  double largest = 0.0;
  for (int node : layout.node) {
    view.low = view.low.cwiseMin(model.mesh.x.col(node));
    view.high = view.high.cwiseMax(model.mesh.x.col(node));
    largest = std::max(largest, s.u->segment<2>(DofMap::displacement(node)).norm());
  }
  const double size = (view.high - view.low).maxCoeff();
  if (options.deformed && largest > 0.0)
    view.deformation = options.scale > 0.0 ? options.scale : std::max(1.0, round_down(0.05 * size / largest));
  for (int node : layout.node) {
    const Vector2 x = model.mesh.x.col(node) + view.deformation * s.u->segment<2>(DofMap::displacement(node));
    view.low = view.low.cwiseMin(x);
    view.high = view.high.cwiseMax(x);
  }
  const Vector2 room = (view.high - view.low).cwiseMax(1e-6 * size);
  view.scale = std::min((options.width - kLeft - kRight) / room.x(), 620.0 / room.y());
  view.height = std::max(view.scale * room.y(), 60.0);
  return view;
}

// Everything that a picture is drawn from.
struct Scenery {
  const Model& model;
  const Solution& solution;
  NodalLayout layout;
  View view;
  FieldTable table;  // that the field is of
  FieldChoice field;
  FieldParts parts;
  std::map<std::tuple<const Element*, int, int>, SubGrid> grids = {};  // patches point into them

  bool draws(std::size_t g, ElementKind kind) const {
    return !layout.of_group[g].empty() && model.groups[g].entry->kind == kind;
  }
  Vector2 moved(int node, double deformation) const {
    return view.at(model.mesh.x.col(node) + deformation * solution.u->segment<2>(DofMap::displacement(node)));
  }
  // On the paper: one column a node of the element.
  Eigen::Matrix2Xd nodes_of(const Group& group, int e, double deformation) const {
    Eigen::Matrix2Xd at(2, static_cast<Eigen::Index>(group.node_count()));
    for (Eigen::Index i = 0; i < at.cols(); ++i) at.col(i) = moved(group.nodes_of(e)[i], deformation);
    return at;
  }
};

Scenery make_scenery(const Model& model, const Solution& solution, std::string_view field,
                     const PictureOptions& options) {
  Scenery scenery{model, solution, nodal_layout(model, *solution.activity), {}, fields_of(model), {}, {}};
  scenery.field = picture_field(scenery.table, field);
  scenery.view = make_view(model, solution, scenery.layout, options);
  scenery.parts = field_parts(model, solution, scenery.layout, *scenery.field.entry);
  return scenery;
}

// The grid that an element of this size on the paper is drawn on.
const SubGrid& grid_for(Scenery& scenery, const Group& group, const Eigen::Matrix2Xd& nodes) {
  const Element& element = *group.element;
  std::array<double, 2> longest{};  // of the sides along xi and along eta
  const bool triangle = group.entry->triangle();
  const auto& parents = group.entry->parent_nodes;
  for (const std::vector<int>& edge : element.edges()) {
    const auto &a = parents[static_cast<std::size_t>(edge[0])], &b = parents[static_cast<std::size_t>(edge[1])];
    double& side = longest[triangle || a[1] == b[1] ? 0 : 1];
    side = std::max(side, (nodes.col(edge[0]) - nodes.col(edge[1])).norm());
  }
  const int degree = element.degree();
  const int xi = sub_grid_cells(longest[0], degree), eta = triangle ? xi : sub_grid_cells(longest[1], degree);
  const auto [at, added] = scenery.grids.try_emplace({&element, xi, eta});
  if (added) at->second = sub_grid(group, xi, eta);
  return at->second;
}

std::vector<Patch> patches(Scenery& scenery) {
  std::vector<Patch> result;
  Eigen::MatrixXd at_nodes;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::solid)) continue;
    const Group& group = scenery.model.groups[g];
    const int* entry = scenery.layout.of_group[g].data();
    at_nodes.resize(scenery.parts.components, static_cast<Eigen::Index>(group.node_count()));
    for (int e = 0; e < group.elements(); ++e, entry += group.node_count()) {
      for (Eigen::Index i = 0; i < at_nodes.cols(); ++i) at_nodes.col(i) = scenery.parts.at.col(entry[i]);
      const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, e, scenery.view.deformation);
      const SubGrid& grid = grid_for(scenery, group, nodes);
      const Eigen::Matrix2Xd places = nodes * grid.N.transpose();
      const Eigen::MatrixXd parts = at_nodes * grid.N.transpose();
      Patch& patch = result.emplace_back(Patch{&grid.cells, {}});
      for (Eigen::Index p = 0; p < places.cols(); ++p)
        patch.places.push_back(
            {places.col(p), field_number(scenery.field, scenery.parts, parts.col(p).data())});
    }
  }
  return result;
}

// One colour an element: the mean over its grid.
void flatten(std::vector<Patch>& all) {
  for (Patch& patch : all) {
    double mean = 0.0;
    for (const Corner& c : patch.places) mean += c.value / static_cast<double>(patch.places.size());
    for (Corner& c : patch.places) c.value = mean;
  }
}

// A field that stays at a limit of a band (stress level 1) differs from it by rounding only, up and down; drawn
// so it would be patches of two colours.
void snap(std::vector<Patch>& all, const std::vector<double>& limits) {
  const double near = 1e-4 * (limits[1] - limits[0]);
  for (Patch& patch : all)
    for (Corner& c : patch.places)
      for (double limit : limits)
        if (std::abs(c.value - limit) < near) c.value = limit;
}

FieldRange range_of(const std::vector<Patch>& all) {
  FieldRange range;
  for (const Patch& patch : all)
    for (const Corner& c : patch.places) {
      range.low = std::min(range.low, c.value);
      range.high = std::max(range.high, c.value);
    }
  return range;
}

// The three lines above a picture.
struct Heading {
  std::string title, what, range;
};

double length(const std::string& text) {
  return static_cast<double>(text.size());
}

// A patch of a field that is not known there stays white.
void draw_bands(std::string& out, const std::vector<Patch>& all, const std::vector<double>& limits) {
  const auto unknown = [](const Patch& patch) {
    return std::ranges::any_of(patch.places, [](const Corner& c) { return std::isnan(c.value); });
  };
  const bool all_known = std::ranges::none_of(all, unknown);
  std::vector<Patch> known;
  if (!all_known) std::ranges::remove_copy_if(all, std::back_inserter(known), unknown);
  const std::vector<std::string> paths = band_paths(all_known ? all : known, limits);
  for (std::size_t band = 0; band < paths.size(); ++band) {
    const std::string colour =
        hex(viridis((static_cast<double>(band) + 0.5) / static_cast<double>(paths.size())));
    if (!paths[band].empty())
      fmt::format_to(std::back_inserter(out),
                     "<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.4\" d=\"{1}\"/>\n", colour,
                     paths[band]);
  }
}

void draw_mesh(std::string& out, const std::vector<Patch>& all) {
  std::string path;
  for (const Patch& patch : all) append_path(path, polygon_of(patch, patch.grid->outline));
  fmt::format_to(
      std::back_inserter(out),
      "<path fill=\"none\" stroke=\"#000000\" stroke-opacity=\"0.28\" stroke-width=\"0.6\" d=\"{}\"/>\n", path);
}

void append_line(std::string& path, const Eigen::Matrix2Xd& places) {
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", i == 0 ? 'M' : 'L', places(0, i), places(1, i));
}

// Edges of solids that only one element has, undeformed.
void draw_outline(std::string& out, Scenery& scenery) {
  struct Edge {
    std::size_t group;
    int element;
    std::size_t edge;
    int uses;
  };
  std::map<std::pair<int, int>, Edge> edges;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::solid)) continue;
    const Group& group = scenery.model.groups[g];
    for (int e = 0; e < group.elements(); ++e)
      for (std::size_t k = 0; k < group.element->edges().size(); ++k) {
        const std::vector<int>& edge = group.element->edges()[k];
        ++edges
              .try_emplace(std::minmax(group.nodes_of(e)[edge[0]], group.nodes_of(e)[edge[1]]),
                           Edge{g, e, k, 0})
              .first->second.uses;
      }
  }
  out += "<g fill=\"none\" stroke=\"#666666\" stroke-width=\"1\" stroke-dasharray=\"5 4\">\n";
  for (const auto& [ends, edge] : edges) {
    if (edge.uses != 1) continue;
    const Group& group = scenery.model.groups[edge.group];
    const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, edge.element, 0.0);
    const SubGrid& grid = grid_for(scenery, group, nodes);
    std::string path;
    append_line(path, nodes * grid.N(grid.edges[edge.edge], Eigen::all).transpose());
    fmt::format_to(std::back_inserter(out), "<path d=\"{}\"/>\n", path);
  }
  out += "</g>\n";
}

// Both faces of every interface.  Three nodes lie on a parabola, as those of the solids beside it.
void draw_interfaces(std::string& out, const Scenery& scenery) {
  std::string path;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::interface)) continue;
    const Group& group = scenery.model.groups[g];
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& side : group.element->edges()) {
        std::vector<Vector2> at;
        for (int node : side) at.push_back(scenery.moved(group.nodes_of(e)[node], scenery.view.deformation));
        fmt::format_to(std::back_inserter(path), "M{:.2f} {:.2f}", at[0].x(), at[0].y());
        if (at.size() == 3) {
          const Vector2 control = 2.0 * at[2] - 0.5 * (at[0] + at[1]);
          fmt::format_to(std::back_inserter(path), "Q{:.2f} {:.2f} ", control.x(), control.y());
        } else {
          path += 'L';
        }
        fmt::format_to(std::back_inserter(path), "{:.2f} {:.2f}", at[1].x(), at[1].y());
      }
  }
  if (!path.empty())
    fmt::format_to(std::back_inserter(out),
                   "<path fill=\"none\" stroke=\"#b2182b\" stroke-width=\"1.8\" d=\"{}\"/>\n", path);
}

// From end to end.
void draw_structures(std::string& out, const Scenery& scenery) {
  std::string path;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::structure)) continue;
    const Group& group = scenery.model.groups[g];
    for (int e = 0; e < group.elements(); ++e)
      append_line(path, scenery.nodes_of(group, e, scenery.view.deformation).leftCols(group.entry->corners));
  }
  if (!path.empty())
    fmt::format_to(std::back_inserter(out),
                   "<path fill=\"none\" stroke=\"#1f4e9c\" stroke-width=\"2.4\" d=\"{}\"/>\n", path);
}

void draw_axes(std::string& out, const Scenery& scenery) {
  const View& view = scenery.view;
  const AxisNames names = axis_names(scenery.model.geometry);
  const std::string& unit = scenery.model.units.length;
  const double bottom = kTop + view.height + 10.0, left = kLeft - 10.0;
  const double right = view.at(view.high).x();
  const int across = std::max(2, static_cast<int>((right - kLeft) / 70.0));
  const std::vector<double> xs = round_ticks(view.low.x(), view.high.x(), across);
  const std::vector<double> ys =
      round_ticks(view.low.y(), view.high.y(), std::max(2, static_cast<int>(view.height / 60.0)));
  const std::vector<std::string> x_labels = tick_labels(xs), y_labels = tick_labels(ys);
  svg::line(out, kLeft, bottom, right, bottom, "#666666", 1.0);
  svg::line(out, left, kTop, left, kTop + view.height, "#666666", 1.0);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const double x = view.at({xs[i], 0.0}).x();
    svg::line(out, x, bottom, x, bottom + 5.0, "#666666", 1.0);
    svg::text(out, x, bottom + 19.0, x_labels[i], svg::kFont - 1, "middle");
  }
  for (std::size_t i = 0; i < ys.size(); ++i) {
    const double y = view.at({0.0, ys[i]}).y();
    svg::line(out, left - 5.0, y, left, y, "#666666", 1.0);
    svg::text(out, left - 8.0, y + 4.0, y_labels[i], svg::kFont - 1, "end");
  }
  svg::text(out, right + 14.0, bottom + 19.0, fmt::format("{} [{}]", names.x, unit), svg::kFont, "start");
  svg::text(out, 8.0, kTop - 12.0, fmt::format("{} [{}]", names.y, unit), svg::kFont, "start");
}

void draw_legend(std::string& out, const std::vector<double>& limits, double left, double height) {
  const std::size_t bands = limits.size() - 1;
  const double box = std::clamp(height / static_cast<double>(bands), 16.0, 30.0);
  const std::vector<std::string> labels = tick_labels(limits);
  const double bottom = kTop + box * static_cast<double>(bands);
  for (std::size_t k = 0; k < bands; ++k) {
    const std::string colour = hex(viridis((static_cast<double>(k) + 0.5) / static_cast<double>(bands)));
    fmt::format_to(std::back_inserter(out),
                   "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"20\" height=\"{:.1f}\" fill=\"{}\"/>\n", left,
                   bottom - box * static_cast<double>(k + 1), box, colour);
  }
  if (limits.front() == limits.back()) {
    svg::text(out, left + 27.0, bottom - 0.5 * box + 4.0, fmt::format("{:.4g}", limits.front()), svg::kFont,
              "start");
    return;
  }
  for (std::size_t k = 0; k <= bands; ++k) {
    const double y = bottom - box * static_cast<double>(k);
    svg::line(out, left + 20.0, y, left + 24.0, y, "#444444", 1.0);
    svg::text(out, left + 28.0, y + 4.5, labels[k], svg::kFont, "start");
  }
}

}  // namespace

FieldRange field_range(const Model& model, const Solution& solution, std::string_view field,
                       const PictureOptions& options) {
  Scenery scenery = make_scenery(model, solution, field, options);
  return range_of(patches(scenery));
}

std::string field_svg(const Model& model, const Solution& solution, std::string_view field,
                      const PictureOptions& options) {
  Scenery scenery = make_scenery(model, solution, field, options);
  std::vector<Patch> all = patches(scenery);
  FieldRange range = range_of(all);
  if (!(range.low <= range.high)) range = {0.0, 0.0};  // no solid, or known nowhere
  const auto [lowest, highest] = range;
  const std::vector<double> limits = band_limits(std::isnan(options.low) ? lowest : options.low,
                                                 std::isnan(options.high) ? highest : options.high, kBands);
  if (!options.smooth) flatten(all);
  snap(all, limits);

  const View& view = scenery.view;
  const Heading words{
      options.title.empty() ? model.title : options.title,
      (options.state.empty() ? "" : options.state + ": ") + describe(scenery.field, model),
      fmt::format("from {:.4g} to {:.4g}", lowest, highest) +
          (view.deformation > 0.0 ? fmt::format("; deformation x {:g}", view.deformation) : "")};
  const double legend = std::max(view.at(view.high).x() + 36.0, kLeft + 120.0);
  const double width =
      std::max({legend + 28.0 + kLegendText, 16.0 + 0.64 * svg::kTitleFont * length(words.title),
                16.0 + 0.56 * svg::kFont * length(words.what)});
  const double height = kTop + std::max(view.height, 16.0 * static_cast<double>(limits.size())) + kBottom;
  std::string out = svg::open(static_cast<int>(width), static_cast<int>(height));
  svg::text(out, 8.0, 24.0, words.title, svg::kTitleFont, "start", "font-weight=\"bold\"");
  svg::text(out, 8.0, 46.0, words.what, svg::kFont, "start");
  svg::text(out, 8.0, 64.0, words.range, svg::kFont, "start");
  draw_bands(out, all, limits);
  if (options.mesh && all.size() <= kMostElements) draw_mesh(out, all);
  if (view.deformation > 0.0) draw_outline(out, scenery);
  draw_interfaces(out, scenery);
  draw_structures(out, scenery);
  draw_axes(out, scenery);
  draw_legend(out, limits, legend, view.height);
  out += svg::kClose;
  return out;
}

Pictures::Pictures(std::filesystem::path folder, std::string stem, std::vector<std::string> fields,
                   PictureOptions options)
    : folder_(std::move(folder)),
      stem_(std::move(stem)),
      fields_(std::move(fields)),
      options_(std::move(options)) {
  expect_no_folders(folder_, stem_ + "_stage", ".svg");
}

void Pictures::draw(const Model& model, const Solution& solution, const std::string& state,
                    const std::string& caption) {
  PictureOptions options = options_;
  options.state = caption;
  for (const std::string& field : fields_) {
    files_.push_back(folder_ / fmt::format("{}_{}_{}.svg", stem_, state, field));
    write_file(files_.back(), field_svg(model, solution, field, options));
  }
}

void Pictures::exchange(Archive& archive) {
  std::size_t count = files_.size();
  archive(count);
  files_.resize(count);
  for (std::filesystem::path& file : files_) {
    std::string name = file.filename().string();
    archive(name);
    file = folder_ / name;
  }
}

void Pictures::on_stage_end(const Model& model, int stage, const EquilibriumAudit&, const Solution& solution) {
  draw(model, solution, fmt::format("stage{}", stage + 1), fmt::format("end of stage {}", stage + 1));
}

void Pictures::draw_increment(const Model& model, const StepReport& report, const Solution& solution) {
  draw(model, solution, fmt::format("stage{}_increment{}", report.stage + 1, report.increment),
       fmt::format("stage {}, increment {}, load factor {:.4g}", report.stage + 1, report.increment,
                   report.load_factor));
}

void Pictures::on_failure(const Model& model, const StepReport& report, const std::string&,
                          const Solution& solution) {
  draw(model, solution, fmt::format("stage{}_failed", report.stage + 1),
       fmt::format("NOT CONVERGED: stage {}, load factor {:.4g}", report.stage + 1, report.load_factor));
}

}  // namespace sage
