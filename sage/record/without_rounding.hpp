// Numbers of tables for people, without what rounding leaves of sums that cancel.
#pragma once

#include <cmath>

#include "sage/math/rounding.hpp"

namespace sage {

// 0 where the number is smaller than what rounding leaves of the largest one in its table.
inline double without_rounding(double value, double largest) {
  return std::abs(value) < rounding::kResult * largest ? 0.0 : value + 0.0;
}

}  // namespace sage
