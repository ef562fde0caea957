#include "sage/draw/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "sage/analysis/stream_function.hpp"
#include "sage/core/unit_suffix.hpp"
#include "sage/draw/colour_map.hpp"
#include "sage/draw/contour.hpp"
#include "sage/draw/diagram.hpp"
#include "sage/draw/flow_net.hpp"
#include "sage/draw/marks.hpp"
#include "sage/draw/plot.hpp"
#include "sage/draw/scenery.hpp"
#include "sage/draw/svg.hpp"
#include "sage/model/solid_edges.hpp"
#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr double kBottom = 54.0, kLine = 18.0;
constexpr const char *kInterfaceColour = "#b2182b", *kStructureColour = "#1f4e9c";

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
    if (paths[band].empty()) continue;
    fmt::format_to(std::back_inserter(out), "<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.4\" d=\"",
                   colour);
    out.append(paths[band]).append("\"/>\n");
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

// Edges of solids that only one element has, undeformed; not those along a line of symmetry.
void draw_outline(std::string& out, Scenery& scenery) {
  const Model& model = scenery.model;
  const auto on_seam = [&](int node) { return scenery.view.on_seam(model.mesh.x.col(node)); };
  out += "<g fill=\"none\" stroke=\"#666666\" stroke-width=\"1\" stroke-dasharray=\"5 4\">\n";
  const SolidEdges edges(model, [&](std::size_t g) { return scenery.draws(g, ElementKind::solid); });
  edges.for_single([&](int node, const SolidEdge& edge) {
    if (on_seam(node) && on_seam(edge.other)) return;
    const Group& group = model.groups[edge.group];
    const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, edge.element, 0.0);
    const SubGrid& grid = grid_for(scenery, group, nodes);
    std::string path;
    append_line(path, nodes * grid.N(grid.edges[edge.local], Eigen::all).transpose());
    fmt::format_to(std::back_inserter(out), "<path d=\"{}\"/>\n", path);
  });
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
                   "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" d=\"{}\"/>\n", kInterfaceColour,
                   path);
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
                   "<path fill=\"none\" stroke=\"{}\" stroke-width=\"2.4\" d=\"{}\"/>\n", kStructureColour,
                   path);
}

void draw_axes(std::string& out, const Scenery& scenery) {
  const View& view = scenery.view;
  const AxisNames names = axis_names(scenery.model.geometry);
  const std::string& unit = scenery.model.units.length;
  const double bottom = kPictureTop + view.height + 10.0, left = kPictureLeft - 10.0;
  const double right = view.at(view.high).x();
  const int across = std::max(2, static_cast<int>((right - kPictureLeft) / 70.0));
  const std::vector<double> xs = round_ticks(view.low.x(), view.high.x(), across);
  const std::vector<double> ys =
      round_ticks(view.low.y(), view.high.y(), std::max(2, static_cast<int>(view.height / 60.0)));
  svg::line(out, kPictureLeft, bottom, right, bottom, "#666666", 1.0);
  svg::line(out, left, kPictureTop, left, kPictureTop + view.height, "#666666", 1.0);
  std::vector<std::string> x_labels = tick_labels(xs);
  const std::vector<std::string> y_labels = tick_labels(ys);
  if (scenery.model.geometry == Geometry::axisymmetric)  // the left half of a mirrored specimen
    for (std::string& label : x_labels)
      if (label.front() == '-') label.erase(0, 1);
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
  svg::text(out, 0.5 * (kPictureLeft + right), bottom + 38.0, std::string(names.x) + unit_suffix(unit),
            svg::kFont, "middle");
  svg::text(out, 8.0, kPictureTop - 12.0, std::string(names.y) + unit_suffix(unit), svg::kFont, "start");
}

// Beyond the ends of the scale lies something: a tip in the last colour.
void draw_tip(std::string& out, double left, double y, double height, const Colour& colour) {
  fmt::format_to(std::back_inserter(out), "<path fill=\"{}\" d=\"M{:.1f} {:.1f}h20l-10 {:.1f}z\"/>\n",
                 hex(colour), left, y, height);
}

