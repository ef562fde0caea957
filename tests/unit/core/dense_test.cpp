// Dense decompositions against what defines their answers.
#include "sage/math/dense.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The conditions of Penrose, for a matrix of rank 2.
TEST(Dense, PseudoInverseOfRankTwo) {
  Matrix3d A;
  A << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Matrix3d X = dense_matrix::pseudo_inverse(A);
  EXPECT_LT((A * X * A - A).cwiseAbs().maxCoeff(), 1e-13 * 9);
  EXPECT_LT((X * A * X - X).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((A * X - (A * X).transpose()).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((X * A - (X * A).transpose()).cwiseAbs().maxCoeff(), 1e-13);
}

// x + y = 2 twice: of all answers (1, 1) is the smallest.  Two right sides at once.
TEST(Dense, SmallestSolutions) {
  const MatrixXd A = MatrixXd::Ones(2, 2);
  MatrixXd B(2, 2);
  B << 2.0, -4.0, 2.0, -4.0;
  const MatrixXd X = dense_matrix::smallest_solutions(A, B);
  EXPECT_LT((X - (MatrixXd(2, 2) << 1.0, -2.0, 1.0, -2.0).finished()).cwiseAbs().maxCoeff(), 1e-14);
}

// The third column is the sum of the first two and the longest: one of these is found beside it.
TEST(Dense, DependentColumns) {
  MatrixXd A(4, 4);
  A << 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1e-3;
  const std::vector<Eigen::Index> columns = dense_matrix::dependent_columns(A, 1e-9);
  ASSERT_EQ(columns.size(), 1u);
  EXPECT_TRUE(columns[0] == 0 || columns[0] == 1);
  EXPECT_TRUE(dense_matrix::dependent_columns(MatrixXd::Identity(3, 3), 1e-9).empty());
}

// [[2, 1, 0], [1, 2, 0], [0, 0, 5]] has the values 1, 3, 5 and the axis (1, -1, 0) for the first.
TEST(Dense, EigensystemOfThree) {
  Matrix3d A;
  A << 2, 1, 0, 1, 2, 0, 0, 0, 5;
  const dense_matrix::EigensystemOf<3> system = dense_matrix::symmetric_eigensystem_3(A);
  EXPECT_NEAR(system.values[0], 1.0, 1e-14);
  EXPECT_NEAR(system.values[1], 3.0, 1e-14);
  EXPECT_NEAR(system.values[2], 5.0, 1e-14);
  EXPECT_NEAR(system.vectors(0, 0) + system.vectors(1, 0), 0.0, 1e-14);
  EXPECT_NEAR(system.vectors.col(0).norm(), 1.0, 1e-14);
}

}  // namespace
}  // namespace sage
