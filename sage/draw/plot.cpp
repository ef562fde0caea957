#include "sage/draw/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "sage/draw/colour_map.hpp"
#include "sage/draw/svg.hpp"

namespace sage {

namespace {

// One axis: values to screen positions.
struct Axis {
  bool log = false;
  double low = std::numeric_limits<double>::infinity(), high = -low;  // log10 of the values on a log axis
  double from = 0.0, to = 1.0;                                        // screen

  bool shows(double value) const { return std::isfinite(value) && (!log || value > 0.0); }
  double map(double value) const { return log ? std::log10(value) : value; }
  void include(double value) {
    if (!shows(value)) return;
    low = std::min(low, map(value));
    high = std::max(high, map(value));
  }
  double at(double value) const { return from + (map(value) - low) / (high - low) * (to - from); }

  // Room around the values; a linear axis that nearly reaches zero begins there.
  void finish() {
    if (!(low <= high)) low = 0.0, high = 1.0;
    if (low == high) low -= std::max(0.5 * std::abs(low), 0.5), high += std::max(0.5 * std::abs(high), 0.5);
    const double room = 0.04 * (high - low);
    if (!log && low >= 0.0 && low < 0.35 * high)
      low = 0.0;
    else
      low -= room;
    high += room;
  }
};

struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
};

// About `count` of them, less where their labels would touch along an axis that runs across the paper.
Ticks linear_ticks(const Axis& axis, bool across) {
  Ticks ticks;
  for (int count = 6; count > 0; --count) {
    ticks.values = round_ticks(axis.low, axis.high, count);
    ticks.labels = tick_labels(ticks.values);
    if (!across || ticks.values.size() < 2) break;
    double widest = 0.0;
    for (const std::string& label : ticks.labels) widest = std::max(widest, svg::text_width(label, svg::kFont));
    if (widest + 10.0 < axis.at(ticks.values[1]) - axis.at(ticks.values[0])) break;
  }
  return ticks;
}

Ticks log_ticks(const Axis& axis) {
  Ticks ticks;
  const bool narrow = axis.high - axis.low < 1.5;  // decades alone would be too few
  const bool plain = axis.low > -3.5 && axis.high < 4.5;
  const int step = std::max(1, static_cast<int>((axis.high - axis.low) / 8.0));
  for (int decade = static_cast<int>(std::floor(axis.low)); decade <= std::ceil(axis.high); decade += step)
    for (int part : {1, 2, 5}) {
      if (part > 1 && !narrow) break;
      const double value = part * std::pow(10.0, decade);
      if (axis.map(value) < axis.low || axis.map(value) > axis.high) continue;
      ticks.values.push_back(value);
      ticks.labels.push_back(plain ? fmt::format("{:g}", value) : fmt::format("{}e{}", part, decade));
    }
  return ticks;
}

Ticks ticks_of(const Axis& axis, bool across) {
  return axis.log ? log_ticks(axis) : linear_ticks(axis, across);
}

// In the size that they fit in, if that can still be read; else shortened.
void fitted_text(std::string& out, double x, double y, const std::string& words, int size, double room,
                 std::string_view more = "") {
  constexpr int kLeast = 11;
  while (size > kLeast && svg::text_width(words, size) > room) --size;
  svg::text_within(out, x, y, words, size, room, "middle", more);
}

// A plot with its place on the paper.
struct Panel {
  const Plot& plot;
  Axis x, y;
  Ticks xs, ys;
  double label_left = 0.0;  // baseline of the words at the y axis
};

Panel make_panel(const Plot& plot, double left, double top, double width, double height) {
  Panel panel{plot, {}, {}, {}, {}};
  Axis &x = panel.x, &y = panel.y;
  x.log = plot.log_x;
  y.log = plot.log_y;
  for (const PlotSeries& series : plot.series)
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
      if (x.shows(series.x[i]) && y.shows(series.y[i])) {
        x.include(series.x[i]);
        y.include(series.y[i]);
      }
  x.finish();
  y.finish();
  panel.ys = ticks_of(y, false);
  double widest = 0.0;
  for (const std::string& label : panel.ys.labels)
    widest = std::max(widest, svg::text_width(label, svg::kFont));
  panel.label_left = left + 22.0;
  x.from = left + 46.0 + widest;
  x.to = left + width - 20.0;
  y.from = top + height - 58.0;
  y.to = top + (plot.title.empty() ? 16.0 : 44.0);
  panel.xs = ticks_of(x, true);
  return panel;
}

void draw_axes(std::string& out, const Panel& panel) {
  const auto& [plot, x, y, xs, ys, label_left] = panel;
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double at = x.at(xs.values[i]);
    svg::line(out, at, y.from, at, y.to, "#e3e3e3", 1.0);
    svg::line(out, at, y.from, at, y.from + 5.0, "#444444", 1.0);
    svg::text(out, at, y.from + 20.0, xs.labels[i], svg::kFont, "middle");
  }
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double at = y.at(ys.values[i]);
    svg::line(out, x.from, at, x.to, at, "#e3e3e3", 1.0);
    svg::line(out, x.from - 5.0, at, x.from, at, "#444444", 1.0);
    svg::text(out, x.from - 9.0, at + 4.5, ys.labels[i], svg::kFont, "end");
  }
  fmt::format_to(
      std::back_inserter(out),
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#444444\"/>\n",
      x.from, y.to, x.to - x.from, y.from - y.to);
  const double across = x.to - x.from, centre = 0.5 * (x.from + x.to), middle = 0.5 * (y.from + y.to);
  fitted_text(out, centre, y.from + 42.0, plot.x_label, svg::kFont, across);
  fitted_text(out, label_left, middle, plot.y_label, svg::kFont, y.from - y.to + 60.0,
              fmt::format("transform=\"rotate(-90 {:.1f} {:.1f})\"", label_left, middle));
  fitted_text(out, centre, y.to - 16.0, plot.title, svg::kTitleFont, across / 1.12, svg::kBold);
}

