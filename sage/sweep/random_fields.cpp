#include "sage/sweep/random_fields.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace sage::sweep {

namespace {

constexpr int kWaves = 128;

// Of one independent normal field, in correlation lengths.
struct Waves {
  Eigen::Matrix2Xd number{2, kWaves};
  Eigen::VectorXd phase{kWaves};

  double at(const Vector2& x) const {
    return std::sqrt(2.0 / kWaves) * ((number.transpose() * x + phase).array().cos().sum());
  }
};

// Wave numbers have the distribution of Cauchy in two dimensions, whose characteristic function is exp(-r).
Waves waves_of(unsigned long long seed, int draw, Eigen::Index component) {
  std::seed_seq seeds{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(draw), static_cast<std::uint32_t>(component)};
  std::mt19937_64 numbers(seeds);
  const auto share = [&] { return (static_cast<double>(numbers() >> 11) + 0.5) * 0x1p-53; };
  Waves waves;
  for (Eigen::Index i = 0; i < kWaves; ++i) {
    const double x = normal_quantile(share()), y = normal_quantile(share()), below = normal_quantile(share());
    waves.number.col(i) = Vector2(x, y) / std::abs(below);
    waves.phase[i] = 2.0 * std::numbers::pi * share();
  }
  return waves;
}

}  // namespace

RandomFields::RandomFields(std::vector<FieldVariable> variables, const Eigen::MatrixXd& correlation,
                           unsigned long long seed)
    : variables_(std::move(variables)), seed_(seed) {
  std::vector<Distribution> distributions;
  for (const FieldVariable& one : variables_) distributions.push_back(one.distribution);
  factor_ = normal_factor(distributions, correlation);
  for (std::size_t i = 0; i < variables_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) != 0.0 &&
          variables_[i].correlation_length != variables_[j].correlation_length)
        throw std::invalid_argument("fields that are correlated have the same correlation_length");
}

std::function<double(const Vector2&)> RandomFields::field(std::size_t variable, int draw) const {
  const auto row = static_cast<Eigen::Index>(variable);
  std::vector<Waves> waves;
  std::vector<double> share;
  for (Eigen::Index component = 0; component <= row; ++component) {
    if (factor_(row, component) == 0.0) continue;
    waves.push_back(waves_of(seed_, draw, component));
    share.push_back(factor_(row, component));
  }
  return
      [one = variables_[variable], waves = std::move(waves), share = std::move(share)](const Vector2& place) {
        const Vector2 x = place.cwiseQuotient(one.correlation_length);
        double z = 0.0;
        for (std::size_t i = 0; i < waves.size(); ++i) z += share[i] * waves[i].at(x);
        return one.distribution.at(z);
      };
}

}  // namespace sage::sweep
