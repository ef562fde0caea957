#include "materials/drucker_prager.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/drucker_prager_four.hpp"
#include "materials/stress_measures.hpp"

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> r = elastic_rows();
    r.push_back(required("cohesion", Dimension::stress, "cohesion c", ParameterRole::strength));
    r.push_back(
        required("friction_angle", Dimension::angle, "friction angle phi", ParameterRole::friction_angle));
    r.push_back(optional("dilation_angle", Dimension::angle, "dilation angle psi, at most phi", 0.0,
                         ParameterRole::dilation_angle));
    r.push_back(optional("cone", Dimension::none,
                         "1 triaxial compression, 2 extension, 3 plane strain associated, "
                         "4 plane strain without volume change, 5 inner",
                         1.0));
    r.push_back(optional("flow", Dimension::none, "0 from the dilation angle, 1 without volume change", 0.0));
    r.push_back(optional("mean_tension_limit", Dimension::stress, "largest mean tension; -1 = the apex only",
                         -1.0, ParameterRole::tension_limit));
    r.push_back(optional("apex", Dimension::none,
                         "beyond the apex 0 the mean stress returns to it, 1 stays elastic (no volume change)",
                         0.0));
    r.push_back(optional("integration", Dimension::none, "0 radial return, 1 exact (no volume change)", 0.0));
    return r;
  }();
  return table;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(rows(), values, units);
  DruckerPragerParameters law{};
  law.elastic = elastic_parameters(p);
  const double phi = p.angle("friction_angle"), psi = p.angle("dilation_angle");
  if (psi > phi) p.refuse("dilation_angle", "must not exceed the friction angle");
  const auto match = static_cast<ConeMatch>(p.code("cone", {1, 2, 3, 4, 5}));
  law.cone = match_cone(match, phi, p.not_negative("cohesion"));
  law.beta = p.code("flow", {0, 1}) == 1 ? 0.0 : match_cone(match, psi, 0.0).alpha;
  const bool limited = p.number("mean_tension_limit") != -1.0;
  law.mean_tension = limited ? p.not_negative("mean_tension_limit") : std::numeric_limits<double>::infinity();
  law.free_mean = p.code("apex", {0, 1}) == 1;
  if (law.free_mean && (law.beta != 0.0 || limited))
    p.refuse("apex", "can be 1 only for flow without volume change and without a tension limit");
  law.exact = p.code("integration", {0, 1}) == 1;
  if (law.exact && law.beta != 0.0) p.refuse("integration", "can be 1 only for flow without volume change");
  return std::make_unique<DruckerPragerFour>(law);
}

}  // namespace

Cone match_cone(ConeMatch match, double phi, double c) {
  const double s = std::sin(phi), root3 = std::sqrt(3.0);
  switch (match) {
    case ConeMatch::triaxial_compression:
      return {2.0 * s / (root3 * (3.0 - s)), 6.0 * c * std::cos(phi) / (root3 * (3.0 - s))};  // 7.26, 7.27
    case ConeMatch::triaxial_extension:
      return {2.0 * s / (root3 * (3.0 + s)), 6.0 * c * std::cos(phi) / (root3 * (3.0 + s))};
    case ConeMatch::plane_strain_associated:
    case ConeMatch::inner: {
      const double t = std::tan(phi), root = std::sqrt(9.0 + 12.0 * t * t);
      return {t / root, 3.0 * c / root};
    }
    case ConeMatch::plane_strain_deviatoric:
      return {s / 3.0, c * std::cos(phi)};
  }
  return {};
}

DruckerPrager::DruckerPrager(const DruckerPragerParameters& parameters)
    : p_(parameters), p_max_(parameters.mean_tension), D_elastic_(elastic_matrix(parameters.elastic)) {
  if (p_.cone.alpha > 0.0) p_max_ = std::min(p_max_, p_.cone.k / (3.0 * p_.cone.alpha));
}

// Triaxial extension meets sigma_3 = 0 along the whole cone where M = 3 sqrt(3) alpha = 3/2.
std::string DruckerPrager::caution() const {
  const double limit = 0.5 / std::sqrt(3.0);
  if (p_.cone.alpha == 0.0 && p_.cone.k == 0.0)
    return "cohesion and friction are zero: the material has no shear strength, any shear makes it a mechanism";
  if (p_.cone.alpha >= limit * (1.0 - 1e-9))
    return "the cone equals or exceeds the tension limit of Mohr-Coulomb (sin phi >= 3/5 where it is matched "
           "in "
           "triaxial compression): in triaxial extension it has no strength limit, and in plane strain with "
           "associated flow it has none";
  return {};
}

double DruckerPrager::stress_level(const Vector4& sigma, std::span<const double> /*h*/) const {
  const double p = mean_stress(sigma), q = sqrt_j2(sigma);
  const double strength = p_.cone.k - 3.0 * p_.cone.alpha * p;
  const double nothing = 1e-9 * scale(std::abs(p), q);
  if (strength > nothing) return q / strength;
  const bool at_apex = q <= nothing && (strength >= -nothing || p_.free_mean);
  return at_apex ? 1.0 : std::numeric_limits<double>::infinity();
}

