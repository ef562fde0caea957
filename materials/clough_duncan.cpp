#include "materials/clough_duncan.hpp"

#include <cmath>
#include <limits>

#include "sage/math/rounding.hpp"

namespace sage {

namespace {

constexpr double kRounding =
    rounding::kStrength;  // relative to the strength: below this a stress is on the surface
// A gap is rounding of a joint without stress if this share of the largest shear stress, or of the stress
// floor, would close it.
constexpr double kNoGap = 1e-5, kNoGapOfFloor = 1e-2;
// Of the stiffness of contact, in the tangent of open joints that keep a share in slip: enough for a body that floats
// between them for an iteration, and nothing beside any soil.
constexpr double kOpenTangent = 1e-11;
// Rule 0 has one stiffness for a whole increment: a joint this close to its memory loads.  After slip the
// stress is the strength, which falls by rounding too (1e-11 with a stiff k_nc).
constexpr double kOnMemory = 1e-6;

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("cohesion", Dimension::stress, "adhesion c", ParameterRole::strength),
      required("friction_angle", Dimension::angle, "friction angle phi", ParameterRole::friction_angle),
      required("tensile_strength", Dimension::stress, "tensile strength sigma_t", ParameterRole::strength),
      required("failure_ratio", Dimension::none, "reduction factor R_f; 0 is linear until slip"),
      required("stiffness_number", Dimension::none, "shear stiffness coefficient k_j"),
      required("stiffness_exponent", Dimension::none, "exponent n"),
      required("compressive_stiffness", Dimension::stress_per_length, "normal stiffness in compression k_nc"),
      required("tensile_stiffness", Dimension::stress_per_length, "normal stiffness in tension k_nt"),
      required("failure_stiffness", Dimension::stress_per_length, "shear stiffness after slip k_sf"),
      optional("shear_rule", Dimension::none, "k_s at 0 start of increment, 1 middle, 2 exact hyperbola", 0.0),
      optional("stress_floor", Dimension::none, "smallest sigma_n for k_s, as a fraction of p_a", 1e-6),
      optional("unloading", Dimension::none, "0 reload linearly to the largest |tau|, 1 hyperbola at once",
               0.0),
      optional("slip_tangent", Dimension::none,
               "share of k_s that the tangent alone keeps while the joint slips; the stress keeps none", 0.0),
  };
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  CloughDuncanParameters law{};
  law.c = p.not_negative("cohesion");
  law.tan_phi = std::tan(p.angle("friction_angle"));
  law.sigma_t = p.not_negative("tensile_strength");
  law.R_f = p.between("failure_ratio", 0.0, 1.0);
  law.n = p.not_negative("stiffness_exponent");
  law.k_nc = p.positive("compressive_stiffness");
  law.k_nt = p.not_negative("tensile_stiffness");
  law.k_sf = p.not_negative("failure_stiffness");
  law.rule = static_cast<ShearRule>(p.code("shear_rule", {0, 1, 2}));
  law.floor = p.positive("stress_floor");
  law.memory = p.code("unloading", {0, 1}) == 0;
  law.slip_tangent = p.between("slip_tangent", 0.0, 1.0);
  const double k_j = p.not_negative("stiffness_number");
  law.k_unit = k_j > 0.0 ? k_j * p.water_unit_weight() : 0.0;
  const bool scaled = k_j > 0.0 && law.n > 0.0;  // by p_a, which is known then
  law.p_a = scaled ? p.atmospheric_pressure() : 1.0;
  law.nothing = scaled ? kNoGapOfFloor * law.floor * law.p_a : 0.0;
  if (law.sigma_t > 0.0 && law.k_nt == 0.0)
    p.refuse("tensile_stiffness", "must be greater than 0 where there is a tensile strength");
  return std::make_unique<CloughDuncan>(law);
}

}  // namespace

// tau_f = c + sigma_n tan phi, sigma_n compression positive; never negative.
CloughDuncan::Real CloughDuncan::strength(const Real& sigma_n) const {
  return max(p_.c + sigma_n * Real(p_.tan_phi), Real(0.0));
}

// k_s,i = k_j gamma_w (sigma_n/p_a)^n
CloughDuncan::Real CloughDuncan::initial_stiffness(const Real& sigma_n) const {
  if (p_.n == 0.0) return p_.k_unit;
  return Real(p_.k_unit) * pow(max(sigma_n / p_.p_a, Real(p_.floor)), p_.n);
}

