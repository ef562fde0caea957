// Assembly into compressed columns against a dense sum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sage/conformance/solver_systems.hpp"
#include "solvers/assembled_matrix.hpp"

namespace sage::test {

using namespace conformance;

namespace {

using Eigen::MatrixXd;

void add_all(AssembledMatrix& matrix, const System& system) {
  for (int e = 0; e < system.elements.count(); ++e) matrix.add(e, system.K[e].data());
}

void add_in_parts(AssembledMatrix& matrix, const System& system, int parts) {
  for (int part = parts - 1; part >= 0; --part)
    for (int e = 0; e < system.elements.count(); ++e) {
      const auto& K = system.K[e];
      matrix.add_part({e, 1, K.data(), static_cast<std::size_t>(K.size())}, part, parts);
    }
}

// The first assembly looks places up, later ones know them, and parts may be added in any order: the same sums to
// the last bit.
AssembledMatrix assemble(const System& system, bool symmetric) {
  AssembledMatrix matrix;
  matrix.analyse(make_equation_graph(system.equations, system.elements), system.elements, symmetric);
  add_all(matrix, system);
  const std::vector<double> first(matrix.value().begin(), matrix.value().end());
  for (int again = 0; again < 2; ++again) {
    matrix.clear();
    add_all(matrix, system);
    EXPECT_TRUE(std::ranges::equal(matrix.value(), first));
  }
  for (const int parts : {1, 2, 3, 7}) {
    matrix.clear();
    add_in_parts(matrix, system, parts);
    EXPECT_TRUE(std::ranges::equal(matrix.value(), first)) << parts << " parts";
  }
  return matrix;
}

MatrixXd dense(const AssembledMatrix& matrix) {
  MatrixXd A = MatrixXd::Zero(matrix.equations(), matrix.equations());
  for (int j = 0; j < matrix.equations(); ++j)
    for (auto k = matrix.column_start()[j]; k < matrix.column_start()[static_cast<std::size_t>(j) + 1]; ++k) {
      const int i = matrix.row()[static_cast<std::size_t>(k)];
      A(i, j) = matrix.value()[static_cast<std::size_t>(k)];
      if (matrix.symmetric()) A(j, i) = A(i, j);
    }
  return A;
}

// Random systems repeat equations within an element, as tied dofs do, and have prescribed ones.
TEST(AssembledMatrix, SumsElementMatrices) {
  for (const bool symmetric : {false, true})
    for (const unsigned seed : {1u, 2u, 3u}) {
      const System system = random_system(30, symmetric, seed);
      const MatrixXd expected = test::dense(system);
      // Sums of some twenty terms of size 20 in another order: rounding of 1e-14.
      EXPECT_LE((dense(assemble(system, symmetric)) - expected).cwiseAbs().maxCoeff(), 1e-12);
    }
}

// Four-node elements on a grid, two equations a node in a row but for supports and a node whose two are swapped:
// additions and row maxima then go by twos where they can.  The same numbers as one by one.
TEST(AssembledMatrix, EquationsInPairsAreSummedAsOthers) {
  constexpr int kColumns = 4, kRows = 3;
  System system;
  std::vector<int> first;
  for (int node = 0; node < (kColumns + 1) * (kRows + 1); ++node) {
    const bool held = node % (kColumns + 1) == 0;  // u of the left side
    first.push_back(held ? -1 : system.equations++);
    first.push_back(system.equations++);
    if (node == 7) std::swap(first[first.size() - 1], first[first.size() - 2]);
  }
  for (int e = 0; e < kColumns * kRows; ++e) {
    const int corner = e / kColumns * (kColumns + 1) + e % kColumns;
    std::vector<int> equations;
    for (const int node : {corner, corner + 1, corner + kColumns + 2, corner + kColumns + 1})
      for (const int i : {0, 1}) equations.push_back(first[2 * node + i]);
    MatrixXd K(8, 8);
    for (int i = 0; i < 64; ++i) K(i) = std::sin(1.0 + 3.7 * i * (e + 1)) * (i % 5 - 2);
    system.add_element(equations, K);
  }
  const MatrixXd expected = test::dense(system);
  const AssembledMatrix matrix = assemble(system, false);
  EXPECT_LE((dense(matrix) - expected).cwiseAbs().maxCoeff(), 1e-14);
  std::vector<double> maxima;
  matrix.row_maxima(maxima);
  const MatrixXd own = dense(matrix).cwiseAbs();
  for (int i = 0; i < system.equations; ++i) EXPECT_EQ(maxima[i], own.row(i).maxCoeff());
}

TEST(AssembledMatrix, ASymmetricOneReadsTheUpperTriangleOnly) {
  System system;
  system.equations = 2;
  MatrixXd K(2, 2);
  K << 2.0, 1.0, 77.0, 3.0;
  system.add_element({1, 0}, K);
  MatrixXd expected(2, 2);
  expected << 3.0, 1.0, 1.0, 2.0;
  EXPECT_EQ(dense(assemble(system, true)), expected);
}

// Both nodes of a bar on one rigid platen: K11 + K12 + K21 + K22 on one diagonal.
TEST(AssembledMatrix, TiedEquationsAddAllTheirTerms) {
  System system;
  system.equations = 1;
  MatrixXd K(2, 2);
  K << 5.0, -2.0, -2.0, 4.0;
  system.add_element({0, 0}, K);
  EXPECT_EQ(dense(assemble(system, true))(0, 0), 5.0);
  EXPECT_EQ(dense(assemble(system, false))(0, 0), 5.0);
}

TEST(AssembledMatrix, ClearKeepsThePattern) {
  const System system = random_system(12, false, 4);
  AssembledMatrix matrix = assemble(system, false);
  const auto terms = matrix.row().size();
  matrix.clear();
  EXPECT_EQ(dense(matrix), MatrixXd::Zero(12, 12));
  EXPECT_EQ(matrix.row().size(), terms);
}

TEST(AssembledMatrix, ColumnsAscendAndHoldTheDiagonal) {
  System system = random_system(25, false, 9);
  system.equations += 1;  // of no element
  const AssembledMatrix matrix = assemble(system, false);
  for (int j = 0; j < matrix.equations(); ++j) {
    bool diagonal = false;
    for (auto k = matrix.column_start()[j]; k < matrix.column_start()[static_cast<std::size_t>(j) + 1]; ++k) {
      diagonal |= matrix.row()[static_cast<std::size_t>(k)] == j;
      if (k > matrix.column_start()[j]) {
        EXPECT_LT(matrix.row()[static_cast<std::size_t>(k - 1)], matrix.row()[static_cast<std::size_t>(k)]);
      }
    }
    EXPECT_TRUE(diagonal);
  }
}

// Whole numbers: no sum is rounded.  Zeros stand before, behind and between.
TEST(AssembledMatrix, ProductsOfVectorsWithZeros) {
  System system;
  system.equations = 4;
  MatrixXd K(3, 3);
  K << 1, -7, 0, -7, 3, 4, 0, 4, 5;
  system.add_element({0, 1, 2}, K);
  system.add_element({1, 2, 3}, K);
  for (const bool symmetric : {false, true}) {
    const AssembledMatrix matrix = assemble(system, symmetric);
    const MatrixXd A = dense(matrix);
    for (int zeros = 0; zeros < 16; ++zeros) {
      Eigen::VectorXd x(4), y(4);
      for (int i = 0; i < 4; ++i) x[i] = (zeros >> i) % 2 == 1 ? 0.0 : 2.0 + i;
      matrix.multiply({x.data(), 4}, {y.data(), 4});
      EXPECT_EQ(y, A * x) << zeros;
    }
  }
}

TEST(AssembledMatrix, RowMaximaAndNorm) {
  System system;
  system.equations = 3;
  MatrixXd K(3, 3);
  K << 1, -7, 0, 2, 3, 4, -9, 0, 5;
  system.add_element({0, 1, 2}, K);
  const AssembledMatrix matrix = assemble(system, false);
  std::vector<double> maximum;
  matrix.row_maxima(maximum);
  EXPECT_EQ(maximum, (std::vector{7.0, 4.0, 9.0}));
  EXPECT_EQ(matrix.norm1(), 12.0);
  // Upper triangle mirrored: [[1 -7 0] [-7 3 4] [0 4 5]].
  const AssembledMatrix symmetric = assemble(system, true);
  symmetric.row_maxima(maximum);
  EXPECT_EQ(maximum, (std::vector{7.0, 7.0, 5.0}));
  EXPECT_EQ(symmetric.norm1(), 14.0);
}

}  // namespace
}  // namespace sage::test
