// Logarithmic (Hencky) strain of the plane and of rings: the tensors of elements under large strain.  Real: double, or Four
// for four points (abreast.hpp).  docs/theory/large_strain.md
#pragma once

#include "elements/abreast.hpp"

namespace sage {

// A deformation gradient less the unit tensor, or the gradient of a displacement.  ab: of component a along b; zz: hoop or
// out of plane.  Without the unit, small strains keep all their digits.
template <class Real>
struct PlaneGradient {
  Real xx{}, xy{}, yx{}, yy{}, zz{};

  // det(1 + this) - 1
  Real volume_change() const {
    const Real area = xx + yy + xx * yy - xy * yx;
    return area + zz + area * zz;
  }
};

// (1 + next)(1 + first) - 1: first one deformation, then the other.
template <class Real>
PlaneGradient<Real> followed_by(const PlaneGradient<Real>& first, const PlaneGradient<Real>& next) {
  const PlaneGradient<Real>&a = first, &b = next;
  return {a.xx + b.xx + b.xx * a.xx + b.xy * a.yx, a.xy + b.xy + b.xx * a.xy + b.xy * a.yy,
          a.yx + b.yx + b.yx * a.xx + b.yy * a.yx, a.yy + b.yy + b.yx * a.xy + b.yy * a.yy,
          a.zz + b.zz + a.zz * b.zz};
}

// (1 + h)(1 + c)(1 + h)^T - 1.  Symmetric tensors here have the components [xx yy zz xy], without a factor at the shear.
template <class Real>
Tensor<Real> pushed_forward(const Tensor<Real>& c, const PlaneGradient<Real>& h) {
  // h b, b = 1 + c
  const Real b_xx = 1.0 + c[0], b_yy = 1.0 + c[1], b_xy = c[3];
  const Real xx = h.xx * b_xx + h.xy * b_xy, xy = h.xx * b_xy + h.xy * b_yy;
  const Real yx = h.yx * b_xx + h.yy * b_xy, yy = h.yx * b_xy + h.yy * b_yy;
  return {c[0] + 2.0 * xx + xx * h.xx + xy * h.xy, c[1] + 2.0 * yy + yx * h.yx + yy * h.yy,
          c[2] + (1.0 + c[2]) * h.zz * (2.0 + h.zz), c[3] + xy + yx + xx * h.yx + xy * h.yy};
}

// exp(2 e) - 1
template <class Real>
Tensor<Real> stretch_of(const Tensor<Real>& e) {
  const Real one = everywhere<Real>(1.0);
  const Real across = e[0] - e[1], shear = 2.0 * e[3], x = root(across * across + shear * shear);
  const Real low = exp_less_1(e[0] + e[1] - x);
  const Real slope = (1.0 + low) * (x > 0.0 ? exp_less_1(2.0 * x) / (2.0 * x) : one);
  const Real mean = low + slope * x;
  return {mean + slope * across, mean - slope * across, exp_less_1(2.0 * e[2]), slope * shear};
}

// e = ln(1 + c)/2.  False where 1 + c is not positive definite.
template <class Real>
bool half_log(const Tensor<Real>& c, Tensor<Real>& e) {
  const Real across = 0.5 * (c[0] - c[1]), r = root(across * across + c[3] * c[3]),
             low = 0.5 * (c[0] + c[1]) - r;
  if (!holds_everywhere(low > -1.0) || !holds_everywhere(c[2] > -1.0)) return false;
  const Real slope = r > 0.0 ? log_1_plus(2.0 * r / (1.0 + low)) / (2.0 * r) : 1.0 / (1.0 + low);
  const Real mean = log_1_plus(low) + slope * r;
  e = {0.5 * (mean + slope * across), 0.5 * (mean - slope * across), 0.5 * log_1_plus(c[2]),
       0.5 * slope * c[3]};
  return true;
}

// d(ln b)/2 for db = l b + b l^T, where e = ln(b)/2 has the differences `across` = e_xx - e_yy and `shear` = 2 e_xy:
// with engineering shear  de = sym(l) + (curve d - spin) turn,  d = turn . sym(l)/2,  spin = (l_xy - l_yx)/2.
template <class Real>
struct LogRate {
  Tensor<Real> turn;  // [-shear, shear, 0, 2 across]
  Real curve;         // (x coth x - 1)/x^2 of x^2 = across^2 + shear^2

  explicit LogRate(const Tensor<Real>& e) {
    const Real across = e[0] - e[1], shear = 2.0 * e[3], x2 = across * across + shear * shear;
    turn = {-shear, shear, Real{}, 2.0 * across};
    const Real near_0 =
        1.0 / 3 -
        x2 * (1.0 / 45 - x2 * (2.0 / 945 - x2 * (1.0 / 4725 - x2 * (2.0 / 93555 - x2 * (1382.0 / 638512875)))));
    const auto near = x2 < 0.01;
    curve = near_0;
    if (holds_everywhere(near)) return;
    const Real x = root(x2), growth = exp_less_1(2.0 * x);
    curve = near ? near_0 : (x * (2.0 + growth) / growth - 1.0) / x2;
  }
};

}  // namespace sage
