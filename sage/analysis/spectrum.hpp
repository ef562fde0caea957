// Legendre parts of a field at the Gauss points of a quadrilateral of high degree: how they fall shows what the degree
// leaves out.
#pragma once

#include <Eigen/Core>

#include "sage/core/types.hpp"

namespace sage {

// Eigenvectors of the Jacobi matrix of n Gauss points (Golub & Welsch 1969): row i holds +-sqrt(w) times the
// orthonormal Legendre polynomial of degree i at each point, the sign that of row 0.
Eigen::MatrixXd legendre_at_gauss(int n);

class LegendreParts {
 public:
  // Of fields at n x n Gauss points, xi fastest.
  explicit LegendreParts(int n);

  // About the most by which the field lacks, around a place of the parent square, what lies above degree n - 2: the
  // highest degree that the stress of an element of degree n - 1 has in full.  Taken from the parts of the four degrees
  // below, as the rest of a geometric series.
  double missing(const Eigen::Ref<const Eigen::VectorXd>& values, const Vector2& place) const;

 private:
  int n_;
  Eigen::MatrixXd transform_;  // degree x point
};

}  // namespace sage
