#include "sage/analysis/matrix_sizes.hpp"

#include <random>

#include "sage/analysis/by_field.hpp"

namespace sage {

namespace {

// 1 and -1 without an order: no row of a matrix cancels against them but by chance.
Eigen::VectorXd signs(Eigen::Index equations) {
  Eigen::VectorXd v(equations);
  std::minstd_rand next;
  for (double& sign : v) sign = next() % 2 == 0 ? 1.0 : -1.0;
  return v;
}

}  // namespace

void MatrixSizes::take(const KeptMatrix* matrix, int equations) {
  matrix_ = matrix;
  equations_ = equations;
  forget();
}

void MatrixSizes::forget() {
  norm1_.reset();
  sizes_.clear();
}

double MatrixSizes::norm1() const {
  if (!norm1_) norm1_ = matrix_ != nullptr ? matrix_->norm1() : -1.0;
  return *norm1_;
}

Eigen::VectorXd MatrixSizes::times(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product(x.size());
  const auto n = static_cast<std::size_t>(x.size());
  matrix_->multiply({x.data(), n}, {product.data(), n});
  return product;
}

double MatrixSizes::coupling_of(const ByField& fields, int to, int from) const {
  const auto count = static_cast<std::size_t>(fields.count());
  if (sizes_.empty()) {
    const Eigen::VectorXd all = signs(equations_);
    for (int f = 0; f < fields.count(); ++f) {
      const Eigen::VectorXd forces = times(fields.part(all, f));
      for (int row = 0; row < fields.count(); ++row) sizes_.push_back(fields.largest(forces, row));
    }
  }
  return sizes_[static_cast<std::size_t>(from) * count + static_cast<std::size_t>(to)];
}

}  // namespace sage