// sigma_n from the opening w, measured from the unstressed contact: k_nc w, k_nt w up to sigma_t, then nothing.  Shear
// strength without normal stress fades over a gap: if it went at once, forces between those of the closed and of the
// open joint would have no equilibrium.
CloughDuncan::Normal CloughDuncan::normal_response(const PointIn<2>& in) const {
  const double sigma0 = in.sigma0[1];
  const double w0 = sigma0 > 0.0 ? sigma0 / p_.k_nt : sigma0 < 0.0 ? sigma0 / p_.k_nc : in.h0[kGap];
  const Real dw = Real::variable(in.deps[1], 1);
  const Real w = w0 + dw;
  const bool bonded = in.h0[kGap] == 0.0 && in.h0[kBroken] == 0.0 && p_.sigma_t > 0.0;
  // Without stress rounding must not decide whether the joint is open, loose and without memory.
  const double within = reach(in.h0);
  const double no_gap = !bonded && within == 0.0 ? (kNoGap * in.h0[kMemory] + p_.nothing) / p_.k_nc : 0.0;
  Normal normal;
  normal.sliding = 1.0;
  if (w.v <= 0.0) {
    if (in.h0[kGap] > no_gap + within) normal.sliding = (w - within) / dw;
    normal.sigma = sigma0 < 0.0 ? sigma0 + p_.k_nc * dw : p_.k_nc * w;
    return normal;
  }
  const Real tension = sigma0 > 0.0 ? sigma0 + p_.k_nt * dw : p_.k_nt * w;
  if (bonded && tension.v <= p_.sigma_t) {
    normal.sigma = tension;
    return normal;
  }
  if (w.v <= no_gap) {
    normal.gap = w.v;
    normal.sigma = Real(0.0, p_.k_nc * dw.d);
    return normal;
  }
  normal.gap = w.v;
  normal.open = !(w.v < within * (1.0 - kRounding));
  if (normal.open) return normal;
  if (in.h0[kGap] > within) normal.sliding = (w - within) / dw;
  normal.lost = p_.k_nc * w;
  return normal;
}

// Loading beyond every earlier stress, from tau0 by w: secant stiffness of the chosen rule.
//   d tau/dw = k_i y^2,  y = 1 - R_f tau/tau_f
CloughDuncan::Shear CloughDuncan::primary(const Real& tau0, const Real& w, const Real& k_i,
                                          const Real& tau_f) const {
  // Without strength to speak of the stress slips anyway; dividing by it could overflow.
  const double smallest = 1e-12 * (p_.c + p_.floor * p_.p_a * p_.tan_phi);
  const Real b = tau_f.v > smallest ? Real(p_.R_f) / tau_f : Real(0.0);
  const Real y0 = max(1.0 - b * tau0, Real(1.0 - p_.R_f));
  const Real g = k_i * b * w * y0;
  Shear shear;
  switch (p_.rule) {
    case ShearRule::tangent:
      shear.stiffness = k_i * y0 * y0;
      break;
    case ShearRule::midpoint: {
      const Real y = 2.0 * y0 / (1.0 + sqrt(1.0 + 2.0 * g));  // y at tau0 + k w/2, solved for k
      shear.stiffness = k_i * y * y;
      break;
    }
    case ShearRule::exact:
      shear.stiffness = k_i * y0 * y0 / (1.0 + g);
      break;
  }
  shear.tau = tau0 + shear.stiffness * w;
  return shear;
}

// Trial shear stress in the direction of the increment: linear up to the memory, hyperbolic beyond it.
CloughDuncan::Shear CloughDuncan::shear_trial(const PointIn<2>& in, const Real& sigma_n, const Real& w,
                                              double direction) const {
  const double sigma_start = -in.sigma0[1];
  const Real seen = p_.rule == ShearRule::tangent ? Real(sigma_start) : 0.5 * (sigma_start + sigma_n);
  const Real k_i = initial_stiffness(seen);
  const Real tau_f = strength(seen);
  const double tau0 = direction * in.sigma0[0];
  const double limit = p_.memory ? in.h0[kMemory] : std::max(tau0, 0.0);
  const double near = p_.rule == ShearRule::tangent ? kOnMemory : kRounding;

  if (tau0 >= limit * (1.0 - near) || k_i.v == 0.0) return primary(tau0, w, k_i, tau_f);
  const Real w_linear = (limit - tau0) / k_i;
  if (w < w_linear || p_.rule == ShearRule::tangent) return {tau0 + k_i * w, k_i, p_.R_f > 0.0};
  return primary(limit, w - w_linear, k_i, tau_f);
}