double legend_text_width(const std::vector<double>& limits) {
  double width = svg::text_width("interface", svg::kFont);
  for (const std::string& label : tick_labels(limits))
    width = std::max(width, svg::text_width(label, svg::kFont));
  return width + 8.0;
}

// Gives its lower end.
double draw_legend(std::string& out, const std::vector<double>& limits, double left, double height,
                   const FieldRange& range) {
  const std::size_t bands = limits.size() - 1;
  const double box = std::clamp(height / static_cast<double>(bands), 16.0, 30.0);
  const std::vector<std::string> labels = tick_labels(limits);
  const double bottom = kPictureTop + box * static_cast<double>(bands);
  for (std::size_t k = 0; k < bands; ++k) {
    const std::string colour = hex(viridis((static_cast<double>(k) + 0.5) / static_cast<double>(bands)));
    fmt::format_to(std::back_inserter(out),
                   "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"20\" height=\"{:.1f}\" fill=\"{}\"/>\n", left,
                   bottom - box * static_cast<double>(k + 1), box, colour);
  }
  if (one_value(limits.front(), limits.back())) {
    svg::text(out, left + 27.0, bottom - 0.5 * box + 4.0, fmt::format("{:.4g}", limits.front()), svg::kFont,
              "start");
    return bottom;
  }
  const double slack = 1e-4 * (limits[1] - limits[0]);
  if (range.high > limits.back() + slack) draw_tip(out, left, kPictureTop, -14.0, viridis(1.0));
  if (range.low < limits.front() - slack) draw_tip(out, left, bottom, 14.0, viridis(0.0));
  for (std::size_t k = 0; k <= bands; ++k) {
    const double y = bottom - box * static_cast<double>(k);
    svg::line(out, left + 20.0, y, left + 24.0, y, "#444444", 1.0);
    svg::text(out, left + 28.0, y + 4.5, labels[k], svg::kFont, "start");
  }
  return bottom;
}

// What the lines of a picture are, where it has any that are no mesh.
void draw_line_legend(std::string& out, const Scenery& scenery, double left, double top) {
  struct Sample {
    ElementKind kind;
    const char *name, *colour;
    double width;
  };
  static constexpr Sample kSamples[] = {{ElementKind::interface, "interface", kInterfaceColour, 1.8},
                                        {ElementKind::structure, "structure", kStructureColour, 2.4}};
  double y = top;
  for (const Sample& sample : kSamples) {
    bool drawn = false;
    for (std::size_t g = 0; g < scenery.model.groups.size(); ++g)
      drawn = drawn || scenery.draws(g, sample.kind);
    if (!drawn) continue;
    svg::line(out, left, y, left + 20.0, y, sample.colour, sample.width);
    svg::text(out, left + 28.0, y + 4.5, sample.name, svg::kFont, "start");
    y += kLine;
  }
}

// A value with the area on the paper that has it.
struct Weighted {
  double value, area;
};

void append_values(std::vector<Weighted>& values, const std::vector<Patch>& all) {
  std::size_t count = values.size();
  for (const Patch& patch : all) count += patch.places.size();
  values.reserve(count);
  for (const Patch& patch : all) {
    double twice = 0.0;
    const std::vector<int>& outline = patch.grid->outline;
    const auto place = [&](std::size_t i) -> const Vector2& {
      return patch.places[outline[i < outline.size() ? i : 0]].at;
    };
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2 &a = place(i), &b = place(i + 1);
      twice += a.x() * b.y() - a.y() * b.x();
    }
    const double area = 0.5 * std::abs(twice) / static_cast<double>(patch.places.size());
    for (const Corner& c : patch.places)
      if (!std::isnan(c.value)) values.push_back({c.value, area});
  }
}

constexpr std::size_t kFew = 50000;  // values that are sorted

// The least value that `area` of the whole lies at or below; changes the order of values.
double value_at(std::span<Weighted> values, double area) {
  while (values.size() > kFew) {
    const std::size_t half = values.size() / 2;
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(half), {}, &Weighted::value);
    double below = 0.0;
    for (const Weighted& v : values.first(half)) below += v.area;
    values = below >= area ? values.first(half) : values.subspan(half);
    if (below < area) area -= below;
  }
  std::ranges::sort(values, {}, &Weighted::value);
  double below = 0.0;
  for (const Weighted& v : values)
    if ((below += v.area) >= area) return v.value;
  return values.back().value;
}

