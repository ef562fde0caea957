// Dense decompositions against what defines their answers.
#include "sage/math/dense.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

// Rows (0, 0, 0), (1, 2, 0) and (0, 0, 3) have the columns 0, (1, 2, 0) / 5 and (0, 0, 1/3) as their inverse.
TEST(Dense, PseudoInverseOfRankTwo) {
  Matrix3d A, expected;
  A << 0, 0, 0, 1, 2, 0, 0, 0, 3;
  expected << 0, 0.2, 0, 0, 0.4, 0, 0, 0, 1.0 / 3.0;
  EXPECT_LT((dense_matrix::pseudo_inverse(A) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

// 2 y = 3 and 2 y = -8, with any x: the smallest answers have x = 0.
TEST(Dense, SmallestSolutions) {
  MatrixXd A(2, 2), B(2, 2), expected(2, 2);
  A << 0.0, 2.0, 0.0, 0.0;
  B << 3.0, -8.0, 0.0, 0.0;
  expected << 0.0, 0.0, 1.5, -4.0;
  EXPECT_LT((dense_matrix::smallest_solutions(A, B) - expected).cwiseAbs().maxCoeff(), 1e-14);
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
