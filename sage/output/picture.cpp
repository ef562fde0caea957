#include "sage/output/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "sage/output/colour_map.hpp"
#include "sage/output/contour.hpp"
#include "sage/output/nodal_values.hpp"
#include "sage/output/picture_field.hpp"
#include "sage/output/plot.hpp"
#include "sage/output/svg.hpp"
#include "sage/output/values.hpp"

namespace sage {

namespace {

constexpr int kFont = 13, kTitleFont = 16, kBands = 10, kMostElements = 6000;
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
    largest = std::max(largest, s.u->segment<2>(2 * node).norm());
  }
  const double size = (view.high - view.low).maxCoeff();
  if (options.deformed && largest > 0.0)
    view.deformation = options.scale > 0.0 ? options.scale : std::max(1.0, round_down(0.05 * size / largest));
  for (int node : layout.node) {
    const Vector2 x = model.mesh.x.col(node) + view.deformation * s.u->segment<2>(2 * node);
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
  std::vector<double> values;

  Vector2 moved(int node) const {
    return view.at(model.mesh.x.col(node) + view.deformation * solution.u->segment<2>(2 * node));
  }
};

// Local nodes around an element: each corner, then the nodes inside the edge that follows it.
std::vector<std::size_t> outline_nodes(const Element& element) {
  std::vector<std::size_t> order;
  for (const std::vector<int>& edge : element.edges()) {
    order.push_back(static_cast<std::size_t>(edge[0]));
    for (std::size_t i = 2; i < edge.size(); ++i) order.push_back(static_cast<std::size_t>(edge[i]));
  }
  return order;
}

// Shape functions at the centre of an element: exact for 4, 6, 8, 9, 25, 49 and 81 nodes.
std::vector<double> centre_weights(std::size_t nodes, std::size_t corners) {
  std::vector<double> w(nodes, 0.0);
  const bool serendipity = nodes == 8 || nodes == 6;
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(nodes))));
  if (corners == 4 && side > 2 && side * side == nodes) {
    // Squares of odd sides have a node there: 9, 25, 49, 81; their inner nodes come last, row by row.
    const std::size_t inner = (side - 2) * (side - 2);
    w[nodes - inner + inner / 2] = 1.0;
  } else if (serendipity) {
    for (std::size_t i = 0; i < nodes; ++i)
      w[i] = nodes == 8 ? (i < corners ? -0.25 : 0.5) : (i < corners ? -1.0 / 9.0 : 4.0 / 9.0);
  } else {
    std::fill(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(corners), 1.0 / static_cast<double>(corners));
  }
  return w;
}

std::vector<Patch> patches(const Scenery& scenery) {
  std::vector<Patch> result;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    const Group& group = scenery.model.groups[g];
    const std::vector<int>& entries = scenery.layout.of_group[g];
    if (entries.empty() || group.element->traits().law_size != 4) continue;
    const std::vector<std::size_t> order = outline_nodes(*group.element);
    const std::vector<double> weights = centre_weights(group.node_count(), group.element->edges().size());
    for (std::size_t at = 0; at < entries.size(); at += group.node_count()) {
      const auto corner = [&](std::size_t i) {
        const int entry = entries[at + i];
        return Corner{scenery.moved(scenery.layout.node[static_cast<std::size_t>(entry)]),
                      scenery.values[static_cast<std::size_t>(entry)]};
      };
      Patch patch{{}, {Vector2::Zero(), 0.0}};
      for (std::size_t i : order) patch.outline.push_back(corner(i));
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const Corner c = corner(i);
        patch.centre.at += weights[i] * c.at;
        patch.centre.value += weights[i] * c.value;
      }
      result.push_back(std::move(patch));
    }
  }
  return result;
}

// One colour an element: the mean over its outline.
void flatten(std::vector<Patch>& all) {
  for (Patch& patch : all) {
    double mean = 0.0;
    for (const Corner& c : patch.outline) mean += c.value / static_cast<double>(patch.outline.size());
    for (Corner& c : patch.outline) c.value = mean;
    patch.centre.value = mean;
  }
}

std::pair<double, double> range_of(const std::vector<Patch>& all) {
  if (all.empty()) return {0.0, 0.0};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Patch& patch : all)
    for (const Corner& c : patch.outline) {
      low = std::min(low, c.value);
      high = std::max(high, c.value);
    }
  return {low, high};
}

// The three lines above a picture.
struct Heading {
  std::string title, what, range;
};

double length(const std::string& text) {
  return static_cast<double>(text.size());
}

void draw_bands(std::string& out, const std::vector<Patch>& all, const std::vector<double>& limits) {
  const std::vector<std::string> paths = band_paths(all, limits);
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
  for (const Patch& patch : all) append_path(path, patch.outline);
  fmt::format_to(
      std::back_inserter(out),
      "<path fill=\"none\" stroke=\"#000000\" stroke-opacity=\"0.28\" stroke-width=\"0.6\" d=\"{}\"/>\n", path);
}

// Edges of solids that only one element has, undeformed.
void draw_outline(std::string& out, const Scenery& scenery) {
  std::map<std::pair<int, int>, int> uses;
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    const Group& group = scenery.model.groups[g];
    if (scenery.layout.of_group[g].empty() || group.element->traits().law_size != 4) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int a = group.nodes_of(e)[edge[0]], b = group.nodes_of(e)[edge[1]];
        ++uses[{std::min(a, b), std::max(a, b)}];
      }
  }
  out += "<g stroke=\"#666666\" stroke-width=\"1\" stroke-dasharray=\"5 4\">\n";
  for (const auto& [ends, count] : uses) {
    if (count != 1) continue;
    const Vector2 a = scenery.view.at(scenery.model.mesh.x.col(ends.first));
    const Vector2 b = scenery.view.at(scenery.model.mesh.x.col(ends.second));
    fmt::format_to(std::back_inserter(out), "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>\n", a.x(), a.y(), b.x(),
                   b.y());
  }
  out += "</g>\n";
}