// The colours' range: an end moves in to what 99 % of the area has, where the rest would take a third of them.
FieldRange colour_range(std::vector<Weighted> values, bool robust) {
  constexpr double kRare = 0.01, kTakesMuch = 0.5, kNothing = 1e-7;
  if (values.empty()) return {0.0, 0.0};  // no solid, or known nowhere
  if (values.size() <= kFew) std::ranges::sort(values, {}, &Weighted::value);
  const auto [least, largest] = std::ranges::minmax_element(values, {}, &Weighted::value);
  FieldRange range{least->value, largest->value};
  if (!robust || one_value(range.low, range.high)) return range;
  double all = 0.0;
  for (const Weighted& v : values) all += v.area;
  const FieldRange usual{value_at(values, kRare * all), value_at(values, (1.0 - kRare) * all)};
  const double far = kTakesMuch * (usual.high - usual.low);
  if (far <= kNothing * (range.high - range.low)) return range;  // nothing to see but what is rare
  if (range.high - usual.high > far) range.high = usual.high;
  if (usual.low - range.low > far) range.low = usual.low;
  return range;
}

// A picture without its colours.
struct Draft {
  PictureOptions options;
  Scenery scenery;
  std::vector<Patch> patches;
  std::vector<Weighted> values = {};
  bool net = false;  // of flow, over its head
  Diagram diagram = {};

  bool has_diagram() const { return diagram.quantity >= 0; }
};

Draft make_draft(const Model& model, const Solution& solution, std::string_view field,
                 const PictureOptions& options) {
  Draft draft{options, make_scenery(model, solution, field, options), {}};
  draft.net = field == kFlowNet;
  draft.diagram = make_diagram(draft.scenery, field, options.envelope);
  draft.patches = patches(draft.scenery);
  append_values(draft.values, draft.patches);
  return draft;
}

std::vector<double> limits_of(const PictureOptions& options, const FieldRange& range) {
  return band_limits(std::isnan(options.low) ? range.low : options.low,
                     std::isnan(options.high) ? range.high : options.high, options.levels);
}

std::string percent(double share) {
  return share < 0.1 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.0f} %", 100.0 * share);
}

// "from 1 to 20; colours end at 8: 0.3 % of the area lies beyond".
std::string range_text(const Draft& draft, const std::vector<double>& limits) {
  if (draft.has_diagram() && !draft.diagram.elements.empty())
    return fmt::format("from {:.4g} to {:.4g}", draft.diagram.least, draft.diagram.largest) +
           (draft.scenery.view.deformation > 0.0
                ? fmt::format("; deformation x {:g}", draft.scenery.view.deformation)
                : "");
  const FieldRange range = range_of(draft.patches);
  if (!(range.low <= range.high)) return "no value anywhere in this state";
  std::string text = fmt::format("from {:.4g} to {:.4g}", range.low, range.high);
  const double slack = 1e-4 * (limits[1] - limits[0]);
  const bool below = range.low < limits.front() - slack;
  const bool above = range.high > limits.back() + slack;
  double all = 0.0, beyond = 0.0;
  for (const Weighted& v : draft.values) {
    all += v.area;
    if (v.value < limits.front() - slack || v.value > limits.back() + slack) beyond += v.area;
  }
  if (below || above)
    text += fmt::format("; colours end at {}: {} of the area lies beyond",
                        below && above ? fmt::format("{:.4g} and {:.4g}", limits.front(), limits.back())
                                       : fmt::format("{:.4g}", below ? limits.front() : limits.back()),
                        percent(beyond / all));
  if (draft.scenery.view.deformation > 0.0)
    text += fmt::format("; deformation x {:g}", draft.scenery.view.deformation);
  return text;
}

// The words above a picture: the title in bold.
struct Heading {
  std::vector<std::string> title, text;
  std::string whole = {};  // title that had to be shortened, for viewers to show
  std::size_t lines() const { return title.size() + text.size(); }
};