// About its middle, 4 px each way; every other one is hollow, so that they differ in grey.
void draw_marker(std::string& out, double x, double y, const LineStyle& style) {
  static constexpr std::array<const char*, 7> kShapes{
      "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0z",
      "M-3.3 -3.3H3.3V3.3H-3.3z",
      "M0 -4.4L4.2 3.2H-4.2z",
      "M0 -4.8L4.8 0L0 4.8L-4.8 0z",
      "M-3.8 -3.8L3.8 3.8M-3.8 3.8L3.8 -3.8",
      "M0 4.4L4.2 -3.2H-4.2z",
      "M0 -4.6V4.6M-4.6 0H4.6",
  };
  const bool hollow = style.marker % 2 == 1;
  fmt::format_to(std::back_inserter(out),
                 "<path transform=\"translate({:.1f} {:.1f})\" d=\"{}\" fill=\"{}\" stroke=\"{}\" "
                 "stroke-width=\"1.5\"/>\n",
                 x, y, kShapes[style.marker], hollow ? "#ffffff" : style.colour, style.colour);
}

std::string dashes_of(const PlotSeries& series, const LineStyle& style) {
  const std::string dashes = series.dashed ? "7 5" : style.dashes;
  return dashes.empty() ? "" : "stroke-dasharray=\"" + dashes + "\"";
}

void draw_series(std::string& out, const PlotSeries& series, const Axis& x, const Axis& y,
                 const LineStyle& style) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  std::string path, marks;
  bool pen_down = false;
  constexpr double kApart = 26.0;  // px: of the markers along a line
  double mark_x = -kApart, mark_y = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!x.shows(series.x[i]) || !y.shows(series.y[i])) {
      pen_down = false;
      continue;
    }
    const double px = x.at(series.x[i]), py = y.at(series.y[i]);
    path += pen_down ? 'L' : 'M';
    svg::number(path, px);
    path += ' ';
    svg::number(path, py);
    pen_down = true;
    if (!series.markers || (series.line && std::hypot(px - mark_x, py - mark_y) < kApart)) continue;
    draw_marker(marks, px, py, style);
    mark_x = px;
    mark_y = py;
  }
  if (series.line && !path.empty())
    fmt::format_to(std::back_inserter(out),
                   "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" {}/>\n", path, style.colour,
                   dashes_of(series, style));
  out += marks;
}

