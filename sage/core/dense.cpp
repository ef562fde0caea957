#include "sage/core/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace sage::dense_matrix {

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& V, const Eigen::MatrixXd& B) {
  return V.colPivHouseholderQr().solve(B);
}

Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
}

Eigen::Index rank(const Eigen::MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  qr.setThreshold(threshold);
  return qr.rank();
}

Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace sage::dense_matrix
