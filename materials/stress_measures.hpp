// Invariants and principal values of [xx yy zz xy]; zz is always principal.  Tension positive.
#pragma once

#include <array>
#include <cmath>

#include "sage/core/four.hpp"
#include "sage/core/types.hpp"

namespace sage {

inline double mean_stress(const Vector4& sigma) {
  return (sigma[0] + sigma[1] + sigma[2]) / 3.0;
}

// Deviator with the tensor shear component in place 3.
inline Vector4 deviator(const Vector4& sigma) {
  const double p = mean_stress(sigma);
  return {sigma[0] - p, sigma[1] - p, sigma[2] - p, sigma[3]};
}

// a:b of two symmetric tensors in tensor components.
inline double contract(const Vector4& a, const Vector4& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * a[3] * b[3];
}

// sqrt(J2D)
inline double sqrt_j2(const Vector4& sigma) {
  const Vector4 s = deviator(sigma);
  return std::sqrt(0.5 * contract(s, s));
}

// Mean stress p, deviator s and q = sqrt(J2D) at once.
struct StressInvariants {
  Vector4 s;
  double p, q;
};
inline StressInvariants invariants(const Vector4& sigma) {
  const Vector4 s = deviator(sigma);
  return {s, mean_stress(sigma), std::sqrt(0.5 * contract(s, s))};
}

// The same of four stresses side by side.
using FourTensors = std::array<Four, 4>;
struct FourInvariants {
  FourTensors s;  // deviator
  Four p, q;      // mean stress, sqrt(J2D)
};
inline FourInvariants invariants(const FourTensors& sigma) {
  FourInvariants of;
  of.p = (sigma[0] + sigma[1] + sigma[2]) / 3.0;
  of.s = {sigma[0] - of.p, sigma[1] - of.p, sigma[2] - of.p, sigma[3]};
  const FourTensors& s = of.s;
  of.q = sqrt_of_four(0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * s[3] * s[3]));
  return of;
}

// Unit tensor, and I_dev such that I_dev eps is the deviator of eps, engineering shear in, tensor shear out.
inline Vector4 unit_tensor() {
  return {1.0, 1.0, 1.0, 0.0};
}
inline Matrix4 deviatoric_projection() {
  Matrix4 I = Matrix4::Zero();
  I.topLeftCorner<3, 3>().setConstant(-1.0 / 3.0);
  I.diagonal() << 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.5;
  return I;
}

// Principal stresses: a >= b in the plane, a at an angle from x whose double has (cos_2, sin_2); zz out of it.
struct Principal {
  double a, b, zz;
  double cos_2, sin_2;
};
inline Principal principal(const Vector4& sigma) {
  const double mean = 0.5 * (sigma[0] + sigma[1]), half = 0.5 * (sigma[0] - sigma[1]);
  const double radius =
      std::sqrt(half * half + sigma[3] * sigma[3]);  // faster than hypot; no stress overflows it
  const bool round = !(radius > 0.0);                // all directions are alike
  return {mean + radius, mean - radius, sigma[2], round ? 1.0 : half / radius, round ? 0.0 : sigma[3] / radius};
}

// [xx yy zz xy] = T [a b zz ab] for axes a, b turned by half the angle (cos_2, sin_2) from x, y.
inline Matrix4 stress_from_principal_axes(double cos_2, double sin_2) {
  const double c = 0.5 * (1.0 + cos_2), s = 0.5 * (1.0 - cos_2), cs = 0.5 * sin_2;  // cos^2, sin^2, cos sin
  Matrix4 T;
  T << c, s, 0.0, -sin_2, s, c, 0.0, sin_2, 0.0, 0.0, 1.0, 0.0, cs, -cs, 0.0, cos_2;
  return T;
}

}  // namespace sage
