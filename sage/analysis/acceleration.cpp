#include "sage/analysis/acceleration.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace sage {

// argmin |correction - changes_ x| over the first columns: modified Gram-Schmidt with pivoting, the right-hand
// side as one more column (Bjorck 1967).  Columns that depend on others take no part.  No memory is taken.
Acceleration::Factors Acceleration::least_squares(int known, const Eigen::VectorXd& correction) {
  basis_.leftCols(known) = changes_.leftCols(known);
  rest_ = correction;
  Eigen::Matrix<double, kMost, kMost> R = Eigen::Matrix<double, kMost, kMost>::Zero();
  Factors c = Factors::Zero(), x = Factors::Zero();
  int place[kMost] = {}, rank = 0;
  for (int j = 0; j < known; ++j) place[j] = j;
  for (; rank < known; ++rank) {
    int pivot = rank;
    for (int j = rank + 1; j < known; ++j)
      if (basis_.col(j).squaredNorm() > basis_.col(pivot).squaredNorm()) pivot = j;
    basis_.col(rank).swap(basis_.col(pivot));
    R.col(rank).swap(R.col(pivot));
    std::swap(place[rank], place[pivot]);
    const double norm = basis_.col(rank).norm();
    if (!(norm > known * std::numeric_limits<double>::epsilon() * R(0, 0))) break;
    R(rank, rank) = norm;
    basis_.col(rank) /= norm;
    for (int j = rank + 1; j < known; ++j) {
      R(rank, j) = basis_.col(rank).dot(basis_.col(j));
      basis_.col(j) -= R(rank, j) * basis_.col(rank);
    }
    c[rank] = basis_.col(rank).dot(rest_);
    rest_ -= c[rank] * basis_.col(rank);
  }
  for (int k = rank - 1; k >= 0; --k) {
    double sum = c[k];
    for (int j = k + 1; j < rank; ++j) sum -= R(k, j) * x[place[j]];
    x[place[k]] = sum / R(k, k);
  }
  return x;
}

void Acceleration::improve(Eigen::VectorXd& correction) {
  if (steps_.rows() != correction.size()) {
    steps_.resize(correction.size(), kMost);
    changes_.resize(correction.size(), kMost);
    basis_.resize(correction.size(), kMost);
    last_correction_.resize(correction.size());
    last_step_.resize(correction.size());
    rest_.resize(correction.size());
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
    const Factors gamma = least_squares(known, correction);
    if (gamma.allFinite())
      for (int j = 0; j < known; ++j) correction -= gamma[j] * (steps_.col(j) + changes_.col(j));
  }
  last_step_ = correction;
  ++count_;
}

}  // namespace sage
