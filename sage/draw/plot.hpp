// Plots of y against x as SVG, without libraries.
#pragma once

#include <string>
#include <vector>

namespace sage {

struct PlotSeries {
  std::string name;          // for the legend; empty = not in it
  std::vector<double> x, y;  // values that are no numbers (or <= 0 on a log axis) break the line
  bool line = true;
  bool markers = false;  // of a line no nearer than can be told apart
  bool dashed = false;   // whatever its style
  int style = -1;        // colour, dashes and marker; -1: that of its name, another for each name
};

// One frame with its axes.
struct Plot {
  std::string title, x_label, y_label;  // labels with units
  std::vector<PlotSeries> series;
  bool log_x = false, log_y = false;
  int width = 720, height = 460;
};

// Several plots side by side, of the size of the first.  Series of one name look the same in all, and stand once
// in the legend.
struct PlotSheet {
  std::string title;
  std::vector<Plot> panels;
  int columns = 2;
  std::string note = {};  // below all of it, small
};

// How a series looks: no two below kLineStyles are alike, in colour or in grey (dashes and markers tell them apart).
struct LineStyle {
  const char* colour;  // "#0072b2"
  const char* dashes;  // of stroke-dasharray; empty = drawn through
  int marker;          // 0 ... 6
};
inline constexpr int kLineStyles = 42;
LineStyle line_style(int index);

// A whole SVG document.
std::string plot_svg(const Plot& plot);
std::string sheet_svg(const PlotSheet& sheet);

// Round values that divide an axis into about `count` parts, all within [low, high].
std::vector<double> round_ticks(double low, double high, int count);
// The same as text, with as many decimals as the step between ticks needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

}  // namespace sage
