// How the increments of a stage divide its load path: the piece between stage and step.
#pragma once

#include <cmath>

namespace sage {

class TimeScheme {
 public:
  virtual ~TimeScheme() = default;
  // Load factor of a stage (from 0) at the end of an increment (1 to increments).  It must increase from above 0, and be 1
  // for the last increment; the run throws std::logic_error otherwise.  Time grows in proportion to it over the duration of
  // the stage.  Called several times for an increment, with the same result.
  virtual double load_factor(int stage, int increment, int increments) const = 0;
};

// Equal increments: the rule of a run without a scheme.
class EqualIncrements final : public TimeScheme {
 public:
  double load_factor(int /*stage*/, int increment, int increments) const override {
    return static_cast<double>(increment) / increments;
  }
};

// Each increment of a stage is so many times the one before; ratio > 0.  Below 1 increments become smaller towards the end
// of the stage, as near a limit load.
class GradedIncrements final : public TimeScheme {
 public:
  explicit GradedIncrements(double ratio) : ratio_(ratio) {}
  double load_factor(int /*stage*/, int increment, int increments) const override {
    if (increment == increments) return 1.0;
    const double log_ratio = std::log(ratio_);
    if (log_ratio == 0.0) return static_cast<double>(increment) / increments;
    return std::expm1(increment * log_ratio) / std::expm1(increments * log_ratio);
  }

 private:
  double ratio_;
};

}  // namespace sage
