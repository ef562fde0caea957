#include "materials/mohr_coulomb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/stress_measures.hpp"

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> r = elastic_rows();
    r.push_back(required("cohesion", Dimension::stress, "cohesion c", ParameterRole::strength));
    r.push_back(required("friction_angle", Dimension::angle, "friction angle phi; 0 is Tresca",
                         ParameterRole::friction_angle));
    r.push_back(optional("dilation_angle", Dimension::angle, "dilation angle psi, at most phi", 0.0,
                         ParameterRole::dilation_angle));
    r.push_back(optional("tension_cut_off", Dimension::stress, "largest tension; -1 = the apex only", -1.0,
                         ParameterRole::tension_limit));
    return r;
  }();
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  const ElasticModuli elastic = elastic_parameters(p);
  const double phi = p.angle("friction_angle"), psi = p.angle("dilation_angle");
  if (psi > phi) p.refuse("dilation_angle", "must not exceed the friction angle");
  const double T = p.number("tension_cut_off") == -1.0 ? std::numeric_limits<double>::infinity()
                                                       : p.not_negative("tension_cut_off");
  return std::make_unique<MohrCoulomb>(elastic, mohr_coulomb_planes(p.not_negative("cohesion"), phi, psi, T));
}

}  // namespace

MohrCoulombPlanes mohr_coulomb_planes(double c, double phi, double psi, double T) {
  const double N = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
  return {N, 2.0 * c * std::sqrt(N), (1.0 + std::sin(psi)) / (1.0 - std::sin(psi)), T};
}

// With sin phi = (N-1)/(N+1) and 2 c cos phi = 2Y/(N+1).
double mohr_coulomb_level(const MohrCoulombPlanes& planes, const Vector4& sigma) {
  const Principal s = principal(sigma);
  const double s1 = std::max(s.a, s.zz), s3 = std::min(s.b, s.zz), difference = s1 - s3;
  const double strength = (2.0 * planes.Y - (planes.N - 1.0) * (s1 + s3)) / (planes.N + 1.0);
  const double nothing = 1e-9 * (planes.Y / planes.N + std::abs(s1) + std::abs(s3));
  const double infinite = std::numeric_limits<double>::infinity();
  const bool at_apex = std::abs(strength) <= nothing && difference <= nothing;
  const double shear = strength > nothing ? difference / strength : at_apex ? 1.0 : infinite;
  if (planes.T >= planes.apex()) return shear;
  const double tension = planes.T > 0.0 ? s1 / planes.T : s1 >= -nothing ? 1.0 : 0.0;
  return std::max(shear, tension);
}

bool MohrCoulomb::initialise(const Vector4& sigma, std::span<double> h) const {
  h[kShear] = h[kVolume] = 0.0;
  return mohr_coulomb_level(planes_, sigma) <= 1.0 + 1e-8;
}

bool MohrCoulomb::accepts_history(const Vector4& /*sigma*/, std::span<const double> h) const {
  return h[kShear] >= 0.0;
}

Outcome MohrCoulomb::update(const PointIn<4>& in, PointOut<4>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  const Vector4 trial = in.sigma0 + D_elastic_ * in.deps;
  const Principal axes = principal(trial);
  if (!outside(planes_, axes)) {
    out.sigma = trial;
    out.D = D_elastic_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  const MohrCoulombReturn back = return_to_planes(planes_, elastic_, axes);
  out.sigma = back.sigma;
  out.D = back.R * D_elastic_;
  out.status = back.status;
  out.h1[kShear] += sqrt_j2(trial - back.sigma) / elastic_.G;
  out.h1[kVolume] += mean_stress(trial - back.sigma) / elastic_.K;
  return Outcome::ok;
}

MaterialEntry mohr_coulomb_entry() {
  return {"mohr_coulomb",       "Mohr-Coulomb, elastic - perfectly plastic, any dilation", 4, rows(), make,
          MohrCoulomb::kHistory};
}

}  // namespace sage
