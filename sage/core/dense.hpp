// Decompositions of dense matrices of any size, compiled once: each costs the compiler seconds wherever
// it is used.  For patches of elements and single points; element and law loops have fixed sizes and Eigen itself.
#pragma once

#include <Eigen/Core>

namespace sage::dense_matrix {

// X of the least |V X - B|, column by column; Householder QR with column pivoting.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& V, const Eigen::MatrixXd& B);

// The smallest of the x of the least |A x - b|; A of any rank (complete orthogonal decomposition).
Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

// What is less certain by `threshold` than the rest does not count.
Eigen::Index rank(const Eigen::MatrixXd& A, double threshold);

struct Eigensystem {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // a column each, of length 1
};

// Of a symmetric matrix; its lower triangle is read.
Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A);

}  // namespace sage::dense_matrix
