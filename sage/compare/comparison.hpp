// Two runs side by side as rows of numbers, for people and for programs.
#pragma once

#include <cmath>

#include "sage/compare/theory.hpp"
#include "sage/record/number.hpp"
#include "sage/record/sampler.hpp"

namespace sage::compare {

// A named straight line, sampled at n equal distances, both ends included.
struct Line {
  Vector2 from = Vector2::Zero(), to = Vector2::Zero();
  std::string name;
  int n = 11;
};

// "x1,y1,x2,y2[:name[:n]]".  Throws std::invalid_argument with what is wrong.
Line line_from_text(const std::string& text);

// One quantity of both runs; NaN = this side does not have it.
struct Row {
  std::string section, name, unit;
  double a = 0.0, b = 0.0;
  double expected = std::numeric_limits<double>::quiet_NaN();  // of b / a, where theory has one
  // The largest of the section's numbers in the same unit: what is far below it is rounding, of which no
  // relative difference is made.
  double scale = 0.0;
  // What the runs' own tolerance leaves open in `a` and `b`: a number below it is zero, and so is a difference
  // below both together.
  double floor_a = 0.0, floor_b = 0.0;
  // False for forces of a unit of thickness beside those of a full circle: they have no difference.
  bool comparable = true;

  bool zero_a() const { return std::abs(a) <= floor_a; }
  bool zero_b() const { return std::abs(b) <= floor_b; }
  double difference() const {
    if (!comparable) return std::numeric_limits<double>::quiet_NaN();
    return std::abs(b - a) <= floor_a + floor_b ? 0.0 : b - a;
  }
  double relative() const;  // difference / |a|; NaN where `a` is zero and `b` is not
};

// What a report ends with in both runs, and what theory expects of the ratio.
struct Answer {
  std::string name, unit;  // "report1.fy", "report1.fy / area" where only that can be compared
  double a = 0.0, b = 0.0;
  double error_a = std::numeric_limits<double>::quiet_NaN();  // of the mesh; NaN = not estimated
  double error_b = std::numeric_limits<double>::quiet_NaN();
  double expected = std::numeric_limits<double>::quiet_NaN();  // of b / a
  std::string why;
  bool reached_a = true, reached_b = true;  // as certain as was asked for

  // False where `a` is zero, as far as its error lets see.
  bool comparable = true;  // as Row::comparable
  bool ratio_known() const {
    return comparable && a != 0.0 && !(std::isfinite(error_a) && error_a >= std::abs(a));
  }
  double ratio() const { return b / a; }
  double ratio_error() const;  // NaN where one of the two is not estimated
};

// A value of a report as finer and finer meshes have it.
struct CertainValue {
  std::string name;                 // "report1.fy"
  double value = 0.0, error = 0.0;  // infinite = nothing is known of it
  bool reached = true;              // as certain as was asked for
};

struct Comparison {
  std::vector<Answer> answers;
  std::vector<Row> rows;     // shown and in the CSV
  std::vector<Row> details;  // in the CSV only: every increment of the reports, every place of the lines
  std::vector<Expectation> theory;
  std::vector<std::string> notes;  // what makes numbers comparable or not
};

// Either side may have failed, or not even have a model.
// certain_a, certain_b: values that take the place of what the reports end with, where both end at one step.
// fields: more than the usual ones on lines, by name.
Comparison compare(const Side& a, const Side& b, const std::vector<Line>& lines,
                   const std::vector<CertainValue>& certain_a = {},
                   const std::vector<CertainValue>& certain_b = {},
                   const std::vector<std::string>& fields = {});

// A page for the terminal; signs and units at its end.  Tables have at most 80 columns; sentences are not wrapped.
std::string to_text(const Comparison& comparison, const Side& a, const Side& b);
// All rows: section,quantity,unit,A,B,difference,relative,expected_ratio,error_A,error_B.
std::string to_csv(const Comparison& comparison, const Side& a, const Side& b, int digits = kCsvDigits);

}  // namespace sage::compare
