#include "materials/hyperbolic_steps.hpp"

#include <algorithm>
#include <cmath>

#include "materials/dual.hpp"
#include "materials/stress_measures.hpp"

namespace sage {

namespace {

constexpr int kMostSubsteps = 300;
constexpr int kMostTrials = 6;       // lengths tried for one substep
constexpr double kWorstError = 4.0;  // of a substep that the trials could not bring to its tolerance
constexpr int kCrossingIterations = 30;
constexpr double kOnSurface = 1e-9;  // relative distance to the envelope
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
  const HyperbolicModuli law =
      hyperbolic_moduli(steps.moduli, s.sigma_1, s.sigma_3, memory.value, -mean_stress(at.sigma));
  const auto chain = [&](const HyperbolicReal& x) -> Vector4 {
    const Vector4 by_stress = x.d[0] * s.gradient_1 + x.d[1] * s.gradient_3;
    return at.J.transpose() * by_stress + x.d[2] * memory.d;
  };
  Stiffness k{{law.K.v, law.G.v}, chain(law.K), chain(law.G), law.unloading};
  if (steps.moduli.volume == VolumeRule::bulk_selig) {
    const Vector4 by_mean = at.J.transpose() * unit_tensor() / -3.0;
    k.dK += law.dK_mean * by_mean;
    k.dG += law.dG_mean * by_mean;
  }
  return k;
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

// Share of deps in a substep, and its derivative with respect to deps.
using Share = Dual<4>;

// One substep d = share * deps with given moduli: trial, return, and the derivative of both.
//   sigma_tr = sigma + D d,  sigma = sigma_tr - D eps_p,  d sigma = R (d sigma_tr - dD eps_p)
Point move(const HyperbolicSteps& steps, const Point& from, const Stiffness& k, const Vector4& deps,
           const Share& share, bool within_surface) {
  const Matrix4 D = elastic_matrix(k.moduli);
  const Vector4 d = share.v * deps, along = D * deps;
  const Vector4 trial = from.sigma + share.v * along;
  const Vector4 one = unit_tensor();
  const double volume = one.dot(d);
  const Vector4 shear = 2.0 * (deviatoric_projection() * d);
  Matrix4 J = from.J + share.v * D + along * share.d.transpose() + volume * one * k.dK.transpose() +
              shear * k.dG.transpose();

  if (!within_surface) return {trial, J, PointStatus::elastic};
  const MohrCoulombReturn back = bounded(steps, k.moduli, trial);
  if (back.status == PointStatus::elastic) return {trial, J, back.status};
  const Vector4 removed = trial - back.sigma;
  J -= mean_stress(removed) / k.moduli.K * one * k.dK.transpose();
  J -= deviator(removed) / k.moduli.G * k.dG.transpose();
  return {back.sigma, back.R * J, back.status};
}

struct Heun {
  Point end;
  ElasticModuli moduli;
  bool unloading;
  Share error;  // of its Euler half, before the return, in tolerances
};

// |a| of a stress as a tensor, the same in all axes: shear counts twice.
double length(const Vector4& a) {
  return std::sqrt(contract(a, a));
}

// With its derivative.
Share length(const Vector4& a, const Matrix4& da) {
  const double norm = length(a);
  if (!(norm > 0.0)) return norm;
  return {norm, da.transpose() * Vector4(a[0], a[1], a[2], 2.0 * a[3]) / norm};
}

// The error is taken before the return: two stresses far apart may return to the same point, the apex say.
Heun heun(const HyperbolicSteps& steps, const Point& from, const Stiffness& start, const Memory& memory,
          const Vector4& deps, const Share& share, bool within_surface) {
  const Point euler = move(steps, from, start, deps, share, within_surface);
  const Stiffness both = mean(start, stiffness(steps, euler, memory));
  const Point end = move(steps, from, both, deps, share, within_surface);
  const Vector4 one = unit_tensor(), volume = one.dot(deps) * one,
                shear = 2.0 * (deviatoric_projection() * deps);
  const Vector4 change = (both.moduli.K - start.moduli.K) * volume + (both.moduli.G - start.moduli.G) * shear;
  const Matrix4 d_change = volume * (both.dK - start.dK).transpose() +
                           shear * (both.dG - start.dG).transpose() +
                           elastic_matrix({both.moduli.K - start.moduli.K, both.moduli.G - start.moduli.G});
  const Share size = max(length(end.sigma, end.J), Share(steps.moduli.floor * steps.moduli.p_a));
  return {end, both.moduli, both.unloading, share * length(change, d_change) / (steps.tolerance * size)};
}

// sigma_1 - sigma_3 beyond the envelope.
Share excess(const HyperbolicSteps& steps, const Point& at) {
  const Extremes s = extremes(at.sigma, false);
  const MohrCoulombPlanes planes = tangent_planes(steps, s.sigma_3);
  return {s.sigma_1 - planes.N * s.sigma_3 - planes.Y,
          at.J.transpose() * (s.gradient_1 - planes.N * s.gradient_3)};
}

bool inside(const HyperbolicSteps& steps, const Point& at) {
  const Extremes s = extremes(at.sigma, false);
  return excess(steps, at).v < -kOnSurface * (std::abs(s.sigma_1) + steps.moduli.floor * steps.moduli.p_a);
}

// The part of a substep that ends on the envelope: regula falsi (Illinois) between its two ends.  [Sloan 1987]
template <class Excess>
Share crossing(const Excess& beyond, double share, double at_start, double at_end) {
  double a = 0.0, fa = at_start, b = share, fb = at_end, x = share;
  const double close = kOnSurface * std::abs(at_end - at_start);
  for (int i = 0; i < kCrossingIterations; ++i) {
    x = (a * fb - b * fa) / (fb - fa);
    const double f = beyond(x).v;
    if (std::abs(f) <= 1e-3 * close) break;
    if (f * fb < 0.0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = x;
    fb = f;
  }
  const double h = 1e-5 * x;
  const double slope = (beyond(x + h).v - beyond(x - h).v) / (2.0 * h);
  return {x, -beyond(x).d / slope};
}

// Factor on the length of a substep with this error.  1 at the tolerance and continuous, since the stress must
// not jump when deps changes a little: Newton on a mesh would not settle there.
Share shortened(const Share& error) {
  return 1.0 / (sqrt(error) * (0.75 + 0.25 * min(error, Share(2.0))));
}

}  // namespace

Extremes extremes(const Vector4& sigma, bool in_plane) {
  const Principal s = principal(sigma);
  const double c = 0.5 * (1.0 + s.cos_2), n = 0.5 * (1.0 - s.cos_2);  // cos^2, sin^2
  const Vector4 along_a{c, n, 0.0, s.sin_2}, along_b{n, c, 0.0, -s.sin_2};
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

double path_error(const HyperbolicSteps& steps, const PointIn<4>& in, const Vector4& sigma, double memory0,
                  double memory1) {
  const auto moduli = [&](const Vector4& at, double memory) {
    const Extremes s = extremes(at, steps.in_plane);
    const HyperbolicModuli law =
        hyperbolic_moduli(steps.moduli, s.sigma_1, s.sigma_3, memory, -mean_stress(at));
    const bool flows = steps.bounded && !inside(steps, {at, Matrix4::Zero()});
    return ElasticModuli{law.K.v, flows ? 0.0 : law.G.v};
  };
  const ElasticModuli start = moduli(in.sigma0, memory0), end = moduli(sigma, memory1);
  const double lag_K = 0.25 * (end.K - start.K) / (end.K + start.K);
  const double lag_G = start.G + end.G > 0.0 ? 0.25 * (end.G - start.G) / (end.G + start.G) : 0.0;
  const double lag = std::max(std::abs(lag_K), std::abs(lag_G));
  const double size = std::max(length(sigma), steps.moduli.floor * steps.moduli.p_a);
  return 3.0 * lag * lag * length(sigma - in.sigma0) / size;
}

// The lengths of the substeps are continuous functions of deps, and so is the stress: the last substep is what
// remains, and comes into being with length zero.
HyperbolicAnswer integrate(const HyperbolicSteps& steps, const Vector4& sigma0, const Vector4& deps,
                           double memory0) {
  Point at{sigma0, Matrix4::Zero()};
  Memory memory{memory0, Vector4::Zero()};
  Matrix4 D = Matrix4::Zero();
  bool unloading = false;
  Share remaining = 1.0, next = 1.0;
  int substeps = 0;
  while (substeps < kMostSubsteps && remaining.v > 0.0) {
    const Stiffness start = stiffness(steps, at, memory);
    Share share = min(next, remaining);
    const auto advance = [&](const Share& part, bool bounded) {
      return heun(steps, at, start, memory, deps, part, bounded);
    };
    Heun step = advance(share, steps.bounded);
    for (int trial = 1; trial < kMostTrials && step.error.v > 1.0; ++trial) {
      share = share * shortened(step.error);
      step = advance(share, steps.bounded);
    }
    if (!(step.error.v <= kWorstError)) break;
    next = share * (0.8 / sqrt(max(step.error, Share(0.04))));  // at most 4 times as long
    if (step.end.status != PointStatus::elastic && inside(steps, at)) {
      const auto beyond = [&](double part) { return excess(steps, advance(part, false).end); };
      const double end = beyond(share.v).v;
      if (end > 0.0) {
        share = crossing(beyond, share.v, excess(steps, at).v, end);
        step = advance(share, false);
        step.end.status = PointStatus::yielded;
      }
    }
    remaining = share.v < remaining.v ? remaining - share : Share(0.0);
    at = step.end;
    memory = remember(steps, memory, at);
    unloading = step.unloading;
    D += share.v * elastic_matrix(step.moduli);
    ++substeps;
  }
  if (at.status == PointStatus::elastic && extremes(at.sigma, steps.in_plane).sigma_3 < 0.0)
    at.status = PointStatus::cut_off;
  if (at.status == PointStatus::elastic && unloading) at.status = PointStatus::unloading;
  const double memory1 = deps.isZero(0.0) ? memory0 : memory.value;
  return {at.sigma, at.J, D, memory1, at.status, !(remaining.v > 0.0)};
}

}  // namespace sage
