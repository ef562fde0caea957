#include "sage/draw/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

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

Ticks ticks_of(const Axis& axis) {
  Ticks ticks;
  if (!axis.log) {
    ticks.values = round_ticks(axis.low, axis.high, 6);
    ticks.labels = tick_labels(ticks.values);
    return ticks;
  }
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

// About 0.56 of the font size a character: enough to keep labels apart.
double text_width(std::string_view words, int size) {
  return 0.56 * size * static_cast<double>(words.size());
}

void draw_axes(std::string& out, const Plot& plot, const Axis& x, const Axis& y, const Ticks& xs,
               const Ticks& ys) {
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double at = x.at(xs.values[i]);
    svg::line(out, at, y.from, at, y.to, "#e3e3e3", 1.0);
    svg::line(out, at, y.from, at, y.from + 5.0, "#444444", 1.0);
    svg::text(out, at, y.from + 20.0, xs.labels[i], svg::kFont, "middle");
  }
  double widest = 0.0;
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double at = y.at(ys.values[i]);
    svg::line(out, x.from, at, x.to, at, "#e3e3e3", 1.0);
    svg::line(out, x.from - 5.0, at, x.from, at, "#444444", 1.0);
    svg::text(out, x.from - 9.0, at + 4.5, ys.labels[i], svg::kFont, "end");
    widest = std::max(widest, text_width(ys.labels[i], svg::kFont));
  }
  fmt::format_to(
      std::back_inserter(out),
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#444444\"/>\n",
      x.from, y.to, x.to - x.from, y.from - y.to);
  svg::text(out, 0.5 * (x.from + x.to), y.from + 42.0, plot.x_label, svg::kFont, "middle");
  const double left = x.from - widest - 24.0, middle = 0.5 * (y.from + y.to);
  svg::text(out, left, middle, plot.y_label, svg::kFont, "middle",
            fmt::format("transform=\"rotate(-90 {:.1f} {:.1f})\"", left, middle));
  svg::text(out, 0.5 * (x.from + x.to), 28.0, plot.title, svg::kTitleFont, "middle", "font-weight=\"bold\"");
}

void draw_series(std::string& out, const PlotSeries& series, const Axis& x, const Axis& y, const char* colour) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  std::string path, marks;
  bool pen_down = false;
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
    if (series.markers)
      fmt::format_to(std::back_inserter(marks), "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n",
                     px, py, colour);
  }
  if (series.line && !path.empty())
    fmt::format_to(std::back_inserter(out),
                   "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", path, colour,
                   series.dashed ? " stroke-dasharray=\"7 5\"" : "");
  out += marks;
}

// Right of the frame, so that it never covers a line.
void draw_legend(std::string& out, const Plot& plot, double left, double top) {
  double y = top + 10.0;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (series.name.empty()) continue;
    if (series.line)
      svg::line(out, left, y, left + 26.0, y, line_colour(i), 2.0,
                series.dashed ? "stroke-dasharray=\"7 5\"" : "");
    if (series.markers)
      fmt::format_to(std::back_inserter(out), "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n",
                     left + 13.0, y, line_colour(i));
    svg::text(out, left + 33.0, y + 4.5, series.name, svg::kFont, "start");
    y += 21.0;
  }
}

double legend_width(const Plot& plot) {
  double width = 0.0;
  for (const PlotSeries& series : plot.series)
    if (!series.name.empty()) width = std::max(width, 62.0 + text_width(series.name, svg::kFont));
  return width;
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

std::string plot_svg(const Plot& plot) {
  Axis x, y;
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
  const Ticks xs = ticks_of(x), ys = ticks_of(y);
  double widest = 0.0;
  for (const std::string& label : ys.labels) widest = std::max(widest, text_width(label, svg::kFont));
  x.from = 46.0 + widest;
  x.to = plot.width - std::max(20.0, 16.0 + legend_width(plot));
  y.from = plot.height - 58.0;
  y.to = plot.title.empty() ? 16.0 : 44.0;
  std::string out = svg::open(plot.width, plot.height);
  draw_axes(out, plot, x, y, xs, ys);
  for (std::size_t i = 0; i < plot.series.size(); ++i) draw_series(out, plot.series[i], x, y, line_colour(i));
  draw_legend(out, plot, x.to + 16.0, y.to);
  out += svg::kClose;
  return out;
}

}  // namespace sage
