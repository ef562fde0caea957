// What an element of high degree leaves out, from what it has: against polynomials fitted to a known function.
#include "sage/analysis/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sage/math/dense.hpp"

namespace sage {
namespace {

// Places of n Gauss points.
Eigen::VectorXd gauss(int n) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  return dense_matrix::symmetric_eigensystem(jacobi).values;
}

// 1 / (a + xi): its Legendre parts fall by a + sqrt(a^2 - 1) from degree to degree.
TEST(LegendreParts, ShowTheErrorOfAFieldThatIsSingularOutside) {
  for (const double a : {1.35, 2.3, 4.0})
    for (const int n : {7, 9}) {
      const Eigen::VectorXd x = gauss(n);
      Eigen::VectorXd values(n * n), along(n);
      for (int i = 0; i < n; ++i) along[i] = 1.0 / (a + x[i]);
      for (int j = 0; j < n; ++j) values.segment(j * n, n) = along;
      // The error of the best polynomial of degree n - 2 (Chebyshev).
      const double b = std::sqrt(a * a - 1.0), rate = a - b;
      const double true_error = std::pow(rate, n - 2) / (b * b);
      const double found = LegendreParts(n).missing(values, {0.0, 0.0});
      EXPECT_GT(found, 0.15 * true_error) << "a " << a << " n " << n;
      EXPECT_LT(found, 3.0 * true_error) << "a " << a << " n " << n;
      EXPECT_GT(LegendreParts(n).missing(values, {-1.0, 0.0}), found) << "more at the ends";
    }
}

TEST(LegendreParts, LackNothingOfWhatTheDegreeHolds) {
  const int n = 9;
  const Eigen::VectorXd x = gauss(n);
  Eigen::VectorXd values(n * n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) values[j * n + i] = 1.0 + x[i] * x[i] * x[j];
  EXPECT_LT(LegendreParts(n).missing(values, {0.5, 0.5}), 1e-14);
}

}  // namespace
}  // namespace sage