Heading heading_of(const Draft& draft, const std::vector<double>& limits, double room) {
  const Model& model = draft.scenery.model;
  const PictureOptions& options = draft.options;
  const std::string& whole = options.title.empty() ? model.title : options.title;
  const std::string title = svg::shortened(whole, svg::kTitleFont, 2.5 * room);  // three lines
  Heading heading{svg::wrapped(title, svg::kTitleFont, room, true), {}, title == whole ? "" : whole};
  const std::string what =
      (options.state.empty() ? "" : options.state + ": ") + describe(draft.scenery.field, model);
  for (const std::string& words : {what, range_text(draft, limits)})
    for (std::string& line : svg::wrapped(words, svg::kFont, room)) heading.text.push_back(std::move(line));
  return heading;
}

double width_of(const Heading& heading) {
  double width = 0.0;
  for (const std::string& line : heading.title)
    width = std::max(width, 16.0 + svg::text_width(line, svg::kTitleFont, true));
  for (const std::string& line : heading.text)
    width = std::max(width, 16.0 + svg::text_width(line, svg::kFont));
  return width;
}

// A part of a document, with its size.
struct Drawing {
  std::string svg;
  double width = 0.0, height = 0.0;
  // Of a picture whose notes are still to be added: their lines, the upper end that they need at least, and what
  // the picture is moved down by.
  std::vector<std::string> notes = {};
  double foot = 0.0, down = 0.0;
};

// foot: the upper end of the notes.
void add_notes(Drawing& drawing, double foot) {
  for (const std::string& line : drawing.notes) {
    foot += kLine;  // below the words of the axis
    svg::text(drawing.svg, 8.0, foot - 4.0, line, svg::kFont, "start");
  }
  drawing.svg += "</g>\n";
  drawing.height = foot + drawing.down;
}

// Beyond the longest arrow, too.
double legend_left(const View& view, const PictureOptions& options) {
  return std::max(view.at(view.high).x() + (options.arrows ? kLongestArrow + 16.0 : 36.0),
                  kPictureLeft + 120.0);
}

// The mesh with all that lies on it; `notes` get what explains it.
std::string draw_mesh_and_field(Draft& draft, const std::vector<double>& limits,
                                std::vector<std::string>& notes) {
  std::string out;
  Scenery& scenery = draft.scenery;
  const PictureOptions& options = draft.options;
  draw_bands(out, draft.patches, limits);
  if (options.mesh && !draft.net && draft.patches.size() <= kMostElements) draw_mesh(out, draft.patches);
  if (scenery.view.deformation > 0.0) draw_outline(out, scenery);
  draw_interfaces(out, scenery);
  draw_structures(out, scenery);
  if (options.yielded) notes.push_back(draw_yielded(out, scenery));
  if (options.crosses) notes.push_back(draw_crosses(out, scenery));
  if (options.arrows) notes.push_back(draw_arrows(out, scenery));
  if (draft.has_diagram()) notes.push_back(draw_diagram(out, scenery, draft.diagram));
  if (draft.net) notes.push_back(draw_flow_net(out, scenery, options.levels));
  if (scenery.field.entry->name == kStreamFunction)
    if (const std::string& reason = stream_function(scenery.model, scenery.solution).reason; !reason.empty())
      notes.push_back("no stream function: " + reason);
  return out;
}

// Whether a component turns its sign in a reflection: one that points across the line, and shear.
bool turns_sign(const FieldChoice& field, const PictureOptions& options) {
  const FieldEntry& entry = *field.entry;
  if (!options.mirror_left && !options.mirror_down) return false;
  if (field.component < 0 || entry.shape == FieldShape::numbers) return entry.of_mean;  // directions
  const std::string& name = entry.components[field.component].name;
  return name == "xy" || (name == "x" && options.mirror_left) || (name == "y" && options.mirror_down);
}

