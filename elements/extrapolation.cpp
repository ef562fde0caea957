#include "elements/extrapolation.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace sage {

namespace {

// Products of Legendre polynomials of degrees 0 ... terms - 1: nearly orthogonal over Gauss points, so that the
// normal equations of the fit stay well-conditioned.
Eigen::MatrixXd tensor_terms(std::span<const ParentPoint> at, int terms) {
  Eigen::MatrixXd V(static_cast<Eigen::Index>(at.size()), terms * terms);
  for (Eigen::Index i = 0; i < V.rows(); ++i)
    for (int a = 0; a < terms; ++a)
      for (int b = 0; b < terms; ++b)
        V(i, a * terms + b) = std::legendre(static_cast<unsigned>(a), at[i][0]) *
                              std::legendre(static_cast<unsigned>(b), at[i][1]);
  return V;
}

// One row a position, one column a term.  points: of the rule.
Eigen::MatrixXd terms(std::span<const ParentPoint> at, Basis basis, std::size_t points) {
  const int line = static_cast<int>(std::lround(std::sqrt(static_cast<double>(points))));
  if (basis == Basis::tensor || basis == Basis::tensor_lower)
    return tensor_terms(at, basis == Basis::tensor ? line : line - 1);
  static constexpr int kTerms[] = {1, 2, 3, 3, 4, 6};
  Eigen::MatrixXd V(static_cast<Eigen::Index>(at.size()), kTerms[static_cast<int>(basis)]);
  for (Eigen::Index i = 0; i < V.rows(); ++i) {
    const auto [x, y] = at[i];
    switch (basis) {
      case Basis::constant:
        V.row(i) << 1.0;
        break;
      case Basis::line_linear:
        V.row(i) << 1.0, x;
        break;
      case Basis::line_quadratic:
        V.row(i) << 1.0, x, x * x;
        break;
      case Basis::linear:
        V.row(i) << 1.0, x, y;
        break;
      case Basis::bilinear:
        V.row(i) << 1.0, x, y, x * y;
        break;
      case Basis::quadratic:
        V.row(i) << 1.0, x, y, x * x, x * y, y * y;
        break;
      case Basis::tensor:
      case Basis::tensor_lower:
        break;
    }
  }
  return V;
}

}  // namespace

// E = V_nodes (V^T V)^-1 V^T
std::vector<double> extrapolation_matrix(std::span<const ParentPoint> points,
                                         std::span<const ParentPoint> nodes, Basis basis) {
  const Eigen::MatrixXd V = terms(points, basis, points.size());
  const Eigen::MatrixXd normal = V.transpose() * V;
  const Eigen::MatrixXd fit = normal.ldlt().solve(V.transpose());
  const Eigen::MatrixXd E = terms(nodes, basis, points.size()) * fit;
  std::vector<double> rows(nodes.size() * points.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(rows.data(), E.rows(),
                                                                                     E.cols()) = E;
  return rows;
}

}  // namespace sage