void draw_interfaces(std::string& out, const Scenery& scenery) {
  for (std::size_t g = 0; g < scenery.model.groups.size(); ++g) {
    const Group& group = scenery.model.groups[g];
    if (scenery.layout.of_group[g].empty() || group.element->traits().law_size != 2) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& side : group.element->edges()) {
        const Vector2 a = scenery.moved(group.nodes_of(e)[side[0]]),
                      b = scenery.moved(group.nodes_of(e)[side[1]]);
        svg::line(out, a.x(), a.y(), b.x(), b.y(), "#b2182b", 1.8);
      }
  }
}

void draw_axes(std::string& out, const Scenery& scenery) {
  const View& view = scenery.view;
  const AxisNames& names = axis_names(scenery.model.geometry);
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
    svg::text(out, x, bottom + 19.0, x_labels[i], kFont - 1, "middle");
  }
  for (std::size_t i = 0; i < ys.size(); ++i) {
    const double y = view.at({0.0, ys[i]}).y();
    svg::line(out, left - 5.0, y, left, y, "#666666", 1.0);
    svg::text(out, left - 8.0, y + 4.0, y_labels[i], kFont - 1, "end");
  }
  svg::text(out, right + 14.0, bottom + 19.0, fmt::format("{} [{}]", names.x, unit), kFont, "start");
  svg::text(out, 8.0, kTop - 12.0, fmt::format("{} [{}]", names.y, unit), kFont, "start");
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
    svg::text(out, left + 27.0, bottom - 0.5 * box + 4.0, fmt::format("{:.4g}", limits.front()), kFont,
              "start");
    return;
  }
  for (std::size_t k = 0; k <= bands; ++k) {
    const double y = bottom - box * static_cast<double>(k);
    svg::line(out, left + 20.0, y, left + 24.0, y, "#444444", 1.0);
    svg::text(out, left + 28.0, y + 4.5, labels[k], kFont, "start");
  }
}

}  // namespace

std::string field_svg(const Model& model, const Solution& solution, Field field,
                      const PictureOptions& options) {
  Scenery scenery{model, solution, nodal_layout(model, *solution.activity), {}, {}};
  scenery.view = make_view(model, solution, scenery.layout, options);
  scenery.values = field_values(model, solution, scenery.layout, field);
  std::vector<Patch> all = patches(scenery);
  const auto [lowest, highest] = range_of(all);
  const std::vector<double> limits = band_limits(std::isnan(options.low) ? lowest : options.low,
                                                 std::isnan(options.high) ? highest : options.high, kBands);
  if (!options.smooth) flatten(all);

  const View& view = scenery.view;
  const Heading words{
      options.title.empty() ? model.title : options.title,
      (options.state.empty() ? "" : options.state + ": ") + describe_field(model, field),
      fmt::format("from {:.4g} to {:.4g}", lowest, highest) +
          (view.deformation > 0.0 ? fmt::format("; deformation x {:g}", view.deformation) : "")};
  const double legend = std::max(view.at(view.high).x() + 36.0, kLeft + 120.0);
  const double width = std::max({legend + 28.0 + kLegendText, 16.0 + 0.64 * kTitleFont * length(words.title),
                                 16.0 + 0.56 * kFont * length(words.what)});
  const double height = kTop + std::max(view.height, 16.0 * static_cast<double>(limits.size())) + kBottom;
  std::string out = svg::open(static_cast<int>(width), static_cast<int>(height));
  svg::text(out, 8.0, 24.0, words.title, kTitleFont, "start", "font-weight=\"bold\"");
  svg::text(out, 8.0, 46.0, words.what, kFont, "start");
  svg::text(out, 8.0, 64.0, words.range, kFont, "start");
  draw_bands(out, all, limits);
  if (options.mesh && all.size() <= kMostElements) draw_mesh(out, all);
  if (view.deformation > 0.0) draw_outline(out, scenery);
  draw_interfaces(out, scenery);
  draw_axes(out, scenery);
  draw_legend(out, limits, legend, view.height);
  out += svg::kClose;
  return out;
}

Pictures::Pictures(std::filesystem::path folder, std::string stem, std::vector<Field> fields,
                   PictureOptions options)
    : folder_(std::move(folder)),
      stem_(std::move(stem)),
      fields_(std::move(fields)),
      options_(std::move(options)) {}

void Pictures::draw(const Model& model, const Solution& solution, const std::string& state,
                    const std::string& caption) {
  PictureOptions options = options_;
  options.state = caption;
  for (Field field : fields_) {
    files_.push_back(folder_ / fmt::format("{}_{}_{}.svg", stem_, state, field_name(field)));
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

void Pictures::on_failure(const Model& model, const StepReport& report, const std::string&,
                          const Solution& solution) {
  draw(model, solution, fmt::format("stage{}_failed", report.stage + 1),
       fmt::format("NOT CONVERGED: stage {}, load factor {:.4g}", report.stage + 1, report.load_factor));
}

}  // namespace sage
