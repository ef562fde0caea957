// The parameters that the suite of laws runs a law with.
#pragma once

#include <string>
#include <vector>

namespace sage::conformance {

// A law of a catalogue with its parameters in kPa, m and degrees.
struct LawSample {
  std::string what;  // letters, digits and _
  int code = 0;
  std::vector<double> values = {};
  double strain = 0.01;           // an increment that takes the law well into its nonlinear range
  bool bounded = false;           // has a strength that stress_level must respect
  bool reaches_strength = true;   // with increments of that size
  bool knows_directions = false;  // as layered soil does: turned axes give another answer
};

}  // namespace sage::conformance
