// Curves as tables and plots.
#pragma once

#include <string>
#include <vector>

#include "sage/drive/curve.hpp"

namespace sage::drive {

// Of an axis: "mean stress [kPa]".
std::string label_of(const Column& column);

// What stands above all curves: test, start, drainage.
struct Heading {
  std::string title;
  std::vector<std::string> notes;  // a line each: the cases
  UnitSystem units;
};

// One table, a row a step, the first column the case; blank where a case has no such column.  digits: significant.
std::string csv_text(const Heading& heading, const std::vector<Curve>& curves, int digits);

// "X:Y".  Throws InputError where no curve has such a column.
void expect_columns(const std::string& panel, const std::vector<Curve>& curves);
// Panels X:Y, a line a curve.
std::string plot_text(const Heading& heading, const std::vector<Curve>& curves,
                      const std::vector<std::string>& panels);

// What people draw of a test (path = nullptr): stress and volume, or pore pressure and stress path, over what is
// driven.
std::vector<std::string> usual_panels(const LabTest* test, int law_size, bool undrained);

// A few lines a case: the end, the largest value of what the first panel shows, and a failure.
std::string summary_text(const std::vector<Curve>& curves, const std::string& panel);

}  // namespace sage::drive
