#include "sage/convergence/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage::convergence {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// d2 / d1 of the three values that end at `last`; nothing where they don't approach a limit from one side.
std::optional<double> shrinking(std::span<const double> v, std::size_t last) {
  const double d1 = v[last - 1] - v[last - 2], d2 = v[last] - v[last - 1];
  if (d1 == 0.0) return {};
  const double r = d2 / d1;
  return r > 0.0 && r < 1.0 ? std::optional<double>(r) : std::nullopt;
}

// |v[k] - v[k - 1]|.
double difference(std::span<const double> v, std::size_t k) {
  return std::abs(v[k] - v[k - 1]);
}

double least_error(std::span<const double> v) {
  return kLeastError * std::abs(v.back());
}

// The last difference as those before let expect it: one that is smaller can be chance.  Of three values the
// first stands for the difference before it.
double expected_difference(std::span<const double> v, MeshSequence sequence) {
  const std::size_t n = v.size();
  const double d1 = difference(v, n - 2);
  if (sequence.kind == MeshSequence::halving) return d1 / sequence.most;
  // From the last degree to the first halved mesh of it no rate carries over.
  if (n == sequence.degrees + 1) return std::max(d1, 4.0 * difference(v, n - 1));
  const double d0 = n >= 4 ? difference(v, n - 3) : std::abs(v[n - 3]);
  return d1 < d0 ? d1 * d1 / d0 : d1;
}

// The ratio of the last two differences.  Spectral: behind a difference that was small by chance, the last
// one's share of the one before that, in two equal steps.
double ratio_of_differences(std::span<const double> v, MeshSequence sequence) {
  const std::size_t n = v.size();
  const double d2 = difference(v, n - 1), d1 = difference(v, n - 2);
  if (d2 < d1) return d2 / d1;
  const double d0 = sequence.kind == MeshSequence::spectral && n >= 4 ? difference(v, n - 3) : 0.0;
  return d2 < d0 ? std::sqrt(d2 / d0) : 1.0;
}

// What the last difference alone says, given how it compares with the one before.  Rates of halved meshes are
// not yet clean where this is used: half as much again.
double plain_error(std::span<const double> v, MeshSequence sequence) {
  const std::size_t n = v.size();
  if (n < (sequence.kind == MeshSequence::halving ? 3u : 2u))
    return kUnknown;  // halved meshes: at an unknown rate
  const double d2 = difference(v, n - 1);
  if (n < 3) return d2;
  const double expected = expected_difference(v, sequence);
  // Differences that grow mean nothing yet, unless they are within what no error is stated below.
  if (d2 <= least_error(v)) return expected;
  const double r = ratio_of_differences(v, sequence);
  if (r >= 1.0) return kUnknown;
  const double caution = sequence.kind == MeshSequence::halving ? 1.5
                         : r > 0.1                              ? 3.0
                                                                : 1.0;  // a tenth: hardly spectral
  return std::max(d2 * std::max(1.0, r / (1.0 - r)) * caution, expected);
}

// Richardson's extrapolation, where the rates agree.
void extrapolate(std::span<const double> v, Limit& limit) {
  const std::size_t n = v.size();
  const auto before = shrinking(v, n - 2), now = shrinking(v, n - 1);
  if (!before || !now) return;
  const double q0 = -std::log2(*before), q1 = -std::log2(*now);
  if (std::abs(q1 - q0) >= 0.2) return;
  const auto extrapolated = [&](std::size_t last, double r) {
    return v[last] + (v[last] - v[last - 1]) * r / (1 - r);
  };
  limit.value = extrapolated(n - 1, *now);
  limit.error =
      std::max(std::abs(limit.value - extrapolated(n - 2, *before)), 0.1 * std::abs(limit.value - v[n - 1]));
  limit.rate = q1;
}

}  // namespace

Limit limit_of(std::span<const double> v, MeshSequence sequence, Around around) {
  const std::size_t n = v.size();
  if (n == 0) return {0.0, kUnknown, {}};
  const bool shown = around.error.size() >= n && !std::isnan(around.error[n - 1]);
  if (shown && around.alone) return {v[n - 1], std::max(around.error[n - 1], least_error(v)), {}};
  Limit limit{v[n - 1], plain_error(v, sequence), {}};
  if (sequence.kind == MeshSequence::halving && n >= 4) extrapolate(v, limit);
  if (shown) limit.error = std::max(limit.error, around.error[n - 1]);
  limit.error = std::max(limit.error, least_error(v));
  return limit;
}

Limit limit_after(std::span<const double> v, std::size_t meshes, MeshSequence sequence, Around around) {
  Limit limit = limit_of(v.first(meshes), sequence, around.first(meshes));
  const double own = std::abs(v[meshes - 1] - limit.value), stated = limit.error;
  for (std::size_t n = meshes + 1; n <= v.size(); ++n) {
    limit.error = std::max(limit.error, std::abs(v[n - 1] - limit.value) - own);
    const Limit later = limit_of(v.first(n), sequence, around.first(n));
    if (later.error < stated) limit.error = std::max(limit.error, std::abs(later.value - limit.value));
  }
  return limit;
}

}  // namespace sage::convergence
