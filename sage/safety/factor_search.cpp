#include "sage/safety/factor_search.hpp"

#include <algorithm>

namespace sage::safety {

namespace {

constexpr double kFirstStep = 0.1;  // of the first factor, and the least
constexpr double kGrowth = 1.5;     // of steps upwards, until a factor falls
constexpr double kDown = 0.7;       // from a factor that falls to the next lower one, until one stands

}  // namespace

void FactorSearch::stands(double factor) {
  if (lower_) step_ = factor - *lower_;
  lower_ = std::max(lower_.value_or(factor), factor);
  std::erase_if(falls_, [&](double other) { return other <= *lower_; });
}

void FactorSearch::falls(double factor) {
  falls_.push_back(factor);
}

void FactorSearch::drop(double factor) {
  std::erase(falls_, factor);
}

std::optional<double> FactorSearch::upper() const {
  if (falls_.empty()) return {};
  return *std::ranges::min_element(falls_);
}

bool FactorSearch::bracketed() const {
  return lower_ && upper() && *upper() - *lower_ <= limits_.tolerance * (1.0 + 1e-9);
}

std::optional<double> FactorSearch::next() const {
  const std::optional<double> high = upper();
  if (!lower_ && !high) return limits_.start;
  if (!lower_) {
    if (*high <= limits_.smallest) return {};
    return std::max(kDown * *high, limits_.smallest);
  }
  if (high) return bracketed() ? std::nullopt : std::optional<double>(0.5 * (*lower_ + *high));
  if (*lower_ >= limits_.largest) return {};
  const double step = std::max(kGrowth * step_, kFirstStep * limits_.start);
  return std::min(*lower_ + std::max(step, limits_.tolerance), limits_.largest);
}

}  // namespace sage::safety
