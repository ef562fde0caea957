#include "sage/analysis/acceleration.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace sage {

void Acceleration::improve(Eigen::VectorXd& correction) {
  if (steps_.rows() != correction.size()) {
    steps_.resize(correction.size(), kMost);
    changes_.resize(correction.size(), kMost);
    count_ = 0;
  }
  const int known = std::min(count_, kMost);
  if (known > 0) {
    const int column = (count_ - 1) % kMost;
    steps_.col(column) = last_step_;
    changes_.col(column) = correction - last_correction_;
  }
  last_correction_ = correction;
  if (known > 0) {
    const auto changes = changes_.leftCols(known);
    const Eigen::VectorXd gamma = changes.colPivHouseholderQr().solve(correction);
    if (gamma.allFinite()) correction -= (steps_.leftCols(known) + changes) * gamma;
  }
  last_step_ = correction;
  ++count_;
}

}  // namespace sage
