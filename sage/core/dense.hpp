// Decompositions of dense matrices of any size, compiled once: each costs the compiler seconds wherever
// it is used.  For patches of elements and single points; element and law loops have fixed sizes and Eigen itself.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace sage::dense_matrix {

// Householder QR with column pivoting.
class PivotedQr {
 public:
  PivotedQr();
  ~PivotedQr();
  // Takes the place of what was there; keeps its room where the size stays.
  void factorise(const Eigen::MatrixXd& V);
  // Of V.  What is less certain by `threshold` than the rest does not count.
  Eigen::Index rank(double threshold);
  // X of the least |V X - B|, column by column.
  Eigen::MatrixXd least_squares(const Eigen::MatrixXd& B) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

// The smallest of the x of the least |A x - b|; A of any rank (complete orthogonal decomposition).
Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

struct Eigensystem {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // a column each, of length 1
};

// Of a symmetric matrix; its lower triangle is read.
Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A);

}  // namespace sage::dense_matrix
