#include "sage/study/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage::study {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// d2 / d1 of the three values that end at `last`; nothing where they don't approach a limit from one side.
std::optional<double> shrinking(std::span<const double> v, std::size_t last) {
  const double d1 = v[last - 1] - v[last - 2], d2 = v[last] - v[last - 1];
  if (d1 == 0.0) return {};
  const double r = d2 / d1;
  return r > 0.0 && r < 1.0 ? std::optional<double>(r) : std::nullopt;
}

// The last difference as the rate before it foretold it.  One that is smaller can be chance.
double expected_difference(std::span<const double> v) {
  const std::size_t n = v.size();
  const double d0 = std::abs(v[n - 3] - v[n - 4]), d1 = std::abs(v[n - 2] - v[n - 3]);
  return d1 < d0 ? d1 * d1 / d0 : d1;
}

// What the last difference alone says, given how it compares with the one before.  Rates of halved meshes are
// not yet clean where this is used: half as much again.
double plain_error(std::span<const double> v, Ladder ladder) {
  const std::size_t n = v.size();
  if (n < (ladder == Ladder::halving ? 3u : 2u)) return kUnknown;  // halved meshes: at an unknown rate
  const double d2 = std::abs(v[n - 1] - v[n - 2]);
  if (n < 3 || d2 == 0.0) return d2;
  const double r = d2 / std::max(std::abs(v[n - 2] - v[n - 3]), std::numeric_limits<double>::min());
  // Differences that grow mean nothing yet, unless all of them are rounding.
  const bool rounding = d2 < 1e-12 * std::abs(v[n - 1]);
  if (rounding || r >= 1.0) return rounding ? d2 : kUnknown;
  const double caution = ladder == Ladder::halving ? 1.5 : r > 0.1 ? 3.0 : 1.0;  // a tenth: hardly spectral
  const double error = d2 * std::max(1.0, r / (1.0 - r)) * caution;
  return ladder == Ladder::spectral && n >= 4 ? std::max(error, expected_difference(v)) : error;
}

}  // namespace

Limit limit_of(std::span<const double> v, Ladder ladder) {
  const std::size_t n = v.size();
  Limit limit{n > 0 ? v[n - 1] : 0.0, plain_error(v, ladder), {}};
  if (ladder != Ladder::halving || n < 4) return limit;
  const auto before = shrinking(v, n - 2), now = shrinking(v, n - 1);
  if (!before || !now) return limit;
  const double q0 = -std::log2(*before), q1 = -std::log2(*now);
  if (std::abs(q1 - q0) >= 0.2) return limit;
  const auto extrapolated = [&](std::size_t last, double r) {
    return v[last] + (v[last] - v[last - 1]) * r / (1 - r);
  };
  limit.value = extrapolated(n - 1, *now);
  limit.error =
      std::max(std::abs(limit.value - extrapolated(n - 2, *before)), 0.1 * std::abs(limit.value - v[n - 1]));
  limit.rate = q1;
  return limit;
}

}  // namespace sage::study
