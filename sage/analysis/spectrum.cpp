#include "sage/analysis/spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "sage/math/dense.hpp"

namespace sage {

namespace {

// Largest value near t of the orthonormal Legendre polynomial of a degree.
double amplitude(double t, int degree) {
  const double ends = std::sqrt(degree + 0.5), off = 1.0 - t * t;
  return off > 0.0 ? std::min(ends, 0.8 * std::pow(off, -0.25)) : ends;
}

}  // namespace

Eigen::MatrixXd legendre_at_gauss(int n) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  return dense_matrix::symmetric_eigensystem(jacobi).vectors;
}

LegendreParts::LegendreParts(int n) : n_(n) {
  const Eigen::MatrixXd Q = legendre_at_gauss(n);
  transform_ = std::sqrt(2.0) * Q * Q.row(0).asDiagonal();
}

double LegendreParts::missing(const Eigen::Ref<const Eigen::VectorXd>& values, const Vector2& place) const {
  constexpr double kSlowest = 0.9;  // of a degree to the next
  const Eigen::MatrixXd parts =
      transform_ * Eigen::Map<const Eigen::MatrixXd>(values.data(), n_, n_) * transform_.transpose();
  const auto band = [&](int degree) {  // root of the squares of all parts with that degree in xi or eta
    const double row = parts.row(degree).head(degree + 1).squaredNorm(),
                 column = parts.col(degree).head(degree).squaredNorm();
    return std::sqrt(row + column);
  };
  const int top = n_ - 2;
  const double high = std::max(band(top), band(top - 1)), low = std::max(band(top - 2), band(top - 3));
  if (high == 0.0) return 0.0;
  const double rate = std::min(kSlowest, std::sqrt(high / std::max(low, high)));
  const double rest = std::max(band(top), rate * band(top - 1)) * rate / (1.0 - rate);
  return rest * std::sqrt(0.5) * std::max(amplitude(place.x(), n_ - 1), amplitude(place.y(), n_ - 1));
}

}  // namespace sage
