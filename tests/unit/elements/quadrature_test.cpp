// Each rule integrates all monomials up to its degree, and its points lie inside.
#include "sage/math/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sage {
namespace {

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

template <class Table>
void expect_triangle_degree(const Table& table, int degree) {
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j) {
      double sum = 0.0;
      for (const RulePoint& q : table) sum += q.w * std::pow(q.xi, i) * std::pow(q.eta, j);
      EXPECT_NEAR(sum, factorial(i) * factorial(j) / factorial(i + j + 2), 1e-16) << i << " " << j;
    }
  double beyond = 0.0;
  for (const RulePoint& q : table) {
    beyond += q.w * std::pow(q.xi, degree + 1);
    EXPECT_GT(std::min({q.xi, q.eta, 1.0 - q.xi - q.eta}), 0.0);
  }
  EXPECT_GT(std::abs(beyond * (degree + 2) * (degree + 3) - 1.0), 1e-6)
      << "the degree is not higher than stated";
}

TEST(TriangleRules, Degrees) {
  expect_triangle_degree(Triangle1::table, 1);
  expect_triangle_degree(Triangle3::table, 2);
  expect_triangle_degree(Triangle6::table, 4);
  expect_triangle_degree(Triangle12::table, 6);
  expect_triangle_degree(Triangle16::table, 8);
}

template <class Table>
void expect_line_degree(const Table& table, int degree) {
  for (int i = 0; i <= degree; ++i) {
    double sum = 0.0;
    for (const LinePoint& q : table) sum += q.w * std::pow(q.xi, i);
    EXPECT_NEAR(sum, i % 2 == 0 ? 2.0 / (i + 1) : 0.0, 1e-15) << i;
  }
}

TEST(GaussLines, Degrees) {
  expect_line_degree(GaussLine<1>::table, 1);
  expect_line_degree(GaussLine<2>::table, 3);
  expect_line_degree(GaussLine<3>::table, 5);
  expect_line_degree(GaussLine<4>::table, 7);
  expect_line_degree(GaussLine<5>::table, 9);
  expect_line_degree(GaussLine<6>::table, 11);
  expect_line_degree(GaussLine<7>::table, 13);
  expect_line_degree(GaussLine<8>::table, 15);
  expect_line_degree(GaussLine<9>::table, 17);
}

TEST(GaussSquares, ProductOfLines) {
  double sum = 0.0;
  for (const RulePoint& q : GaussSquare<3>::table) sum += q.w * std::pow(q.xi, 4) * std::pow(q.eta, 2);
  EXPECT_NEAR(sum, 2.0 / 5.0 * 2.0 / 3.0, 1e-15);
  EXPECT_LT(GaussSquare<2>::table[0].xi, GaussSquare<2>::table[1].xi) << "xi runs fastest";
  EXPECT_EQ(GaussSquare<2>::table[0].eta, GaussSquare<2>::table[1].eta);
}

// Rules of any size give the tables; folded onto the triangle they are exact to degree 2n - 2.
TEST(GaussLines, OfAnySize) {
  const std::vector<LinePoint> seven = gauss_line(7);
  for (std::size_t i = 0; i < seven.size(); ++i) {
    const LinePoint& wanted = GaussLine<7>::table[seven.size() - 1 - i];
    EXPECT_NEAR(seven[i].xi, wanted.xi, 1e-15);
    EXPECT_NEAR(seven[i].w, wanted.w, 1e-15);
  }
  for (const int n : {1, 4, 12}) {
    double area = 0.0;
    for (const RulePoint& q : gauss_area(false, n)) area += q.w;
    EXPECT_NEAR(area, 4.0, 1e-14);
    const int degree = 2 * n - 2;
    double top = 0.0;
    for (const RulePoint& q : gauss_area(true, n))
      top += q.w * std::pow(q.xi, degree / 2) * std::pow(q.eta, degree / 2);
    EXPECT_NEAR(top, factorial(degree / 2) * factorial(degree / 2) / factorial(degree + 2), 1e-15);
  }
}

}  // namespace
}  // namespace sage
