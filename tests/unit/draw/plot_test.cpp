#include "sage/draw/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <regex>
#include <set>

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

TEST(Plot, NoTwoStylesAreAlikeInGrey) {
  std::set<std::string> all, without_dashes;
  for (int i = 0; i < kLineStyles; ++i) {
    const LineStyle style = line_style(i);
    all.insert(style.dashes + std::string("/") + std::to_string(style.marker));
    without_dashes.insert(style.colour + std::string("/") + std::to_string(style.marker));
  }
  EXPECT_EQ(without_dashes.size(), static_cast<std::size_t>(kLineStyles)) << "where markers hide the dashes";
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kLineStyles));
}

// The stroke of the line with this many points, "colour dashes".
std::vector<std::string> strokes(const std::string& svg) {
  std::vector<std::string> all;
  const std::regex path("<path d=\"[^\"]*\" fill=\"none\" stroke=\"([^\"]*)\" stroke-width=\"2\" ([^/]*)/>");
  for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it)
    all.push_back((*it)[1].str() + (*it)[2].str());
  return all;
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
  return found;
}

// Panels name a series in different places: it looks the same, and the legend has it once.
TEST(PlotSheet, ANameIsOneStyleAndOneRowOfTheLegend) {
  Plot first = line_plot({0, 1}, {0, 1}), second = line_plot({0, 1}, {2, 3});
  first.series.push_back({"two", {0, 1}, {1, 2}});
  second.series.insert(second.series.begin(), {"two", {0, 1}, {5, 4}});
  const std::string svg = sheet_svg({"all", {first, second}, 2});
  const std::vector<std::string> looks = strokes(svg);
  ASSERT_EQ(looks.size(), 4u);
  EXPECT_EQ(looks[0], looks[3]);
  EXPECT_EQ(looks[1], looks[2]);
  EXPECT_NE(looks[0], looks[1]);
  EXPECT_EQ(count(svg, ">one</text>"), 1);
  EXPECT_EQ(count(svg, ">two</text>"), 1);
}

// A series without a name is no other than itself either.
TEST(PlotSheet, SeriesWithoutANameHaveAStyleOfTheirOwn) {
  Plot plot = line_plot({0, 1}, {0, 1});
  plot.series.insert(plot.series.begin(), {"", {0, 1}, {2, 3}});
  plot.series.push_back({"", {0, 1}, {4, 5}});
  const std::vector<std::string> looks = strokes(plot_svg(plot));
  ASSERT_EQ(looks.size(), 3u);
  EXPECT_EQ(std::set<std::string>(looks.begin(), looks.end()).size(), 3u);
}

// Labels of a narrow plot are fewer, so that they stand apart; a long name goes below the frame, not over it.
TEST(Plot, WordsKeepApart) {
  Plot plot = line_plot({1000000.0, 9000000.0}, {0, 1});
  plot.width = 260;
  plot.series[0].name = std::string(80, 'n');
  const std::string svg = plot_svg(plot);
  double last = -1000.0;
  const std::regex label(
      "<text x=\"([0-9.]+)\" y=\"[0-9.]+\" font-size=\"13\" text-anchor=\"middle\" >([0-9.e+]+)<");
  for (std::sregex_iterator it(svg.begin(), svg.end(), label), end; it != end; ++it) {
    const double half = 0.5 * 0.56 * 13.0 * static_cast<double>((*it)[2].length()), x = std::stod((*it)[1]);
    EXPECT_GT(x - half, last);
    last = x + half;
  }
  EXPECT_GT(last, 0.0);
  std::smatch frame, name;
  ASSERT_TRUE(std::regex_search(
      svg, frame, std::regex("y=\"([0-9.]+)\" width=\"[0-9.]+\" height=\"([0-9.]+)\" fill=\"none\"")));
  ASSERT_TRUE(std::regex_search(
      svg, name,
      std::regex("y=\"([0-9.]+)\" font-size=\"13\" text-anchor=\"start\" >(<title>n+</title>)?nnn")));
  EXPECT_GT(std::stod(name[1]), std::stod(frame[1]) + std::stod(frame[2]));
}

// Names of legends and titles are shortened to the paper; what a viewer shows is the whole.
TEST(Plot, LongNamesStayOnThePaper) {
  Plot plot = line_plot({0, 1}, {0, 1});
  const std::string name = std::string(200, 'n') + "end", title = std::string(300, 't');
  plot.series[0].name = name;
  plot.title = title;
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(count(svg, "<title>" + name + "</title>"), 1);
  EXPECT_EQ(count(svg, "<title>" + title + "</title>"), 1);
  EXPECT_EQ(count(svg, "nend</text>"), 1) << "the end tells names apart";
  std::smatch width;
  ASSERT_TRUE(std::regex_search(svg, width, std::regex("width=\"([0-9]+)\"")));
  EXPECT_EQ(std::stoi(width[1]), plot.width);
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
