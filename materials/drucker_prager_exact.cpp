#include <cmath>

#include "materials/drucker_prager.hpp"
#include "materials/dual.hpp"

namespace sage {

// The increment taken at constant rate, beta = 0: elastic up to the cone, then R = |s| changes linearly
// while s turns towards the strain rate, tan(psi/2) = exp(-kappa) tan(psi0/2), kappa = 2 G |de| /
// logarithmic mean of R. Krieg & Krieg (1977), Loret & Prevost (1986), Szabo & Kossa (2012).  False where
// the formula doesn't apply.
bool DruckerPrager::integrate_exactly(const PointIn<4>& in, PointOut<4>& out) const {
  using Real = Dual<4>;
  using Tensor = Real[4];
  const auto [K, G] = p_.elastic;
  const auto [alpha, k] = p_.cone;
  const auto dot = [](const Tensor& a, const Tensor& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * a[3] * b[3];
  };

  // Start, and the elastic change of the whole increment: ds = 2 G de, and of the radius sqrt2 (k - 3 alpha p).
  const Vector4 s0 = deviator(in.sigma0);
  const double p0 = mean_stress(in.sigma0), R0 = std::sqrt(2.0) * (k - 3.0 * alpha * p0);
  const Vector4 change = 2.0 * G * deviatoric_projection() * in.deps;
  const Matrix4 dchange = 2.0 * G * deviatoric_projection();
  Tensor start, ds;
  for (int i = 0; i < 4; ++i) {
    start[i] = s0[i];
    ds[i] = Real(change[i], dchange.row(i).transpose());
  }
  const Real dp(K * unit_tensor().dot(in.deps), K * unit_tensor());
  const Real dR = -3.0 * std::sqrt(2.0) * alpha * dp;
  const Real length = sqrt(dot(ds, ds));
  if (!(length.v > kRounding * R0) || !(R0 + dR.v > kRounding * R0)) return false;

  // Share t of the increment until |s0 + t ds| = R0 + t dR.
  const Real a = dot(ds, ds) - dR * dR, b = dot(start, ds) - R0 * dR, c = dot(start, start) - R0 * R0;
  Real t = 0.0;
  if (c.v < -kRounding * R0 * R0 || b.v < 0.0) {
    const Real discriminant = b * b - a * c;
    if (!(discriminant.v > 0.0)) return false;
    const Real root = sqrt(discriminant);
    t = b.v > 0.0 ? -c / (b + root) : (root - b) / a;
    if (!(t.v >= 0.0 && t.v <= 1.0)) return false;
  }
  const Real R_start = R0 + t * dR, R_end = R0 + dR, ratio = R_end / R_start;
  const Real change_of_R = R_end - R_start;
  const Real mean_R = std::abs(ratio.v - 1.0) > 1e-5 ? change_of_R / log(ratio) : 0.5 * (R_start + R_end);
  const Real E = exp(-((1.0 - t) * length / mean_R));
  Tensor m;
  for (int i = 0; i < 4; ++i) m[i] = (start[i] + t * ds[i]) / R_start;
  const Real C = dot(m, ds) / length;
  const Real toward = ((1.0 - E) * (1.0 - E) * C + 1.0 - E * E) / length;
  const Real whole = (1.0 + E * E) + C * (1.0 - E * E);
  if (!(whole.v > 0.0)) return false;
  for (int i = 0; i < 4; ++i) {
    const Real s = R_end * (2.0 * E * m[i] + toward * ds[i]) / whole;
    const double on_diagonal = i < 3 ? 1.0 : 0.0;
    out.sigma[i] = s.v + on_diagonal * (p0 + dp.v);
    out.D.row(i) = (s.d + on_diagonal * dp.d).transpose();
  }
  out.status = PointStatus::yielded;
  return true;
}

}  // namespace sage
