#include "materials/hoek_brown.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/stress_measures.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

namespace {

// A place so near the tip is the tip: s1 and s3 there differ by a millionth of sigma_ci.
constexpr double kNearTip = 1e-6;
constexpr double kRounding = rounding::kSolution;
constexpr double kTipStiffness = 1e-7;  // share of D_elastic left where the true tangent is zero

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> r = elastic_rows();
    r.push_back(required("intact_strength", Dimension::stress,
                         "uniaxial compressive strength sigma_ci of the intact rock"));
    r.push_back(required("m_b", Dimension::none, "m_b of the rock mass"));
    r.push_back(required("s", Dimension::none, "s of the rock mass; 1 is intact, 0 without tension"));
    r.push_back(optional("a", Dimension::none, "exponent a, .5 to 1", 0.5));
    r.push_back(optional("flow", Dimension::none,
                         "0 no plastic volume change ... 1 associated: M - 1 = flow (N - 1) of the slopes",
                         0.0));
    r.push_back(optional("tension_cut_off", Dimension::stress, "largest tension; -1 = s sigma_ci/m_b", -1.0));
    return r;
  }();
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  HoekBrownStrength strength{};
  strength.sigma_ci = p.positive("intact_strength");
  strength.m = p.positive("m_b");
  strength.s = p.between("s", 0.0, 1.0);
  strength.a = p.between("a", 0.5, 1.0);
  strength.flow = p.between("flow", 0.0, 1.0);
  strength.T = strength.tip();
  if (p.number("tension_cut_off") != -1.0) strength.T = std::min(strength.T, p.not_negative("tension_cut_off"));
  return std::make_unique<HoekBrown>(elastic_parameters(p), strength);
}

struct Extremes {
  double s1, s3;
};
Extremes extremes(const Vector4& sigma) {
  const Principal s = principal(sigma);
  return {std::max(s.a, s.zz), std::min(s.b, s.zz)};
}

}  // namespace

double HoekBrownStrength::place(double s1) const {
  return std::pow(std::max(s - m * s1 / sigma_ci, 0.0), a);
}

// With u = x^(1/a) and stresses that count from the tip: s1 = -sigma_ci u/m, s3 = s1 - sigma_ci x, N = ds3/ds1 =
// 1 + a m u^(a-1), Y = N s1 - s3 = (1 - a) sigma_ci x.
MovingPlanes HoekBrownStrength::touching(double x) const {
  const double u = std::pow(x, 1.0 / a), above = a * m * x / u, N_rate = m * (a - 1.0) / u;
  return {{1.0 + above, (1.0 - a) * sigma_ci * x, 1.0 + flow * above, T - tip()},
          {N_rate, (1.0 - a) * sigma_ci, flow * N_rate, 0.0}};
}

// (s1 - s3)/strength, or s1/T if that is larger.  s1 is known to its rounding only, and so is the strength near
// the tip.
double HoekBrown::stress_level(const Vector4& sigma, std::span<const double> /*h*/) const {
  const auto [s1, s3] = extremes(sigma);
  const double nothing = kRounding * (std::abs(s1) + std::abs(s3) + strength_.tip());
  const double strength = strength_.sigma_ci * strength_.place(s1 - nothing), difference = s1 - s3;
  const double infinite = std::numeric_limits<double>::infinity();
  const bool at_tip = s1 <= strength_.tip() + nothing && difference <= strength_.sigma_ci * kNearTip;
  const double shear = s1 - nothing < strength_.tip() && strength > 0.0 ? difference / strength
                       : at_tip                                         ? 1.0
                                                                        : infinite;
  const double T = strength_.T;
  if (T >= strength_.tip()) return shear;
  const double tension = T > 0.0 ? s1 / T : s1 < -nothing ? 0.0 : s1 <= nothing ? 1.0 : infinite;
  return std::max(shear, tension);
}

bool HoekBrown::initialise(const Vector4& sigma, std::span<double> h) const {
  h[kShear] = h[kVolume] = 0.0;
  return stress_level(sigma, h) <= 1.0 + 1e-8;
}