// The drawing once, and its reflections; `name` is the only one of the document.
void append_mirrored(std::string& out, const std::string& drawing, const View& view,
                     const PictureOptions& options, const std::string& name) {
  if (!options.mirror_left && !options.mirror_down) {
    out += drawing;
    return;
  }
  const Vector2 at = view.at({view.left, view.bottom});
  out += "<g id=\"" + name + "\">\n" + drawing + "</g>\n";
  for (const auto& [left, down] : {std::pair{true, false}, {false, true}, {true, true}}) {
    if ((left && !options.mirror_left) || (down && !options.mirror_down)) continue;
    fmt::format_to(
        std::back_inserter(out),
        "<use href=\"#{0}\" xlink:href=\"#{0}\" transform=\"matrix({1} 0 0 {2} {3:.2f} {4:.2f})\"/>\n", name,
        left ? -1 : 1, down ? -1 : 1, left ? 2.0 * at.x() : 0.0, down ? 2.0 * at.y() : 0.0);
  }
}

// All but its notes (add_notes).  `heading_lines`: room for that many, so that panels beside one another stand at one
// height.
Drawing draw_picture(Draft& draft, const std::vector<double>& limits, const Heading& heading,
                     std::size_t heading_lines, const std::string& name) {
  const View& view = draft.scenery.view;
  if (!draft.options.smooth) flatten(draft.patches);
  snap(draft.patches, limits);
  const FieldEntry& entry = *draft.scenery.field.entry;
  std::vector<std::string> notes;
  if (!draft.has_diagram()) notes.push_back(rule_text(entry, draft.options.rule));
  if (view.rounding && draft.options.deformed)
    notes.push_back(fmt::format("displacements are rounding ({:.1g} of the mesh's size): drawn undeformed",
                                view.largest / (view.high - view.low).maxCoeff()));
  const std::string mesh = draw_mesh_and_field(draft, limits, notes);
  if (turns_sign(draft.scenery.field, draft.options))
    notes.push_back(
        "this one turns its sign across the line of symmetry: values are those of the half that was computed");
  Drawing drawing;
  const double legend = legend_left(view, draft.options),
               down = kLine * (static_cast<double>(std::max<std::size_t>(heading_lines, 3)) - 3.0);
  drawing.width = std::max({legend + 28.0 + legend_text_width(limits), width_of(heading), 300.0});
  std::string& out = drawing.svg;
  if (!heading.whole.empty()) out += "<title>" + xml_text(heading.whole) + "</title>\n";
  double y = 24.0;
  for (const std::string& line : heading.title) {
    svg::text(out, 8.0, y, line, svg::kTitleFont, "start", svg::kBold);
    y += kLine + 2.0;
  }
  for (const std::string& line : heading.text) {
    svg::text(out, 8.0, y + 2.0, line, svg::kFont, "start");
    y += kLine;
  }
  fmt::format_to(std::back_inserter(out), "<g transform=\"translate(0 {:.1f})\">\n", down);
  append_mirrored(out, mesh, view, draft.options, name);
  draw_axes(out, draft.scenery);
  const FieldRange range = range_of(draft.patches);
  const bool any = range.low <= range.high;  // else the colours would be those of no value
  const double bar = draft.has_diagram() ? kPictureTop - 20.0
                     : any               ? draw_legend(out, limits, legend, view.height, range)
                                         : kPictureTop;
  draw_line_legend(out, draft.scenery, legend, bar + 26.0);
  drawing.foot = std::max(kPictureTop + view.height + kBottom, bar + 66.0);
  drawing.down = down;
  for (const std::string& note : notes)
    for (std::string& line : svg::wrapped(note, svg::kFont, drawing.width - 16.0))
      if (!line.empty()) drawing.notes.push_back(std::move(line));
  return drawing;
}

bool share_scale(const FieldPanel& a, const FieldPanel& b) {
  return a.field == b.field && a.scale == b.scale;
}

// One range for all panels of a field and scale, or one each.
std::vector<std::vector<double>> limits_of_panels(const FieldSheet& sheet, const std::vector<Draft>& drafts) {
  std::vector<std::vector<double>> limits;
  for (std::size_t k = 0; k < drafts.size(); ++k) {
    std::vector<Weighted> values;
    for (std::size_t j = 0; j < drafts.size(); ++j)
      if (j == k || (sheet.one_scale && share_scale(sheet.panels[j], sheet.panels[k])))
        values.insert(values.end(), drafts[j].values.begin(), drafts[j].values.end());
    limits.push_back(limits_of(sheet.look, colour_range(std::move(values), sheet.look.robust)));
  }
  return limits;
}

