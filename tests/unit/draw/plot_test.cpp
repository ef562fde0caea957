#include "sage/draw/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <regex>

namespace sage {
namespace {

// All points "x y" of the first path of a plot.
std::vector<std::pair<double, double>> first_path(const std::string& svg) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(svg, match, std::regex("<path d=\"([^\"]*)\"")));
  const std::string path = match[1];
  std::vector<std::pair<double, double>> points;
  const std::regex point("[ML]([-0-9.]+) ([-0-9.]+)");
  for (std::sregex_iterator it(path.begin(), path.end(), point), end; it != end; ++it)
    points.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  return points;
}

Plot line_plot(std::vector<double> x, std::vector<double> y) {
  Plot plot;
  plot.title = "title";
  PlotSeries series;
  series.name = "one";
  series.x = std::move(x);
  series.y = std::move(y);
  plot.series.push_back(series);
  return plot;
}

TEST(Plot, LargerIsRightAndUp) {
  const auto points = first_path(plot_svg(line_plot({0, 1, 2}, {0, 10, 20})));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_LT(points[0].first, points[1].first);
  EXPECT_GT(points[0].second, points[1].second);                                            // SVG's y runs down
  EXPECT_NEAR(points[1].first - points[0].first, points[2].first - points[1].first, 0.02);  // two decimals
}

TEST(Plot, LogAxesSpaceDecadesEvenlyAndLeaveOutWhatHasNoLogarithm) {
  Plot plot = line_plot({1, 10, 100, 0}, {1e-8, 1e-5, 1e-2, 1});
  plot.log_x = plot.log_y = true;
  const auto points = first_path(plot_svg(plot));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].first - points[0].first, points[2].first - points[1].first, 0.02);
  EXPECT_NEAR(points[1].second - points[0].second, points[2].second - points[1].second, 0.02);
}

TEST(Plot, BreaksTheLineAtAGap) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = plot_svg(line_plot({0, 1, 2, 3, 4}, {0, 1, gap, 3, 4}));
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, std::regex("<path d=\"([^\"]*)\"")));
  const std::string path = match[1];
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
}

TEST(Plot, DrawsNothingWithoutData) {
  const std::string svg = plot_svg(Plot{});
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(round_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> small = round_ticks(0.0013, 0.0049, 5);
  EXPECT_GE(small.front(), 0.0013);
  EXPECT_LE(small.back(), 0.0049);
  EXPECT_GE(small.size(), 3u);
}

TEST(Ticks, LabelsHaveTheDecimalsOfTheStep) {
  EXPECT_EQ(tick_labels({0.0, 0.05, 0.1}), (std::vector<std::string>{"0.00", "0.05", "0.10"}));
  EXPECT_EQ(tick_labels({0.0, 200.0, 400.0}), (std::vector<std::string>{"0", "200", "400"}));
  EXPECT_EQ(tick_labels({0.0, 2e-6, 4e-6}), (std::vector<std::string>{"0", "2e-06", "4e-06"}));
  EXPECT_EQ(tick_labels({1.0e7, 1.1e7}), (std::vector<std::string>{"1.0e+07", "1.1e+07"}));
}

}  // namespace
}  // namespace sage
