#include "materials/hyperbolic_mohr_coulomb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> r = hyperbolic_rows(VolumeRule::bulk_1980);
    r.push_back(optional("dilation_angle", Dimension::angle, "dilation angle psi at failure, at most phi_0",
                         0.0, ParameterRole::dilation_angle));
    r.push_back(optional("tension_cut_off", Dimension::stress, "largest tension; -1 = the apex only", -1.0,
                         ParameterRole::tension_limit));
    r.push_back(optional("largest_poissons_ratio", Dimension::none, "upper bound of Poisson's ratio", 0.49));
    r.push_back(optional("stress_floor", Dimension::none,
                         "smallest sigma_3 for the moduli, as a fraction of p_a", 0.01));
    r.push_back(
        optional("step_tolerance", Dimension::none, "relative error of a substep, by its Euler half", 1e-3));
    return r;
  }();
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  HyperbolicSteps steps;
  steps.moduli = hyperbolic_parameters(p, VolumeRule::bulk_1980);
  const double psi = p.angle("dilation_angle");
  if (psi > steps.moduli.phi0) p.refuse("dilation_angle", "must not exceed the friction angle");
  steps.bounded = true;
  steps.M = (1.0 + std::sin(psi)) / (1.0 - std::sin(psi));
  steps.T = p.number("tension_cut_off") == -1.0 ? std::numeric_limits<double>::infinity()
                                                : p.not_negative("tension_cut_off");
  steps.tolerance = p.between("step_tolerance", 1e-10, 1.0);
  return std::make_unique<HyperbolicMohrCoulomb>(steps);
}

}  // namespace

double HyperbolicMohrCoulomb::stress_level(const Vector4& sigma, std::span<const double> /*h*/) const {
  const Extremes s = extremes(sigma, false);
  const MohrCoulombPlanes planes = tangent_planes(steps_, s.sigma_3);
  const double difference = s.sigma_1 - s.sigma_3, strength = planes.Y + (planes.N - 1.0) * s.sigma_3;
  const double nothing = 1e-9 * (planes.Y + planes.N * std::abs(s.sigma_3) + std::abs(s.sigma_1));
  if (strength > nothing) return difference / strength;
  const bool at_apex = strength >= -nothing && difference <= nothing;
  return at_apex ? 1.0 : std::numeric_limits<double>::infinity();
}

bool HyperbolicMohrCoulomb::initialise(const Vector4& sigma, std::span<double> h) const {
  const Extremes s = extremes(sigma, false);
  h[kMemory] = stress_state(steps_.moduli, s.sigma_1, s.sigma_3).v;
  return stress_level(sigma, h) <= 1.0 + 1e-8 && -s.sigma_3 <= steps_.T;
}

bool HyperbolicMohrCoulomb::accepts_history(const Vector4& sigma, std::span<const double> h) const {
  double own[1];
  initialise(sigma, own);
  return h[kMemory] >= own[kMemory] * (1.0 - 1e-8);
}

Outcome HyperbolicMohrCoulomb::update(const PointIn<4>& in, PointOut<4>& out) const {
  const HyperbolicAnswer a = integrate(steps_, in.sigma0, in.deps, in.h0[kMemory]);
  out.sigma = a.sigma;
  out.D = a.J;
  out.h1[kMemory] = a.memory;
  out.status = a.status;
  return a.accurate ? Outcome::ok : Outcome::cut_step;
}

MaterialEntry hyperbolic_mohr_coulomb_entry() {
  return {"hyperbolic_mohr_coulomb",
          "hyperbolic E and bulk modulus inside Mohr-Coulomb (after Morrison 1995)",
          4,
          rows(),
          make,
          HyperbolicMohrCoulomb::kHistory};
}

}  // namespace sage