// The styles of all series of a sheet: one a name, in the order in which names come, behind those of series without
// a name, which are told apart within a panel only.
class Styles {
 public:
  explicit Styles(const std::vector<Plot>& panels) {
    const auto nameless = [](const PlotSeries& series) { return series.style < 0 && series.name.empty(); };
    for (const Plot& panel : panels)
      first_ = std::max(first_, static_cast<int>(std::ranges::count_if(panel.series, nameless)));
    for (const Plot& panel : panels)
      for (std::size_t i = 0; i < panel.series.size(); ++i) {
        const PlotSeries& series = panel.series[i];
        if (series.style >= 0 || series.name.empty() || of_name_.contains(series.name)) continue;
        const int next = first_ + static_cast<int>(of_name_.size());
        of_name_[series.name] = next;
      }
  }
  LineStyle of(const Plot& panel, std::size_t i) const {
    const PlotSeries& series = panel.series[i];
    if (series.style >= 0) return line_style(series.style);
    if (!series.name.empty()) return line_style(of_name_.at(series.name));
    int before = 0;
    for (std::size_t k = 0; k < i; ++k)
      before += panel.series[k].style < 0 && panel.series[k].name.empty() ? 1 : 0;
    return line_style(before);
  }

 private:
  int first_ = 0;
  std::map<std::string, int> of_name_;
};

struct LegendRow {
  const PlotSeries* series;
  LineStyle style;
};

std::vector<LegendRow> legend_of(const std::vector<Plot>& panels, const Styles& styles) {
  std::vector<LegendRow> rows;
  for (const Plot& panel : panels)
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      const PlotSeries& series = panel.series[i];
      const auto same = [&](const LegendRow& row) { return row.series->name == series.name; };
      if (!series.name.empty() && std::ranges::none_of(rows, same))
        rows.push_back({&series, styles.of(panel, i)});
    }
  return rows;
}

constexpr double kLegendRow = 21.0, kLegendSample = 40.0;

// Beside or below the frames, so that it never covers a line.
void draw_legend(std::string& out, const std::vector<LegendRow>& rows, double left, double top, double room) {
  double y = top + 10.0;
  for (const auto& [series, style] : rows) {
    if (series->line)
      svg::line(out, left, y, left + kLegendSample, y, style.colour, 2.0, dashes_of(*series, style));
    if (series->markers) draw_marker(out, left + 0.5 * kLegendSample, y, style);
    svg::text_within(out, left + kLegendSample + 7.0, y + 4.5, series->name, svg::kFont,
                     room - kLegendSample - 7.0, "start");
    y += kLegendRow;
  }
}

double legend_width(const std::vector<LegendRow>& rows) {
  double width = 0.0;
  for (const LegendRow& row : rows)
    width = std::max(width, kLegendSample + 24.0 + svg::text_width(row.series->name, svg::kFont));
  return width;
}

// Where the frames and the legend stand.
struct Layout {
  double panel_width, panel_height, top;
  double legend_left, legend_top;
  double width, height;
};

