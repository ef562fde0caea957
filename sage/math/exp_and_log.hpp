// exp(x) - 1 and ln(1 + x).  In steps of an analysis x is small, and a few terms of a series give both to rounding, in a
// fraction of the time of the library's functions.
#pragma once

#include <cmath>

namespace sage {

inline double exp_less_1(double x) {
  if (!(std::abs(x) < 0.01)) return std::expm1(x);
  return x * (1.0 + x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720)))));
}

inline double log_1_plus(double x) {
  if (!(std::abs(x) < 0.1)) return std::log1p(x);
  const double y = x / (2.0 + x), z = y * y;
  return 2.0 * y *
         (1.0 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z / 13))))));
}

}  // namespace sage
