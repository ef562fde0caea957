// Logarithmic (Hencky) strain of the plane and of rings: the tensors of elements under large strain.
// docs/theory/large_strain.md
#pragma once

#include "sage/core/types.hpp"

namespace sage {

// A deformation gradient less the unit tensor, or the gradient of a displacement.  ab: of component a along b; zz: hoop or
// out of plane.  Without the unit, small strains keep all their digits.
struct PlaneGradient {
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0, zz = 0.0;

  // det(1 + this) - 1
  double volume_change() const {
    const double area = xx + yy + xx * yy - xy * yx;
    return area + zz + area * zz;
  }
};

// (1 + next)(1 + first) - 1: first one deformation, then the other.
PlaneGradient followed_by(const PlaneGradient& first, const PlaneGradient& next);

// (1 + h)(1 + c)(1 + h)^T - 1.  Symmetric tensors here have the components [xx yy zz xy], without a factor at the shear.
Vector4 pushed_forward(const Vector4& c, const PlaneGradient& h);

// exp(2 e) - 1
Vector4 stretch_of(const Vector4& e);

// e = ln(1 + c)/2.  False where 1 + c is not positive definite.
bool half_log(const Vector4& c, Vector4& e);

// d(ln b)/2 for db = l b + b l^T, where e = ln(b)/2 has the differences `across` = e_xx - e_yy and `shear` = 2 e_xy:
// with engineering shear  de = sym(l) + (curve d - spin) turn,  d = turn . sym(l)/2,  spin = (l_xy - l_yx)/2.
struct LogRate {
  Vector4 turn;  // [-shear, shear, 0, 2 across]
  double curve;  // (x coth x - 1)/x^2 of x^2 = across^2 + shear^2

  explicit LogRate(const Vector4& e);
};

}  // namespace sage