bool HoekBrown::accepts_history(const Vector4& /*sigma*/, std::span<const double> h) const {
  return h[kShear] >= 0.0;
}

// Stresses count from the tip, where the slope has no end: what they differ by keeps its digits there.
HoekBrown::Attempt HoekBrown::attempt(const Vector4& trial, double x) const {
  const MovingPlanes moving = strength_.touching(x);
  const Vector4 tip = strength_.tip() * unit_tensor(), from_tip = trial - tip;
  Attempt a;
  if (outside(moving.planes, from_tip)) {
    a.moved = return_to_moving_planes(moving, elastic_, from_tip);
  } else {  // the planes of another place lie outside the criterion
    const Principal axes = principal(trial);
    const Matrix4 T_back = stress_from_principal_axes(axes.cos_2, -axes.sin_2);
    a.moved = {{from_tip, Matrix4::Identity(), PointStatus::elastic},
               Vector4::Zero(),
               T_back.row(axes.zz > axes.a ? 2 : 0).transpose()};
  }
  const double scale = strength_.sigma_ci / strength_.m, u = std::pow(x, 1.0 / strength_.a);
  a.lack = {a.moved.first.dot(a.moved.back.sigma) + scale * u,
            a.moved.first.dot(a.moved.rate) + scale / strength_.a * u / x};
  a.moved.back.sigma += tip;
  return a;
}

void HoekBrown::return_to_tip(const Vector4& trial, PointOut<4>& out) const {
  out.sigma = strength_.tip() * unit_tensor();
  out.D = kTipStiffness * D_elastic_;
  out.status = PointStatus::apex;
  out.h1[kShear] += sqrt_j2(trial) / elastic_.G;
  out.h1[kVolume] += mean_stress(trial - out.sigma) / elastic_.K;
}

// The planes that touch the criterion at the place where the stress comes back to: a return to planes, whose place
// is the zero of what it lacks.
Outcome HoekBrown::update(const PointIn<4>& in, PointOut<4>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  const Vector4 trial = in.sigma0 + D_elastic_ * in.deps;
  if (stress_level(trial, in.h0) <= 1.0 + 1e-12) {
    out.sigma = trial;
    out.D = D_elastic_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  const bool to_tip = strength_.T >= strength_.tip();
  const double low = to_tip ? kNearTip : std::max(strength_.place(strength_.T), kNearTip);
  const auto lack = [&](double x) { return attempt(trial, x).lack; };
  // Returns that end on the cut-off or at the tip have this s1 to rounding.
  const double nothing = 1e-10 * strength_.sigma_ci + 1e-11 * trial.cwiseAbs().maxCoeff();
  double x = low;
  if (lack(low).value >= -nothing) {
    if (to_tip) {
      return_to_tip(trial, out);
      return Outcome::ok;
    }
  } else {
    const double start = std::max(strength_.place(extremes(trial).s1), low);
    double high = std::max(2.0 * start, 1.0);
    for (int doubling = 0; doubling < 200 && lack(high).value < 0.0; ++doubling) high *= 2.0;
    x = rising_zero(lack, low, high, start, 1e-16 * high);
  }
  const Attempt last = attempt(trial, x);
  if (!(last.lack.slope > 0.0)) return Outcome::cut_step;
  const MohrCoulombReturn& back = last.moved.back;
  out.sigma = back.sigma;
  const Vector4 growth = -(back.R.transpose() * last.moved.first) / last.lack.slope;
  out.D = (back.R + last.moved.rate * growth.transpose()) * D_elastic_;
  out.status = back.status == PointStatus::yielded || back.status == PointStatus::elastic ? PointStatus::yielded
               : to_tip                                                                   ? PointStatus::apex
                        : PointStatus::cut_off;
  out.h1[kShear] += sqrt_j2(trial - back.sigma) / elastic_.G;
  out.h1[kVolume] += mean_stress(trial - back.sigma) / elastic_.K;
  return Outcome::ok;
}

MaterialEntry hoek_brown_entry() {
  return {"hoek_brown",       "Hoek-Brown for rock masses, elastic - perfectly plastic", 4, rows(), make,
          HoekBrown::kHistory};
}

}  // namespace sage
