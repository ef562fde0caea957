#include "sage/sweep/probability.hpp"

#include <cmath>

namespace sage::sweep {

namespace {

// Probability of at most `count` failures among `cases`, each with probability p.
double binomial_share(long count, long cases, double p) {
  if (p <= 0.0) return 1.0;
  if (p >= 1.0) return count >= cases ? 1.0 : 0.0;
  double sum = 0.0;
  const auto n = static_cast<double>(cases);
  for (long k = 0; k <= count; ++k) {
    const auto i = static_cast<double>(k);
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  }
  return sum;
}

// The p at which the share falls to `wanted`.
double p_with_share(long count, long cases, double wanted) {
  double low = 0.0, high = 1.0;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (binomial_share(count, cases, middle) > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Probability probability_of(long failures, long cases, double confidence) {
  if (cases == 0) return {std::nan(""), 0.0, 1.0};
  const double tail = 0.5 * (1.0 - confidence);
  Probability p;
  p.value = static_cast<double>(failures) / static_cast<double>(cases);
  p.low = failures == 0 ? 0.0 : p_with_share(failures - 1, cases, 1.0 - tail);
  p.high = failures == cases ? 1.0 : p_with_share(failures, cases, tail);
  return p;
}

}  // namespace sage::sweep
