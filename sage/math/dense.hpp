// Decompositions of dense matrices of any size, compiled once: each costs the compiler seconds wherever
// it is used.  For patches of elements and single points; element and law loops have fixed sizes and Eigen itself.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sage::dense_matrix {

// Orthogonal columns of a matrix of few rows by Gram & Schmidt (modified), the longest column that is left first.  Values
// go through the same steps as columns: then it is as stable as Householder's reflections (Bjorck, BIT 7, 1967), and for
// the small fits of patches quicker than Eigen's.
class PivotedQr {
 public:
  // V: rows x columns, no more columns than rows.  Takes the place of what was there; keeps its room where the
  // size stays.
  void factorise(const Eigen::MatrixXd& V);
  // Of V.  What is less certain by `threshold` than the rest does not count.
  Eigen::Index rank(double threshold) const;
  // X (values x columns of V) of the least |V x - b| of each row x of X and b of B (values x rows of V); V of full
  // rank.  B is used up: what is left in it is the part that no x meets.
  template <class Values>
  void least_squares(Values& B, Values& X) const;

 private:
  Eigen::MatrixXd Q_, R_;            // V = Q R; columns of both, and rows of R, where they are in V
  std::vector<Eigen::Index> order_;  // of columns
};

// The smallest of the x of the least |A x - b|; A of any rank (complete orthogonal decomposition).  Pivots below
// `threshold` times the largest are zero.
Eigen::VectorXd smallest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);

// The same for each column of B.  Pivots below rounding are zero.
Eigen::MatrixXd smallest_solutions(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// Of Moore and Penrose, of any rank.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& A);

// Columns of A that are combinations of the others, by elimination with the longest column that is left first.  Pivots below
// `threshold` times the largest are zero.
std::vector<Eigen::Index> dependent_columns(const Eigen::MatrixXd& A, double threshold);

template <int N>
struct EigensystemOf {
  Eigen::Matrix<double, N, 1> values;   // rising
  Eigen::Matrix<double, N, N> vectors;  // a column each, of length 1
};
using Eigensystem = EigensystemOf<Eigen::Dynamic>;

// Of a symmetric matrix; its lower triangle is read.
Eigensystem symmetric_eigensystem(const Eigen::MatrixXd& A);
EigensystemOf<3> symmetric_eigensystem_3(const Eigen::Matrix3d& A);

template <class Values>
void PivotedQr::least_squares(Values& B, Values& X) const {
  using Value = Eigen::Matrix<double, Values::RowsAtCompileTime, 1>;
  X.resize(B.rows(), Q_.cols());
  for (const Eigen::Index j : order_) {
    Value part = Q_(0, j) * B.col(0);
    for (Eigen::Index i = 1; i < B.cols(); ++i) part += Q_(i, j) * B.col(i);
    for (Eigen::Index i = 0; i < B.cols(); ++i) B.col(i) -= Q_(i, j) * part;
    X.col(j) = part;
  }
  for (std::size_t k = order_.size(); k-- > 0;) {
    const Eigen::Index j = order_[k];
    for (std::size_t later = k + 1; later < order_.size(); ++later)
      X.col(j) -= R_(j, order_[later]) * X.col(order_[later]);
    X.col(j) /= R_(j, j);
  }
}

}  // namespace sage::dense_matrix