bool CloughDuncan::initialise(const Vector2& sigma, std::span<double> h) const {
  h[kMemory] = std::abs(sigma[0]);
  const double tau_f = strength(-sigma[1]).v;
  return sigma[1] <= p_.sigma_t && std::abs(sigma[0]) <= tau_f * (1.0 + 1e-8);
}

double CloughDuncan::limit(double sigma_n, std::span<const double> h) const {
  return std::max(strength(sigma_n).v + h[kHardening] - p_.k_nc * h[kGap], 0.0);
}

// A gap stands between bodies that don't touch, and only once their bond is broken; adhesion may act across it.
bool CloughDuncan::accepts_history(const Vector2& sigma, std::span<const double> h) const {
  const bool open = h[kGap] > 0.0, broken = h[kBroken] == 1.0;
  const bool apart = sigma[1] == 0.0 && std::abs(sigma[0]) <= limit(0.0, h) * (1.0 + 1e-8);
  return h[kGap] >= 0.0 && (broken || (h[kBroken] == 0.0 && !open)) && (!open || apart) &&
         h[kMemory] >= std::abs(sigma[0]) * (1.0 - 1e-8) && h[kHardening] >= 0.0;
}

Outcome CloughDuncan::update(const PointIn<2>& in, PointOut<2>& out) const {
  const Normal normal = normal_response(in);
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  out.h1[kGap] = normal.gap;
  if (normal.lost.v > 0.0) out.h1[kBroken] = 1.0;
  if (normal.open) {
    out.sigma.setZero();
    out.D.setZero();
    if (p_.slip_tangent > 0.0) {
      out.D(0, 0) = kOpenTangent * initial_stiffness(0.0).v;
      out.D(1, 1) = kOpenTangent * p_.k_nc;
    }
    out.h1[kBroken] = 1.0;
    out.h1[kMemory] = out.h1[kHardening] = 0.0;  // a new contact starts afresh
    out.status = PointStatus::open;
    return Outcome::ok;
  }

  // Trial, measured in the direction of sliding.
  const double reference = in.deps[0] != 0.0 ? in.deps[0] : in.sigma0[0];
  const double direction = reference < 0.0 ? -1.0 : 1.0;
  const Real sigma_n = -normal.sigma;
  const Real w = direction * Real::variable(in.deps[0], 0) * normal.sliding;
  const Shear trial = shear_trial(in, sigma_n, w, direction);
  out.status = trial.unloading ? PointStatus::unloading : PointStatus::elastic;
  Real tau = direction * trial.tau;

  // Slip: back to the strength at the end of the increment, plus k_sf times the displacement since slip.
  const double side = tau.v < 0.0 ? -1.0 : 1.0;
  const Real limit = strength(sigma_n) + in.h0[kHardening] - normal.lost;
  const Real excess = side * tau - limit;
  if (excess.v > kRounding * limit.v) {
    const Real& k = trial.stiffness;
    const Real r = k.v > 0.0 ? min(Real(p_.k_sf) / k, Real(1.0)) : Real(0.0);
    Real hardening = r * excess;
    if (normal.lost.v > 0.0) hardening = hardening * (1.0 - normal.lost / (p_.c + in.h0[kHardening]));
    tau = side * (limit + hardening);
    out.h1[kHardening] += hardening.v;
    out.h1[kSlip] += k.v > 0.0 ? (excess.v - hardening.v) / k.v : w.v;
    out.status = PointStatus::slipping;
  }
  out.h1[kMemory] = std::max(in.h0[kMemory], std::abs(tau.v));
  out.sigma << tau.v, normal.sigma.v;
  out.D.row(0) = tau.d;
  out.D.row(1) = normal.sigma.d;
  if (out.status == PointStatus::slipping) out.D(0, 0) += p_.slip_tangent * trial.stiffness.v;
  return Outcome::ok;
}

double CloughDuncan::stress_level(const Vector2& sigma, std::span<const double> h) const {
  const double tau = std::abs(sigma[0]);
  const double most = limit(-sigma[1], h);
  if (tau == 0.0) return 0.0;
  return most > 0.0 ? tau / most : std::numeric_limits<double>::infinity();
}

MaterialEntry clough_duncan_entry() {
  return {"clough_duncan",       "hyperbolic interface with Coulomb slip, opening and closing", 2, rows(), make,
          CloughDuncan::kHistory};
}

}  // namespace sage
