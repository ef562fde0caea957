// The zero of a function that rises through it once, to the last digits, however it bends.
#pragma once

#include <cmath>

namespace sage {

struct ValueAndSlope {
  double value, slope;
};

// low <= x <= high with value(low) <= 0 <= value(high).  Newton's method, and halves where it leaves the bracket or
// gains less than halving would.  Ends where x is certain to `resolution`.
template <class Function>
double rising_zero(const Function& function, double low, double high, double start, double resolution) {
  double x = start, last_bracket = high - low;
  for (int step = 0; step < 200; ++step) {
    const ValueAndSlope at = function(x);
    if (at.value == 0.0) return x;
    (at.value < 0.0 ? low : high) = x;
    const double middle = 0.5 * (low + high);
    double next = at.slope > 0.0 ? x - at.value / at.slope : middle;
    // Every third step has to halve the bracket at least.
    const bool slow = step % 3 == 2 && high - low > 0.5 * last_bracket;
    if (step % 3 == 2) last_bracket = high - low;
    // At the zero Newton's step is as small as the rounding of the value; it may point out of the bracket.
    if (std::abs(next - x) <= resolution) return x;
    if (slow || !(next > low && next < high)) next = middle;
    if (next == low || next == high || high - low <= resolution) return next;
    x = next;
  }
  return x;
}

}  // namespace sage
