// Plots of y against x as SVG, without libraries.
#pragma once

#include <string>
#include <vector>

namespace sage {

struct PlotSeries {
  std::string name;          // for the legend; empty = not in it
  std::vector<double> x, y;  // values that are no numbers (or <= 0 on a log axis) break the line
  bool line = true;
  bool markers = false;
  bool dashed = false;
};

struct Plot {
  std::string title, x_label, y_label;  // labels with units
  std::vector<PlotSeries> series;
  bool log_x = false, log_y = false;
  int width = 720, height = 460;
};

// A whole SVG document.
std::string plot_svg(const Plot& plot);

// Round values that divide an axis into about `count` parts, all within [low, high].
std::vector<double> round_ticks(double low, double high, int count);
// The same as text, with as many decimals as the step between ticks needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

}  // namespace sage
