// A UMAT driven alone, without a deck: what it answers, and what is wrong with it (sagefe conform --umat).
#pragma once

#include <iosfwd>

#include "sage/umat/call.hpp"

namespace sage::umat {

struct Trial {
  Setup setup;
  Vector4 stress = Vector4::Zero();  // at the start, tension +
  double strain = 1e-3;              // of an increment
  std::vector<double> statev{};      // first values; else 0
};

// Prints response, checks and a verdict.  Whether all hold.
bool try_routine(const Trial& trial, std::ostream& out);

}  // namespace sage::umat