// A single plot keeps its width, also with the legend beside it; long names go below.
Layout layout_of(const PlotSheet& sheet, int columns, int rows, const std::vector<LegendRow>& legend) {
  const Plot usual;
  const Plot& first = sheet.panels.empty() ? usual : sheet.panels.front();
  const double names = legend_width(legend);
  const bool single = columns == 1 && rows == 1, below = names > 0.4 * first.width;
  Layout layout{};
  layout.panel_width = first.width - (single && !below ? std::max(0.0, names - 4.0) : 0.0);
  layout.panel_height = first.height;
  layout.top = sheet.title.empty() ? 0.0 : 36.0;
  const double right = columns * layout.panel_width, bottom = layout.top + rows * layout.panel_height;
  layout.legend_left = below ? 24.0 : right - 4.0;
  layout.legend_top = below ? bottom : layout.top + (first.title.empty() ? 16.0 : 44.0);
  const double legend_bottom = layout.legend_top + kLegendRow * static_cast<double>(legend.size()) + 8.0;
  layout.width = right + (below ? 0.0 : std::max(0.0, names - 4.0));
  layout.height = legend.empty() ? bottom : std::max(bottom, legend_bottom);
  return layout;
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  const double rough = (high - low) / count;
  if (!(rough > 0.0) || !std::isfinite(rough)) return {low};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= 0.75 * rough) {
      step = factor * power;
      break;
    }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
    ticks.push_back(k * step + 0.0);
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  double largest = 0.0;
  for (double t : ticks) largest = std::max(largest, std::abs(t));
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : largest;
  std::vector<std::string> labels;
  const bool plain = largest < 1e6 && (step >= 1e-4 || largest == 0.0);
  const int decimals = step > 0.0 ? std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))) : 0;
  // Digits that a mantissa needs so that neighbours differ.
  const int digits =
      step > 0.0 && largest > 0.0
          ? std::max(0, static_cast<int>(std::floor(std::log10(largest)) - std::floor(std::log10(step) + 1e-9)))
          : 2;
  for (double t : ticks) {
    if (plain)
      labels.push_back(fmt::format("{:.{}f}", t, decimals));
    else
      labels.push_back(t == 0.0 ? "0" : fmt::format("{:.{}e}", t, digits));
  }
  return labels;
}

LineStyle line_style(int index) {
  static constexpr std::array<const char*, 6> kDashes{"",           "9 4",  "2.5 3",
                                                      "10 3 2.5 3", "16 4", "10 3 2.5 3 2.5 3"};
  // Each round of seven colours moves the markers on, and the dashes further: each pair of the three comes once.
  const auto i = static_cast<std::size_t>(index % kLineStyles), round = i / 7, marker = (i + round) % 7;
  return {line_colour(i), kDashes[(marker + round) % kDashes.size()], static_cast<int>(marker)};
}

std::string sheet_svg(const PlotSheet& sheet) {
  const int count = static_cast<int>(sheet.panels.size());
  const int columns = std::clamp(sheet.columns, 1, std::max(1, count)), rows = (count + columns - 1) / columns;
  const Styles styles(sheet.panels);
  const std::vector<LegendRow> legend = legend_of(sheet.panels, styles);
  const Layout layout = layout_of(sheet, columns, rows, legend);
  constexpr int kNoteFont = svg::kFont - 1;
  const std::vector<std::string> note = svg::wrapped(sheet.note, kNoteFont, layout.width - 16.0);
  const double note_height = sheet.note.empty() ? 0.0 : 6.0 + 16.0 * static_cast<double>(note.size());
  std::string out = svg::open(static_cast<int>(layout.width), static_cast<int>(layout.height + note_height));
  if (!sheet.title.empty())
    fitted_text(out, 0.5 * layout.width, 26.0, sheet.title, svg::kTitleFont, (layout.width - 16.0) / 1.12,
                svg::kBold);
  for (int k = 0; k < count; ++k) {
    const Plot& plot = sheet.panels[static_cast<std::size_t>(k)];
    const int row = k / columns, column = k % columns;
    const Panel panel = make_panel(plot, column * layout.panel_width, layout.top + row * layout.panel_height,
                                   layout.panel_width, layout.panel_height);
    draw_axes(out, panel);
    for (std::size_t i = 0; i < plot.series.size(); ++i)
      draw_series(out, plot.series[i], panel.x, panel.y, styles.of(plot, i));
  }
  draw_legend(out, legend, layout.legend_left, layout.legend_top, layout.width - layout.legend_left - 8.0);
  for (std::size_t i = 0; i < note.size() && !sheet.note.empty(); ++i)
    svg::text(out, 8.0, layout.height + 12.0 + 16.0 * static_cast<double>(i), note[i], kNoteFont, "start");
  out += svg::kClose;
  return out;
}

std::string plot_svg(const Plot& plot) {
  return sheet_svg({"", {plot}, 1});
}

}  // namespace sage
