// Viridis (van der Walt & Smith, matplotlib 2015; public domain): perceptually ordered, readable in grey.
#pragma once

#include <array>
#include <string>

namespace sage {

struct Colour {
  int red = 0, green = 0, blue = 0;
};

// t in 0 .. 1 (clamped), interpolated in a table of 17 colours.
Colour viridis(double t);

// "#440154"
std::string hex(const Colour& colour);

// Colours for the lines of a plot that colour-blind readers can tell apart (Okabe & Ito 2008); repeats after 7.
const char* line_colour(std::size_t index);

}  // namespace sage
