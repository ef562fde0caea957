// A small plot in characters, for the summary of a run on a terminal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sage/record/report.hpp"

namespace sage {

// The first curve is drawn as a line, a second one as a cross at each of its points where the line leaves room.
struct Sketch {
  std::string title;
  struct Curve {
    std::vector<double> x, y;  // of one size; what is no number is left out
  };
  std::vector<Curve> curves;
};

// Of the first report that has a path: deviator against strain of a triaxial one, force against displacement of
// nodes along the axis in which they move most (both turned where they end below zero, which the title says).
// Nothing where no report has three rows.
std::optional<Sketch> sketch_of(const Model& model, const Reports& reports);

// So many characters wide, at least 40; the line in Braille dots (`unicode`) or in stars.  Both axes hold zero.
// Empty where there is nothing to draw.
std::string sketch_text(const Sketch& sketch, int columns, bool unicode);

}  // namespace sage
