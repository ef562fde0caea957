#include "sage/math/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <numeric>
#include <utility>

namespace sage::dense_matrix {

void PivotedQr::factorise(const Eigen::MatrixXd& V) {
  const Eigen::Index rows = V.rows(), columns = V.cols();
  Q_ = V;
  R_.resize(columns, columns);
  order_.resize(columns);
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  const auto product = [&](const double* a, const double* b) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) sum += a[i] * b[i];
    return sum;
  };
  for (std::size_t k = 0; k < order_.size(); ++k) {
    std::size_t longest = k;
    double most = -1.0;
    for (std::size_t other = k; other < order_.size(); ++other) {
      const double* v = &Q_(0, order_[other]);
      if (const double square = product(v, v); square > most) {
        most = square;
        longest = other;
      }
    }
    std::swap(order_[k], order_[longest]);
    const Eigen::Index j = order_[k];
    double* q = &Q_(0, j);
    const double length = std::sqrt(most);
    R_(j, j) = length;
    for (Eigen::Index i = 0; i < rows; ++i) q[i] = length > 0.0 ? q[i] / length : 0.0;
    for (std::size_t later = k + 1; later < order_.size(); ++later) {
      double* v = &Q_(0, order_[later]);
      const double along = product(q, v);
      R_(j, order_[later]) = along;
      for (Eigen::Index i = 0; i < rows; ++i) v[i] -= along * q[i];
    }
  }
}

Eigen::Index PivotedQr::rank(double threshold) const {
  const double least = threshold * R_.diagonal().maxCoeff();
  return (R_.diagonal().array() > least).count();
}

Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(threshold);
  return decomposition.compute(A).solve(b);
}

Eigen::MatrixXd smallest_solutions(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.completeOrthogonalDecomposition().solve(B);
}

Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& A) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d>(A).pseudoInverse();
}

std::vector<Eigen::Index> dependent_columns(const Eigen::MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  qr.setThreshold(threshold);
  const auto order = qr.colsPermutation().indices().cast<Eigen::Index>();
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = qr.rank(); k < A.cols(); ++k) columns.push_back(order[k]);
  return columns;
}

EigensystemOf<3> symmetric_eigensystem_3(const Eigen::Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace sage::dense_matrix
