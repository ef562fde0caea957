// Random values with given distributions and correlations, the same on every machine.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace sage::sweep {

enum class Shape { normal, lognormal, uniform };

// normal and lognormal: mean and standard deviation of the value itself, before it is cut off at low and high;
// uniform: from low to high.
struct Distribution {
  Shape shape = Shape::normal;
  double mean = 0.0, deviation = 1.0;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  // The value below which a standard normal variable's share of z lies.
  double at(double z) const;
};

// Share of a standard normal variable below z, and back.
double normal_share(double z);
double normal_quantile(double share);

// Lower factor of the correlation matrix of the normal variables behind values with the correlation `correlation` (Nataf's model).
// Throws std::invalid_argument where no such variables exist.
Eigen::MatrixXd normal_factor(const std::vector<Distribution>& variables, const Eigen::MatrixXd& correlation);

// One row a draw, one column a variable.  Draw i does not depend on how many there are.  correlation: of the values; what the
// normal variables behind them need follows from it (Nataf's model).  Throws std::invalid_argument where no such variables
// exist.
Eigen::MatrixXd draw(const std::vector<Distribution>& variables, const Eigen::MatrixXd& correlation, int draws,
                     unsigned long long seed);

}  // namespace sage::sweep