bool DruckerPrager::initialise(const Vector4& sigma, std::span<double> h) const {
  h[kShear] = h[kVolume] = 0.0;
  const double p = mean_stress(sigma), q = sqrt_j2(sigma);
  const double f = q + 3.0 * p_.cone.alpha * p - p_.cone.k;
  return f <= 1e-8 * scale(std::abs(p), q) && p <= p_max_ + 1e-8 * scale(std::abs(p), q);
}

bool DruckerPrager::accepts_history(const Vector4& /*sigma*/, std::span<const double> h) const {
  return h[kShear] >= 0.0;
}

// Numbers of equations: docs/theory/drucker_prager.md.
Outcome DruckerPrager::update(const PointIn<4>& in, PointOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  // Elastic predictor.  The initial stress is part of sigma0.
  const Vector4 stress = in.sigma0 + D_elastic_ * in.deps;
  const Trial trial = invariants(stress);
  const double f = trial.q + 3.0 * p_.cone.alpha * trial.p - p_.cone.k;  // (D1)
  const double rounding = kRounding * scale(std::abs(trial.p), trial.q);
  out.h1[kShear] = in.h0[kShear];
  out.h1[kVolume] = in.h0[kVolume];
  if (f <= rounding && trial.p <= p_max_ + rounding) {
    out.sigma = stress;
    out.D = D_elastic_;
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  // To the cone, if that is in front of its tip and of the tension limit (D2).
  const double dlambda = f / (G + 9.0 * K * p_.cone.alpha * p_.beta);
  const double p_cone = trial.p - 3.0 * K * p_.beta * dlambda;
  if (f > rounding && p_cone <= p_max_ + rounding) {
    if (!p_.exact || !integrate_exactly(in, out)) return_to_cone(trial, p_cone, out);
  } else if (p_.free_mean) {
    drop_deviator(trial, out);
  } else {
    return_to_cap(trial, out);
  }
  const Trial fall = invariants(stress - out.sigma);  // plastic strain times the elastic moduli
  out.h1[kShear] += fall.q / G;
  out.h1[kVolume] += fall.p / K;
  return Outcome::ok;
}

// s = theta s_tr; the tangent is (D3): de Souza Neto, Peric & Owen (2008), ch. 8.
void DruckerPrager::return_to_cone(const Trial& trial, double p, PointOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  const auto [alpha, k] = p_.cone;
  const double beta = p_.beta, A = 1.0 / (G + 9.0 * K * alpha * beta);
  const double theta = std::max(k - 3.0 * alpha * p, 0.0) / trial.q;  // on the surface to the last digit
  const Vector4 n = trial.s / (std::sqrt(2.0) * trial.q);
  const double shear = 2.0 * G * theta, turning = 2.0 * G * multiply_add(-G, A, 1.0 - theta);
  const double coupling = 3.0 * std::sqrt(2.0) * G * K * A, volume = K * (1.0 - 9.0 * K * alpha * beta * A);
  for (int i = 0; i < 4; ++i) {
    out.sigma[i] = multiply_add(kUnit[i], p, theta * trial.s[i]);
    const double turned = turning * n[i], pushed = alpha * n[i];
    for (int j = 0; j < 4; ++j) {
      const double mixed = multiply_add(n[j], beta * kUnit[i], pushed * kUnit[j]);
      const double along = multiply_add(shear, kProjection[i][j], turned * n[j]);
      out.D(i, j) = multiply_add(mixed, -coupling, along) + volume * kUnit[i] * kUnit[j];
    }
  }
  out.status = PointStatus::yielded;
}

// s = 0,  p = p_trial.
void DruckerPrager::drop_deviator(const Trial& trial, PointOut<4>& out) const {
  out.sigma = trial.p * unit_tensor();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      out.D(i, j) = multiply_add(kApexStiffness, D_elastic_(i, j), p_.elastic.K * kUnit[i] * kUnit[j]);
  out.status = PointStatus::apex;
}

// p = p_max; the deviator is cut to what the cone leaves there, which is nothing at the apex.
void DruckerPrager::return_to_cap(const Trial& trial, PointOut<4>& out) const {
  const double left = std::max(p_.cone.k - 3.0 * p_.cone.alpha * p_max_, 0.0);
  const bool at_apex = p_max_ < p_.mean_tension || left <= kRounding * p_.cone.k;
  const bool corner = trial.q > left;
  const double theta = at_apex ? 0.0 : corner ? left / trial.q : 1.0;
  const bool cut = corner && theta > 0.0;
  const double shear = 2.0 * p_.elastic.G * theta;
  const Vector4 n = trial.s / (std::sqrt(2.0) * trial.q);
  for (int i = 0; i < 4; ++i) {
    out.sigma[i] = multiply_add(p_max_, kUnit[i], theta * trial.s[i]);
    const double turned = -shear * n[i];
    for (int j = 0; j < 4; ++j) {
      double D = shear * kProjection[i][j];
      if (cut) D = multiply_add(turned, n[j], D);
      out.D(i, j) = multiply_add(kApexStiffness, D_elastic_(i, j), D);
    }
  }
  out.status = at_apex ? PointStatus::apex : PointStatus::cut_off;
}

MaterialEntry drucker_prager_entry() {
  return {
      "drucker_prager",       "Drucker-Prager cone, elastic - perfectly plastic, any dilation", 4, rows(), make,
      DruckerPrager::kHistory};
}

}  // namespace sage
