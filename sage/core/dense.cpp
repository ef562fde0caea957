#include "sage/core/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace sage::dense_matrix {

struct PivotedQr::Factors {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
};

PivotedQr::PivotedQr() : factors_(std::make_unique<Factors>()) {}
PivotedQr::~PivotedQr() = default;

void PivotedQr::factorise(const Eigen::MatrixXd& V) {
  factors_->qr.compute(V);
}

Eigen::Index PivotedQr::rank(double threshold) {
  factors_->qr.setThreshold(threshold);
  return factors_->qr.rank();
}

Eigen::MatrixXd PivotedQr::least_squares(const Eigen::MatrixXd& B) const {
  return factors_->qr.solve(B);
}

Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
}

Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace sage::dense_matrix
