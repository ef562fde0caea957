// The horizontal acceleration, in multiples of gravity, at which the factor of safety is 1.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sage/safety/safety.hpp"

namespace sage::safety {

// One acceleration that was tried, and its factor of safety.
struct KhTrial {
  double kh = 0.0;
  std::optional<double> lower, upper;  // ends of the bracket of the factor
  bool complete = false;               // Safety::complete: both ends are there, the upper one is proved
  bool stands() const { return lower && *lower >= 1.0; }
  bool falls() const { return complete && upper && *upper <= 1.0; }
};

struct CriticalKh {
  std::vector<KhTrial> trials;         // as they were tried
  std::optional<double> lower, upper;  // the largest that stands, the smallest that falls
  std::string incomplete;              // why that is not the bracket that was asked for; empty = it is
  bool stopped = false;
  bool complete() const { return incomplete.empty() && !stopped; }
};

// find(kh): the factor of safety under an acceleration of that size, from 0 up.  tolerance: width of the bracket.
CriticalKh find_critical_kh(const std::function<Safety(double kh)>& find, double tolerance);

// Adds kh to the right (negative: left) to the loads of a stage (from 0; negative: the
// last), in a stage of its own behind it.  Returns the index of that stage; the deck's later ones follow it.
int add_earthquake(Model& model, int stage, double kh);

std::string to_text(const CriticalKh& found);
std::string to_csv(const CriticalKh& found, int digits);

}  // namespace sage::safety
