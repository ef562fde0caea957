// Values that vary at random from place to place, the same on every machine.
#pragma once

#include <functional>

#include "sage/core/types.hpp"
#include "sage/sweep/draws.hpp"

namespace sage::sweep {

struct FieldVariable {
  Distribution distribution;             // of the value at any one place
  Vector2 correlation_length{1.0, 1.0};  // in x and y, in the deck's unit of length
};

// Normal variables behind the values of two places have the correlation exp(-r), r = |(dx / lx, dy / ly)|.  Each draw is a
// sum of cosine waves with random directions and phases (spectral representation: Shinozuka & Deodatis 1991), which has
// that mean, variance and correlation exactly, and a value at every place without a mesh.
class RandomFields {
 public:
  // correlation: of the values of two variables at one place.  Throws std::invalid_argument where no such variables exist,
  // or where correlated ones differ in their correlation lengths.
  RandomFields(std::vector<FieldVariable> variables, const Eigen::MatrixXd& correlation,
               unsigned long long seed);

  // The value of a variable at a place, in one draw (from 1).
  std::function<double(const Vector2&)> field(std::size_t variable, int draw) const;

 private:
  std::vector<FieldVariable> variables_;
  Eigen::MatrixXd factor_;  // lower: of the correlation of the normal variables
  unsigned long long seed_;
};

}  // namespace sage::sweep
