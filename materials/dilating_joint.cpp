#include "materials/dilating_joint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/math/rounding.hpp"

namespace sage {

namespace {

constexpr double kRounding =
    rounding::kStrength;  // relative to the strength: below this a stress is on the surface

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("shear_stiffness", Dimension::stress_per_length, "shear stiffness k_s"),
      required("normal_stiffness", Dimension::stress_per_length, "normal stiffness k_n"),
      required("cohesion", Dimension::stress, "cohesion c", ParameterRole::strength),
      required("friction_angle", Dimension::angle, "friction angle phi", ParameterRole::friction_angle),
      optional("dilation_angle", Dimension::angle, "dilation angle psi, at most phi", 0.0,
               ParameterRole::dilation_angle),
      optional("slip_limit", Dimension::length, "plastic slip after which it dilates no more; -1 = never",
               -1.0),
  };
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  DilatingJointParameters law{};
  law.k_s = p.positive("shear_stiffness");
  law.k_n = p.positive("normal_stiffness");
  law.c = p.not_negative("cohesion");
  law.tan_phi = std::tan(p.angle("friction_angle"));
  law.tan_psi = std::tan(p.angle("dilation_angle"));
  if (law.tan_psi > law.tan_phi) p.refuse("dilation_angle", "must not exceed the friction angle");
  law.slip_limit =
      p.number("slip_limit") == -1.0 ? std::numeric_limits<double>::infinity() : p.not_negative("slip_limit");
  return std::make_unique<DilatingJoint>(law);
}

}  // namespace

bool DilatingJoint::initialise(const Vector2& sigma, std::span<double> h) const {
  h[kGap] = h[kSlip] = h[kOpening] = 0.0;
  return sigma[1] <= 0.0 && std::abs(sigma[0]) <= (p_.c - sigma[1] * p_.tan_phi) * (1.0 + 1e-8);
}

double DilatingJoint::strength(double sigma, double gap) const {
  return std::max(p_.c - p_.tan_phi * sigma - p_.k_n * gap, 0.0);
}

// A gap stands between bodies that don't touch; while it is small, cohesion still shears them.
bool DilatingJoint::accepts_history(const Vector2& sigma, std::span<const double> h) const {
  const double gap = h[kGap];
  const bool apart = gap > 0.0 && sigma[1] == 0.0 && std::abs(sigma[0]) <= strength(0.0, gap) * (1.0 + 1e-8);
  return (gap == 0.0 || apart) && h[kSlip] >= 0.0 && h[kOpening] >= 0.0;
}

// excess = k_s slip + k_n slope opening, opening = tan(psi) times the slip up to the limit.
DilatingJoint::Slip DilatingJoint::slip_of(const Real& excess, double slope, double slip0) const {
  const double left = std::max(p_.slip_limit - slip0, 0.0);
  const Real dilating = excess / Real(p_.k_s + p_.k_n * slope * p_.tan_psi);
  if (dilating.v <= left) return {dilating, p_.tan_psi * dilating};
  const double opening = p_.tan_psi * left;
  return {(excess - Real(p_.k_n * slope * opening)) / Real(p_.k_s), opening};
}

DilatingJoint::Return DilatingJoint::return_to(double slope, const Real& tau, const Real& sigma,
                                               double slip0) const {
  const double side = tau.v < 0.0 ? -1.0 : 1.0;
  const Real excess = side * tau + slope * sigma - p_.c;
  if (!(excess.v > kRounding * (p_.c + slope * std::abs(sigma.v)))) return {tau, sigma, {0.0, 0.0}, false};
  const Slip slip = slip_of(excess, slope, slip0);
  return {tau - side * p_.k_s * slip.slip, sigma - p_.k_n * slip.opening, slip, true};
}

// Apart by a gap g, the trial's sigma is k_n g, and is what the strength has lost; the joint carries none of it.  If
// cohesion went at once, forces between those of the closed and of the open joint would have no equilibrium.
Outcome DilatingJoint::update(const PointIn<2>& in, PointOut<2>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  const Real shear = Real::variable(in.deps[0], 0), normal = Real::variable(in.deps[1], 1);
  // Beyond the reach of cohesion it carries nothing, and of the increment that comes back only the share within
  // reach shears it.
  const double gap0 = in.h0[kGap], reach = p_.c / p_.k_n;
  const Real opening = gap0 + normal, beyond = opening - reach;
  const bool was_within = gap0 <= reach;
  const Real share = was_within ? Real(1.0) : beyond.v < 0.0 ? beyond / normal : Real(0.0);
  const Real sigma = in.sigma0[1] + p_.k_n * opening, tau = in.sigma0[0] + p_.k_s * share * shear;

  out.status = PointStatus::open;
  out.sigma.setZero();
  out.D.setZero();
  out.h1[kGap] = opening.v + in.sigma0[1] / p_.k_n;
  if (!was_within && !(beyond.v < 0.0)) return Outcome::ok;

  Return back = return_to(p_.tan_phi, tau, sigma, in.h0[kSlip]);
  const bool apart = back.sigma.v > 0.0;
  if (apart) back = return_to(1.0, tau, sigma, in.h0[kSlip]);
  if (apart && !(back.sigma.v < p_.c * (1.0 - 10.0 * kRounding))) return Outcome::ok;
  out.status = back.slips ? PointStatus::slipping : PointStatus::elastic;
  out.sigma[0] = back.tau.v;
  out.D.row(0) = back.tau.d;
  if (!apart) {
    out.sigma[1] = back.sigma.v;
    out.D.row(1) = back.sigma.d;
  }
  out.h1[kGap] = apart ? std::max(out.h1[kGap] - back.slip.opening.v, 0.0) : 0.0;
  out.h1[kSlip] += back.slip.slip.v;
  out.h1[kOpening] += back.slip.opening.v;
  return Outcome::ok;
}

std::string DilatingJoint::caution() const {
  return p_.c == 0.0 && p_.tan_phi == 0.0 ? "no shear resistance: cohesion and friction are zero" : "";
}

double DilatingJoint::stress_level(const Vector2& sigma, std::span<const double> h) const {
  const double tau = std::abs(sigma[0]), limit = strength(sigma[1], h[kGap]);
  if (tau == 0.0) return 0.0;
  return limit > 0.0 ? tau / limit : std::numeric_limits<double>::infinity();
}

MaterialEntry dilating_joint_entry() {
  return {
      "dilating_joint",       "interface with Coulomb slip that dilates, opening and closing", 2, rows(), make,
      DilatingJoint::kHistory};
}

}  // namespace sage
