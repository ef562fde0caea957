// How large K is, where its solver keeps the matrix: what is measured once stays until K changes.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sage/core/solver_extensions.hpp"

namespace sage {

class ByField;

class MatrixSizes {
 public:
  // Another matrix of so many equations; nullptr: the solver keeps none.
  void take(const KeptMatrix* matrix, int equations);
  void forget();

  // Nullptr where the solver keeps none.
  const KeptMatrix* matrix() const { return matrix_; }
  // The largest column sum of |K|; -1 where the solver keeps no matrix.
  double norm1() const;
  // Largest size, in the equations of the field `to`, of K times signs without an order in those of the field
  // `from`: of the block's row sums from below.
  double coupling_of(const ByField& fields, int to, int from) const;
  // K x, where the solver keeps its matrix.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;

 private:
  const KeptMatrix* matrix_ = nullptr;
  int equations_ = 0;
  mutable std::optional<double> norm1_;
  mutable std::vector<double> sizes_;  // coupling_of() all fields, column by column
};

}  // namespace sage