void share_diagram_scales(const FieldSheet& sheet, std::vector<Draft>& drafts) {
  if (!sheet.one_scale) return;
  std::vector<double> most(drafts.size(), 0.0);
  for (std::size_t k = 0; k < drafts.size(); ++k)
    for (std::size_t j = 0; j < drafts.size(); ++j)
      if (share_scale(sheet.panels[j], sheet.panels[k])) most[k] = std::max(most[k], drafts[j].diagram.most);
  for (std::size_t k = 0; k < drafts.size(); ++k) drafts[k].diagram.most = most[k];
}

// Rows of at most `columns`, or of what stands side by side in about 1400 px; panels stand below one another.
struct Grid {
  std::vector<Vector2> at;  // the upper left corner of each drawing
  double width = 0.0, height = 0.0;
};

constexpr double kGap = 12.0;

std::size_t drawings_a_row(const std::vector<Drawing>& drawings, int columns) {
  constexpr double kMostWidth = 1400.0;
  double widest = 1.0;
  for (const Drawing& drawing : drawings) widest = std::max(widest, drawing.width + kGap);
  return static_cast<std::size_t>(columns > 0 ? columns : std::max(1.0, kMostWidth / widest));
}

// The notes of drawings beside one another begin at one height.
void add_notes(std::vector<Drawing>& drawings, std::size_t per_row) {
  for (std::size_t first = 0; first < drawings.size(); first += per_row) {
    const std::span<Drawing> row =
        std::span(drawings).subspan(first, std::min(per_row, drawings.size() - first));
    const double foot = std::ranges::max(row, {}, &Drawing::foot).foot;
    for (Drawing& drawing : row) add_notes(drawing, foot);
  }
}

Grid grid_of(const std::vector<Drawing>& drawings, std::size_t per_row) {
  std::vector<double> left(per_row + 1, 0.0);
  for (std::size_t c = 0; c < per_row; ++c) {
    double width = 0.0;
    for (std::size_t k = c; k < drawings.size(); k += per_row)
      width = std::max(width, drawings[k].width + kGap);
    left[c + 1] = left[c] + width;
  }
  Grid grid{{}, left[per_row] - kGap, 0.0};
  for (std::size_t k = 0; k < drawings.size(); k += per_row) {
    double row_height = 0.0;
    for (std::size_t c = 0; c < std::min(per_row, drawings.size() - k); ++c) {
      grid.at.emplace_back(left[c], grid.height);
      row_height = std::max(row_height, drawings[k + c].height);
    }
    grid.height += row_height;
  }
  return grid;
}

// In as many lines as a narrow sheet needs, up to three.  Gives the height that they take.
double draw_sheet_title(std::string& out, const std::string& title, double room) {
  if (title.empty()) return 0.0;
  const std::string shown = svg::shortened(title, svg::kTitleFont, 2.5 * room);
  if (shown != title) out += "<title>" + xml_text(title) + "</title>\n";
  double y = 26.0;
  for (const std::string& line : svg::wrapped(shown, svg::kTitleFont, room, true)) {
    svg::text(out, 8.0, y, line, svg::kTitleFont, "start", svg::kBold);
    y += kLine + 2.0;
  }
  return y - 10.0;
}

}  // namespace

FieldRange field_range(const Model& model, const Solution& solution, std::string_view field,
                       const PictureOptions& options) {
  std::vector<Weighted> values = make_draft(model, solution, field, options).values;
  return values.empty() ? FieldRange{} : colour_range(std::move(values), options.robust);
}

PictureScales scales_of(const Model& model, const Solution& solution, std::string_view field,
                        const PictureOptions& options) {
  const View view = make_scenery(model, solution, field, options).view;
  return {view.deformation, view.scale};
}

