// One text for work at one point and at four points side by side: Real is double or Four.  What differs between the two.
#pragma once

#include <array>
#include <cmath>

#include "sage/core/four.hpp"
#include "sage/math/exp_and_log.hpp"

namespace sage {

template <class Real>
inline constexpr std::size_t kPlaces = sizeof(Real) / sizeof(double);

// [xx yy zz xy]
template <class Real>
using Tensor = std::array<Real, 4>;

// The value at one of the points.
inline double& place(double& x, std::size_t /*l*/) {
  return x;
}
inline double place(const double& x, std::size_t /*l*/) {
  return x;
}
inline double& place(Four& x, std::size_t l) {
  return one_of_four(x, l);
}
inline double place(const Four& x, std::size_t l) {
  return one_of_four(x, l);
}
template <class Real>
Vector4 place(const Tensor<Real>& t, std::size_t l) {
  return {place(t[0], l), place(t[1], l), place(t[2], l), place(t[3], l)};
}

template <class Real>
Real everywhere(double x) {
  return Real{} + x;
}

inline bool holds_everywhere(bool at_the_point) {
  return at_the_point;
}
inline bool holds_everywhere(const FourMask& mask) {
  return bits_of_four(mask) == kAllOfFour;
}

inline double root(double x) {
  return std::sqrt(x);
}
inline Four root(const Four& x) {
  return sqrt_of_four(x);
}

// Those of double (exp_and_log.hpp), to rounding.  A value does not depend on those beside it.
inline Four exp_less_1(const Four& x) {
  const Four size = abs_of_four(x);
  const FourMask near = size < all_four(0.3);
  const Four y = near ? x : 0.25 * x;
  Four less = 1.0 / 40320 + y * (1.0 / 362880 + y * (1.0 / 3628800 + y * (1.0 / 39916800 + y / 479001600.0)));
  less = 1.0 / 24 + y * (1.0 / 120 + y * (1.0 / 720 + y * (1.0 / 5040 + y * less)));
  less = y * (1.0 + y * (1.0 / 2 + y * (1.0 / 6 + y * less)));
  if (holds_everywhere(near)) return less;
  const Four of_half = less * (2.0 + less), of_all = of_half * (2.0 + of_half);
  less = near ? less : of_all;
  for (std::size_t l = 0; l < kAbreast; ++l)
    if (!(place(size, l) < 1.0)) place(less, l) = exp_less_1(place(x, l));
  return less;
}

inline Four log_1_plus(const Four& x) {
  Four w = x / (2.0 + x);
  const FourMask near = w * w < all_four(0.045);
  if (!holds_everywhere(near)) {
    const Four of_root = x / (1.0 + root(1.0 + x)),
               of_fourth = of_root / (1.0 + root(1.0 + of_root));  // less 1
    w = near ? w : of_fourth / (2.0 + of_fourth);
  }
  const Four z = w * w;
  Four log = 1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15 + z * (1.0 / 17 + z * (1.0 / 19 + z / 21.0))));
  log = 2.0 * w * (1.0 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * log)))));
  if (holds_everywhere(near)) return log;
  log = near ? log : 4.0 * log;
  for (std::size_t l = 0; l < kAbreast; ++l)
    if (!(place(x, l) > -0.75 && place(x, l) < 1.5)) place(log, l) = log_1_plus(place(x, l));
  return log;
}

}  // namespace sage
