// What a row of results on finer and finer meshes says about its limit.
#pragma once

#include <optional>
#include <span>

namespace sage::study {

enum class Ladder {
  halving,   // each mesh has half the element size of the one before: error ~ h^q with an unknown q
  spectral,  // degree and grading grow together: the error falls by a large factor each time
};

struct Limit {
  double value = 0.0;
  double error = 0.0;  // half the width of what the limit is expected in; infinite = nothing can be said
  std::optional<double> rate;  // q of halving where two successive rates agree, so that `value` is extrapolated
};

// halving: with differences d1, d2 of the last three values and r = d2 / d1 = 2^-q the limit is v + d2 r / (1 -
// r) (Richardson 1911).  Extrapolated only where the rates of two successive triples differ by less than 0.2;
// then `error` is the change that the last mesh made to the extrapolated value, and no less than a tenth of the
// extrapolation itself.  In all other cases the last value stands, with the last difference or, where it falls
// slowly (r > 1/2), the sum of the geometric series.  spectral: no less, from four values on, than what the
// last difference should have been at the rate of the two before.
Limit limit_of(std::span<const double> values, Ladder ladder);

}  // namespace sage::study