std::string field_svg(const Model& model, const Solution& solution, std::string_view field,
                      const PictureOptions& options) {
  Draft draft = make_draft(model, solution, field, options);
  const std::vector<double> limits = limits_of(options, colour_range(draft.values, options.robust));
  const Heading heading = heading_of(draft, limits, options.width);
  Drawing drawing = draw_picture(draft, limits, heading, heading.lines(), "half");
  add_notes(drawing, drawing.foot);
  return svg::open(static_cast<int>(drawing.width), static_cast<int>(drawing.height)) + drawing.svg +
         std::string(svg::kClose);
}

std::string sheet_svg(const FieldSheet& sheet) {
  std::vector<Draft> drafts;
  drafts.reserve(sheet.panels.size());
  for (const FieldPanel& panel : sheet.panels) {
    PictureOptions options = sheet.look;
    options.title = panel.title;
    options.state = panel.state;
    options.envelope = panel.envelope;
    drafts.push_back(make_draft(*panel.model, panel.solution, panel.field, options));
  }
  const std::vector<std::vector<double>> limits = limits_of_panels(sheet, drafts);
  share_diagram_scales(sheet, drafts);
  constexpr double kLeastRoom = 300.0;
  std::vector<Heading> headings;
  std::size_t lines = 0;
  for (std::size_t k = 0; k < drafts.size(); ++k) {
    const double room =
        std::max(legend_left(drafts[k].scenery.view, sheet.look) + legend_text_width(limits[k]), kLeastRoom);
    lines = std::max(lines, headings.emplace_back(heading_of(drafts[k], limits[k], room)).lines());
  }
  std::vector<Drawing> drawings;
  for (std::size_t k = 0; k < drafts.size(); ++k)
    drawings.push_back(draw_picture(drafts[k], limits[k], headings[k], lines, fmt::format("half{}", k + 1)));
  const std::size_t per_row = drawings_a_row(drawings, sheet.columns);
  add_notes(drawings, per_row);
  const Grid grid = grid_of(drawings, per_row);
  constexpr double kMargin = 8.0;  // below the notes of the last row
  std::string title;
  const double top = draw_sheet_title(title, sheet.title, grid.width - 16.0);
  std::string out =
      svg::open(static_cast<int>(grid.width), static_cast<int>(top + grid.height + kMargin)) + title;
  for (std::size_t k = 0; k < drawings.size(); ++k)
    out += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">\n{}</g>\n", grid.at[k].x(),
                       top + grid.at[k].y(), drawings[k].svg);
  return out + std::string(svg::kClose);
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
                    const std::string& caption, bool last) {
  PictureOptions options = options_;
  const std::vector<EnvelopeEnd> ends = envelope_.rows();
  for (const std::string& field : fields_) {
    if (is_envelope(field) && !last) continue;
    options.state = is_envelope(field) ? "all stages" : caption;
    options.envelope = is_envelope(field) ? &ends : nullptr;
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
  envelope_.exchange(archive);
}

void Pictures::on_stage_end(const Model& model, int stage, const EquilibriumAudit&, const Solution& solution) {
  if (std::ranges::any_of(fields_, is_envelope)) envelope_.add(model, stage, solution);
  draw(model, solution, fmt::format("stage{}", stage + 1), fmt::format("end of stage {}", stage + 1),
       static_cast<std::size_t>(stage) + 1 == model.stages.size());
}

void Pictures::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  const bool last = report.increment == report.increments;  // drawn at the end of the stage
  if (!last && is_asked_increment(stage_of(model, report.stage), report))
    draw_increment(model, report, solution);
}

void Pictures::draw_increment(const Model& model, const StepReport& report, const Solution& solution) {
  draw(model, solution, fmt::format("stage{}_increment{}", report.stage + 1, report.increment),
       fmt::format("stage {}, increment {}, load factor {:.4g}", report.stage + 1, report.increment,
                   report.load_factor),
       false);
}

void Pictures::on_failure(const Model& model, const StepReport& report, const std::string&,
                          const Solution& solution) {
  draw(model, solution, fmt::format("stage{}_failed", report.stage + 1),
       fmt::format("NOT CONVERGED: stage {}, load factor {:.4g}", report.stage + 1, report.load_factor), false);
}

}  // namespace sage
