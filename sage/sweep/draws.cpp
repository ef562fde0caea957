#include "sage/sweep/draws.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "sage/math/dense.hpp"

namespace sage::sweep {

namespace {

constexpr double kRootHalf = 0.70710678118654752440;

// Points and weights of Gauss and Hermite for means over a standard normal variable (Golub and Welsch).
struct NormalRule {
  Eigen::VectorXd z, weight;
};

const NormalRule& normal_rule() {
  static const NormalRule rule = [] {
    constexpr int kPoints = 32;
    Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(kPoints, kPoints);
    for (int i = 1; i < kPoints; ++i) jacobi(i, i - 1) = jacobi(i - 1, i) = std::sqrt(static_cast<double>(i));
    const dense_matrix::Eigensystem modes = dense_matrix::symmetric_eigensystem(jacobi);
    return NormalRule{modes.values, modes.vectors.row(0).cwiseAbs2().transpose()};
  }();
  return rule;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments moments_of(const Distribution& one) {
  const NormalRule& rule = normal_rule();
  Moments m;
  double square = 0.0;
  for (Eigen::Index i = 0; i < rule.z.size(); ++i) {
    const double value = one.at(rule.z[i]);
    m.mean += rule.weight[i] * value;
    square += rule.weight[i] * value * value;
  }
  m.deviation = std::sqrt(std::max(0.0, square - m.mean * m.mean));
  return m;
}

// Correlation of two values whose normal variables have the correlation rho.
double correlation_of_values(const Distribution& a, const Distribution& b, double rho) {
  const NormalRule& rule = normal_rule();
  const Moments ma = moments_of(a), mb = moments_of(b);
  const double rest = std::sqrt(std::max(0.0, 1.0 - rho * rho));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < rule.z.size(); ++i)
    for (Eigen::Index j = 0; j < rule.z.size(); ++j)
      sum += rule.weight[i] * rule.weight[j] * (a.at(rule.z[i]) - ma.mean) *
             (b.at(rho * rule.z[i] + rest * rule.z[j]) - mb.mean);
  return sum / (ma.deviation * mb.deviation);
}

// It grows with that of the normal variables.
double normal_correlation(const Distribution& a, const Distribution& b, double wanted) {
  if (wanted == 0.0 || (a.shape == Shape::normal && b.shape == Shape::normal && std::isinf(a.low) &&
                        std::isinf(a.high) && std::isinf(b.low) && std::isinf(b.high)))
    return wanted;
  double low = -0.9999, high = 0.9999;
  if (wanted < correlation_of_values(a, b, low) - 1e-3 || wanted > correlation_of_values(a, b, high) + 1e-3)
    throw std::invalid_argument("two values of these distributions can't have a correlation of " +
                                std::to_string(wanted));
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (correlation_of_values(a, b, middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double normal_share(double z) {
  return 0.5 * std::erfc(-z * kRootHalf);
}

// Newton's iteration from a rough start; erfc is exact in the tails, too.
double normal_quantile(double share) {
  if (share > 0.5) return -normal_quantile(1.0 - share);
  if (!(share > 0.0)) return -std::numeric_limits<double>::infinity();
  const double t = std::sqrt(-2.0 * std::log(share));  // Abramowitz and Stegun 26.2.23
  double z = -(t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                       (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))));
  constexpr double kRootTwoPi = 2.50662827463100050242;
  for (int i = 0; i < 3; ++i) {
    const double step = (normal_share(z) - share) * kRootTwoPi * std::exp(0.5 * z * z);
    z -= step / (1.0 + 0.5 * z * step);  // Halley
  }
  return z;
}

double Distribution::at(double z) const {
  if (shape == Shape::uniform) return low + (high - low) * normal_share(z);
  double center = mean, spread = deviation;
  const bool logs = shape == Shape::lognormal;
  if (logs) {
    spread = std::sqrt(std::log1p(deviation / mean * (deviation / mean)));
    center = std::log(mean) - 0.5 * spread * spread;
  }
  // Cut off at low and high, what is left in proportion.
  const auto share_at = [&](double limit) {
    return normal_share(((logs ? std::log(limit) : limit) - center) / spread);
  };
  const double below = std::isinf(low) || (logs && low <= 0.0) ? 0.0 : share_at(low);
  const double above = std::isinf(high) ? 1.0 : share_at(high);
  if (below > 0.0 || above < 1.0) z = normal_quantile(below + (above - below) * normal_share(z));
  const double value = center + spread * z;
  return std::clamp(logs ? std::exp(value) : value, low, high);
}

Eigen::MatrixXd normal_factor(const std::vector<Distribution>& variables, const Eigen::MatrixXd& correlation) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      normal(i, j) = normal(j, i) = normal_correlation(variables[i], variables[j], correlation(i, j));
  const Eigen::LLT<Eigen::MatrixXd> factors(normal);
  if (factors.info() != Eigen::Success)
    throw std::invalid_argument("the correlation matrix is not positive definite: no variables have it");
  return factors.matrixL();
}

Eigen::MatrixXd draw(const std::vector<Distribution>& variables, const Eigen::MatrixXd& correlation, int draws,
                     unsigned long long seed) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  const Eigen::MatrixXd lower = normal_factor(variables, correlation);
  std::mt19937_64 numbers(seed);
  Eigen::MatrixXd values(draws, count);
  Eigen::VectorXd z(count);
  for (int row = 0; row < draws; ++row) {
    for (Eigen::Index i = 0; i < count; ++i)  // the middle of one of 2^53 parts
      z[i] = normal_quantile((static_cast<double>(numbers() >> 11) + 0.5) * 0x1p-53);
    const Eigen::VectorXd together = lower.triangularView<Eigen::Lower>() * z;
    for (Eigen::Index i = 0; i < count; ++i) values(row, i) = variables[i].at(together[i]);
  }
  return values;
}

}  // namespace sage::sweep
