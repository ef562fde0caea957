// Two runs side by side as rows of numbers, for people and for programs.
#pragma once

#include "sage/compare/theory.hpp"
#include "sage/output/sampler.hpp"

namespace sage::compare {

// A named straight line, sampled at n equal distances, both ends included.
struct Line {
  Vector2 from = Vector2::Zero(), to = Vector2::Zero();
  std::string name;
  int n = 11;
};

// "x1,y1,x2,y2[:name[:n]]" and "x,y[:name]" (a line of n = 1).  Throws std::invalid_argument with what is
// wrong.
Line line_from_text(const std::string& text);
Line point_from_text(const std::string& text);

// One quantity of both runs; NaN = this side does not have it.
struct Row {
  std::string section, name, unit;
  double a = 0.0, b = 0.0;
  double expected = std::numeric_limits<double>::quiet_NaN();  // of b / a, where theory has one
  // The largest of the section's numbers in the same unit: what is far below it is rounding, of which no
  // relative difference is made.
  double scale = 0.0;

  double difference() const { return b - a; }
  double relative() const;  // (b - a) / |a|
};

struct Comparison {
  std::vector<Row> rows;     // shown and in the CSV
  std::vector<Row> details;  // in the CSV only: every increment of the reports, every place of the lines
  std::vector<Expectation> theory;
  std::vector<std::string> notes;  // what makes numbers comparable or not
};

// Either side may have failed, or not even have a model.
Comparison compare(const Side& a, const Side& b, const std::vector<Line>& lines);

// A page for the terminal; signs and units at its end.
std::string to_text(const Comparison& comparison, const Side& a, const Side& b);
// All rows: section,quantity,unit,A,B,difference,relative,expected_ratio.
std::string to_csv(const Comparison& comparison, const Side& a, const Side& b);

}  // namespace sage::compare
