// The small plot of a run's summary, character by character.
#include "sage/record/sketch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sage {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Sketch straight(double slope) {
  return {"y against x", {{{1.0, 2.0, 3.0}, {slope, 2.0 * slope, 3.0 * slope}}}};
}

TEST(Sketch, AStraightLineGoesFromCornerToCorner) {
  const std::vector<std::string> lines = lines_of(sketch_text(straight(2.0), 40, false));
  ASSERT_EQ(lines.size(), 13u);  // title, ten rows, axis, numbers
  EXPECT_EQ(lines[0], "  y against x");
  EXPECT_EQ(lines[1].substr(0, 15), "            6 |");
  EXPECT_EQ(lines[1].size(), 15u + 24u) << "the highest value stands at the right end";
  EXPECT_EQ(lines[1].back(), '*');
  EXPECT_EQ(lines[10].substr(0, 15), "            0 |");
  EXPECT_EQ(lines[11], std::string(14, ' ') + '+' + std::string(24, '-'));
  EXPECT_EQ(lines[12], std::string(15, ' ') + '0' + std::string(22, ' ') + '3');
  // The line begins at a third: the first row has strain already.
  EXPECT_EQ(lines[10].size(), 15u);
  EXPECT_EQ(lines[7].find('*'), 15u + 8u) << "x = 1, y = 2";
}

TEST(Sketch, FallingBelowZeroItStandsUpsideDown) {
  const std::vector<std::string> up = lines_of(sketch_text(straight(1.0), 60, false));
  const std::vector<std::string> down = lines_of(sketch_text(straight(-1.0), 60, false));
  ASSERT_EQ(down.size(), up.size());
  for (std::size_t r = 0; r < 10; ++r) EXPECT_EQ(up[1 + r].substr(15), down[10 - r].substr(15)) << r;
  EXPECT_EQ(down[10].substr(0, 15), "           -3 |");
}

TEST(Sketch, CrossesOfASecondCurveLeaveTheLineAlone) {
  Sketch sketch = straight(1.0);
  sketch.curves.push_back({{1.0, 2.0, 3.0}, {3.0, 2.0, 1.0}});
  const std::string text = sketch_text(sketch, 40, false);
  EXPECT_EQ(std::count(text.begin(), text.end(), '+'), 1 + 2) << "the axis' corner; the middle is on the line";
  const std::string line = sketch_text(straight(1.0), 40, false);
  EXPECT_EQ(std::count(text.begin(), text.end(), '*'), std::count(line.begin(), line.end(), '*'));
}

TEST(Sketch, BrailleHasTheFinerGrid) {
  const std::vector<std::string> lines = lines_of(sketch_text(straight(1.0), 40, true));
  EXPECT_NE(lines[1].find("\u2502"), std::string::npos);
  // The last dot of the line is the upper right one of its character: 0x08.
  EXPECT_EQ(static_cast<unsigned char>(lines[1].back()) & 0x08u, 0x08u) << lines[1];
  EXPECT_EQ(lines[1].substr(lines[1].size() - 3, 2), "\xe2\xa0");
}

TEST(Sketch, WhatIsNoNumberLeavesAGap) {
  Sketch sketch = straight(1.0);
  sketch.curves[0].y[1] = NAN;
  const std::string text = sketch_text(sketch, 40, false);
  EXPECT_EQ(std::count(text.begin(), text.end(), '*'), 2) << text;
  EXPECT_EQ(sketch_text({"nothing", {{{1.0}, {0.0}}}}, 40, false), "") << "no height";
  EXPECT_EQ(sketch_text({"nothing", {{{NAN}, {1.0}}}}, 40, false), "");
}

}  // namespace
}  // namespace sage
