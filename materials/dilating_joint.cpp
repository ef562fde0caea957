#include "materials/dilating_joint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

constexpr double kRounding = 1e-13;  // relative to the strength: below this a stress is on the surface

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

// A gap stands between bodies that don't touch.
bool DilatingJoint::accepts_history(const Vector2& sigma, std::span<const double> h) const {
  return (h[kGap] == 0.0 || (h[kGap] > 0.0 && sigma.isZero(0.0))) && h[kSlip] >= 0.0 && h[kOpening] >= 0.0;
}

// excess = k_s slip + k_n tan(phi) opening, opening = tan(psi) times the slip up to the limit.
DilatingJoint::Slip DilatingJoint::slip_of(const Real& excess, double slip0) const {
  const double left = std::max(p_.slip_limit - slip0, 0.0);
  const Real dilating = excess / Real(p_.k_s + p_.k_n * p_.tan_phi * p_.tan_psi);
  if (dilating.v <= left) return {dilating, p_.tan_psi * dilating};
  const double opening = p_.tan_psi * left;
  return {(excess - Real(p_.k_n * p_.tan_phi * opening)) / Real(p_.k_s), opening};
}

Outcome DilatingJoint::update(const PointIn<2>& in, PointOut<2>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  const Real shear = Real::variable(in.deps[0], 0), normal = Real::variable(in.deps[1], 1);
  // An open joint carries nothing until its gap is used up, and of the increment that closes it only the share
  // after contact shears it.
  const double gap0 = in.h0[kGap];
  const Real opening = gap0 + normal;
  const Real share = gap0 > 0.0 && opening.v < 0.0 ? opening / normal : Real(gap0 > 0.0 ? 0.0 : 1.0);
  Real sigma = in.sigma0[1] + p_.k_n * opening, tau = in.sigma0[0] + p_.k_s * share * shear;

  const double side = tau.v < 0.0 ? -1.0 : 1.0;
  const Real excess = side * tau + p_.tan_phi * sigma - p_.c;
  const bool contact = gap0 == 0.0 || opening.v < 0.0;
  out.status = PointStatus::elastic;
  if (contact && excess.v > kRounding * (p_.c + p_.tan_phi * std::abs(sigma.v))) {
    const Slip slip = slip_of(excess, in.h0[kSlip]);
    tau = tau - side * p_.k_s * slip.slip;
    sigma = sigma - p_.k_n * slip.opening;
    out.h1[kSlip] += slip.slip.v;
    out.h1[kOpening] += slip.opening.v;
    out.status = PointStatus::slipping;
  }
  if (sigma.v > 0.0) {
    out.sigma.setZero();
    out.D.setZero();
    std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
    out.h1[kGap] = opening.v + in.sigma0[1] / p_.k_n;
    out.status = PointStatus::open;
    return Outcome::ok;
  }
  out.sigma << tau.v, sigma.v;
  out.D.row(0) = tau.d;
  out.D.row(1) = sigma.d;
  out.h1[kGap] = 0.0;
  return Outcome::ok;
}

std::string DilatingJoint::caution() const {
  return p_.c == 0.0 && p_.tan_phi == 0.0 ? "no shear resistance: cohesion and friction are zero" : "";
}

double DilatingJoint::stress_level(const Vector2& sigma, std::span<const double> /*h*/) const {
  const double tau = std::abs(sigma[0]), limit = p_.c - sigma[1] * p_.tan_phi;
  if (tau == 0.0) return 0.0;
  return limit > 0.0 ? tau / limit : std::numeric_limits<double>::infinity();
}

MaterialEntry dilating_joint_entry() {
  return {
      "dilating_joint",       "interface with Coulomb slip that dilates, opening and closing", 2, rows(), make,
      DilatingJoint::kHistory};
}

}  // namespace sage
