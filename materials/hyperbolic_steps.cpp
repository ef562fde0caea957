#include "materials/hyperbolic_steps.hpp"

#include <algorithm>
#include <cmath>

#include "materials/stress_measures.hpp"

namespace sage {

namespace {

constexpr int kMostSubsteps = 300;
constexpr int kEnvelopeIterations = 25;
constexpr double kEnvelopeTolerance = 1e-11;

// A stress on the way through the step, and its derivative with respect to the whole increment deps.
struct Point {
  Vector4 sigma;
  Matrix4 J;
  PointStatus status = PointStatus::elastic;
};

// Moduli there, and theirs.
struct Stiffness {
  ElasticModuli moduli;
  Vector4 dK, dG;
  bool unloading;
};

struct Memory {
  double value;
  Vector4 d;
};

Stiffness stiffness(const HyperbolicSteps& steps, const Point& at, const Memory& memory) {
  const Extremes s = extremes(at.sigma, steps.in_plane);
  const HyperbolicModuli law = hyperbolic_moduli(steps.moduli, s.sigma_1, s.sigma_3, memory.value);
  const auto chain = [&](const HyperbolicReal& x) -> Vector4 {
    const Vector4 by_stress = x.d[0] * s.gradient_1 + x.d[1] * s.gradient_3;
    return at.J.transpose() * by_stress + x.d[2] * memory.d;
  };
  return {{law.K.v, law.G.v}, chain(law.K), chain(law.G), law.unloading};
}

Stiffness mean(const Stiffness& a, const Stiffness& b) {
  return {{0.5 * (a.moduli.K + b.moduli.K), 0.5 * (a.moduli.G + b.moduli.G)},
          0.5 * (a.dK + b.dK),
          0.5 * (a.dG + b.dG),
          b.unloading};
}

Memory remember(const HyperbolicSteps& steps, const Memory& memory, const Point& at) {
  const Extremes s = extremes(at.sigma, steps.in_plane);
  const HyperbolicReal now = stress_state(steps.moduli, s.sigma_1, s.sigma_3);
  if (now.v <= memory.value) return memory;
  return {now.v, at.J.transpose() * (now.d[0] * s.gradient_1 + now.d[1] * s.gradient_3)};
}

// Back to the envelope if the trial is beyond it.  The envelope is curved when phi depends on sigma_3: Newton
// on its tangent planes, and the last plane makes the derivative exact.
MohrCoulombReturn bounded(const HyperbolicSteps& steps, const ElasticModuli& moduli, const Vector4& trial) {
  MohrCoulombReturn back{trial, Matrix4::Identity(), PointStatus::elastic};
  if (!steps.bounded) return back;
  for (int i = 0; i < kEnvelopeIterations; ++i) {
    const double sigma_3 = extremes(back.sigma, false).sigma_3;
    const MohrCoulombPlanes planes = tangent_planes(steps, sigma_3);
    if (i == 0 && !outside(planes, trial)) return back;
    back = return_to_planes(planes, moduli, trial);
    const Extremes now = extremes(back.sigma, false);
    const double change = std::abs(now.sigma_3 - sigma_3);
    if (steps.moduli.dphi == 0.0 || change <= kEnvelopeTolerance * (now.sigma_1 + std::abs(now.sigma_3))) break;
  }
  return back;
}

// One substep d = share * deps with given moduli: trial, return, and the derivative of both.
//   sigma_tr = sigma + D d,  sigma = sigma_tr - D eps_p,  d sigma = R (d sigma_tr - dD eps_p)
Point move(const HyperbolicSteps& steps, const Point& from, const Stiffness& k, const Vector4& d,
           double share) {
  const Matrix4 D = elastic_matrix(k.moduli);
  const Vector4 trial = from.sigma + D * d;
  const Vector4 one = unit_tensor();
  const double volume = one.dot(d);
  const Vector4 shear = 2.0 * (deviatoric_projection() * d);
  Matrix4 J = from.J + share * D + volume * one * k.dK.transpose() + shear * k.dG.transpose();

  const MohrCoulombReturn back = bounded(steps, k.moduli, trial);
  if (back.status == PointStatus::elastic) return {trial, J, back.status};
  const Vector4 removed = trial - back.sigma;
  J -= mean_stress(removed) / k.moduli.K * one * k.dK.transpose();
  J -= deviator(removed) / k.moduli.G * k.dG.transpose();
  return {back.sigma, back.R * J, back.status};
}

struct Run {
  HyperbolicAnswer answer;
  double error;  // largest estimate of a substep, relative
};

Run run(const HyperbolicSteps& steps, const Vector4& sigma0, const Vector4& deps, double memory0,
        int substeps) {
  const double share = 1.0 / substeps;
  const Vector4 d = share * deps;
  const double smallest_stress = steps.moduli.floor * steps.moduli.p_a;
  Point at{sigma0, Matrix4::Zero()};
  Memory memory{memory0, Vector4::Zero()};
  Matrix4 D = Matrix4::Zero();
  bool unloading = false;
  double error = 0.0;
  for (int i = 0; i < substeps; ++i) {
    const Stiffness start = stiffness(steps, at, memory);
    const Point euler = move(steps, at, start, d, share);
    const Stiffness both = mean(start, stiffness(steps, euler, memory));
    at = move(steps, at, both, d, share);  // Heun
    error = std::max(error, (at.sigma - euler.sigma).norm() / std::max(at.sigma.norm(), smallest_stress));
    memory = remember(steps, memory, at);
    unloading = both.unloading;
    D += share * elastic_matrix(both.moduli);
  }
  if (at.status == PointStatus::elastic && extremes(at.sigma, steps.in_plane).sigma_3 < 0.0)
    at.status = PointStatus::apex;
  if (at.status == PointStatus::elastic && unloading) at.status = PointStatus::unloading;
  return {{at.sigma, at.J, D, memory.value, at.status, true}, error};
}

}  // namespace

Extremes extremes(const Vector4& sigma, bool in_plane) {
  const Principal s = principal(sigma);
  const double c = s.cos, n = s.sin;
  const Vector4 along_a{c * c, n * n, 0.0, 2.0 * c * n}, along_b{n * n, c * c, 0.0, -2.0 * c * n};
  const Vector4 along_zz = Vector4::Unit(2);
  const bool zz_largest = !in_plane && s.zz < s.b, zz_smallest = !in_plane && s.zz > s.a;
  return {zz_largest ? -s.zz : -s.b, zz_smallest ? -s.zz : -s.a, zz_largest ? -along_zz : -along_b,
          zz_smallest ? -along_zz : -along_a};
}

MohrCoulombPlanes tangent_planes(const HyperbolicSteps& steps, double sigma_3) {
  const double at = std::max(sigma_3, steps.moduli.floor * steps.moduli.p_a);
  const HyperbolicReal q_f = deviator_strength(steps.moduli, HyperbolicReal::variable(at, 1));
  const double N = 1.0 + q_f.d[1];
  return {N, at + q_f.v - N * at, steps.M, steps.T};
}

HyperbolicAnswer integrate(const HyperbolicSteps& steps, const Vector4& sigma0, const Vector4& deps,
                           double memory) {
  int substeps = 1;
  for (;;) {
    Run r = run(steps, sigma0, deps, memory, substeps);
    if (deps.isZero(0.0)) r.answer.memory = memory;
    if (r.error <= steps.tolerance || substeps == kMostSubsteps || !std::isfinite(r.error)) {
      r.answer.accurate = r.error <= steps.tolerance;
      return r.answer;
    }
    // The estimate falls with the square of the substep.
    const double wanted = std::ceil(1.2 * substeps * std::sqrt(r.error / steps.tolerance));
    substeps = static_cast<int>(std::min(std::max(wanted, substeps + 1.0), static_cast<double>(kMostSubsteps)));
  }
}

}  // namespace sage
