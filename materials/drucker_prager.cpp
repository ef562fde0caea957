#include "materials/drucker_prager.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/dual.hpp"
#include "materials/stress_measures.hpp"

namespace sage {

namespace {

constexpr double kRounding = 1e-12;  // relative to DruckerPrager::scale
constexpr double kApexStiffness =
    1e-7;  // share of D_elastic left in the tangent where the true one is singular

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
  return std::make_unique<DruckerPrager>(law);
}

Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

// unit_tensor() and deviatoric_projection(), as constants that loops over their terms fold.
constexpr double kUnit[4] = {1.0, 1.0, 1.0, 0.0};
constexpr double kThird = 1.0 / 3.0;
constexpr double kProjection[4][4] = {{2.0 * kThird, -kThird, -kThird, 0.0},
                                      {-kThird, 2.0 * kThird, -kThird, 0.0},
                                      {-kThird, -kThird, 2.0 * kThird, 0.0},
                                      {0.0, 0.0, 0.0, 0.5}};

// Whether the elastic D has a term there.
constexpr bool couples(std::size_t i, std::size_t j) {
  return (i < 3) == (j < 3);
}

void set_status(const FourMask& here, PointStatus status, FourPointsOut<4>& out) {
  const int places = bits_of_four(here);
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kAbreast; ++l) out.status[l] = (places >> l & 1) != 0 ? status : out.status[l];
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

Outcome DruckerPrager::update(const PointIn<4>& in, PointOut<4>& out) const {
  return update_as_four(*this, in, out);
}

// Roots and quotients make a chain of each of the two halves: chains of several points go side by side.
Outcome DruckerPrager::update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const {
  std::array<Trial, kMostFours> trial;
  for (std::size_t p = 0; p < in.size(); ++p) predict(in[p], trial[p]);
  for (std::size_t p = 0; p < in.size(); ++p) finish(in[p], trial[p], out[p]);
  return Outcome::ok;
}

// The initial stress is part of sigma0.
void DruckerPrager::predict(const FourPointsIn<4>& in, Trial& trial) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    Four change{};
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j)
      if (couples(i, j)) change = multiply_add(all_four(D_elastic_(at(i), at(j))), in.deps[j], change);
    trial.stress[i] = in.sigma0[i] + change;
  }
  trial.of = invariants(trial.stress);
  const auto& [s, p, q] = trial.of;
  trial.f = q + 3.0 * p_.cone.alpha * p - p_.cone.k;  // Equation 7.25
  trial.rounding = kRounding * scale(abs_of_four(p), q);
  trial.elastic = (trial.f <= trial.rounding) & (p <= p_max_ + trial.rounding);
}

void DruckerPrager::finish(const FourPointsIn<4>& in, const Trial& trial, FourPointsOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  const FourMask elastic = trial.elastic;
  out.constant_D = bits_of_four(elastic) == kAllOfFour;
  Four shear, volume;
  load_pairs_of_four(in.h0[0], in.h0[1], in.h0[2], in.h0[3], shear, volume);
  if (!out.constant_D) {
    // Return: to the cone, if that is in front of its tip and of the tension limit.
    const Four dlambda = trial.f / (G + 9.0 * K * p_.cone.alpha * p_.beta);
    const Four p_cone = trial.of.p - 3.0 * K * p_.beta * dlambda;
    const FourMask in_front = (trial.f > trial.rounding) & (p_cone <= p_max_ + trial.rounding);  // theta >= 0
    const FourMask on_cone = in_front & ~elastic, beyond = ~(in_front | elastic);
    return_to_cone(trial.of, p_cone, out);
    if (p_.exact) take_exact_answers(in, on_cone, out);
    if (bits_of_four(beyond) != 0)
      p_.free_mean ? drop_deviator(trial.of, beyond, out) : return_to_cap(trial.of, beyond, out);

    FourTensors fall;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4; ++i) fall[i] = trial.stress[i] - out.sigma[i];
    const FourInvariants plastic = invariants(fall);
    shear += elastic ? Four{} : plastic.q / G;
    volume += elastic ? Four{} : plastic.p / K;
  }
  if (bits_of_four(elastic) != 0) stay_elastic(trial.stress, elastic, out);
  static_assert(kShear == 0 && kVolume == 1);
  store_pairs_of_four(shear, volume, out.h1[0], out.h1[1], out.h1[2], out.h1[3]);
}

void DruckerPrager::stay_elastic(const FourTensors& trial, const FourMask& here, FourPointsOut<4>& out) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    out.sigma[i] = here ? trial[i] : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) out.D[i][j] = here ? all_four(D_elastic_(at(i), at(j))) : out.D[i][j];
  }
  set_status(here, PointStatus::elastic, out);
}

// s = theta s_tr,  p = p_tr - 3 K beta dlambda; tangent: de Souza Neto, Peric & Owen (2008), ch. 8.
void DruckerPrager::return_to_cone(const FourInvariants& trial, const Four& p, FourPointsOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  const auto [alpha, k] = p_.cone;
  const double beta = p_.beta, A = 1.0 / (G + 9.0 * K * alpha * beta);
  const Four room = k - 3.0 * alpha * p, q = room > 0.0 ? room : Four{};  // on the surface to the last digit
  const Four theta = q / trial.q, length = std::sqrt(2.0) * trial.q;
  const Four shear = 2.0 * G * theta, turning = 2.0 * G * multiply_add(all_four(-G), all_four(A), 1.0 - theta);
  FourTensors n;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    n[i] = trial.s[i] / length;
    out.sigma[i] = multiply_add(all_four(kUnit[i]), p, theta * trial.s[i]);
  }
  const double coupling = 3.0 * std::sqrt(2.0) * G * K * A, volume = K * (1.0 - 9.0 * K * alpha * beta * A);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    const Four turned = turning * n[i], pushed = alpha * n[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      Four D = turned * n[j];
      if (couples(i, j)) D = multiply_add(shear, all_four(kProjection[i][j]), D);
      Four mixed = j < 3 ? pushed : Four{};  // beta n_j 1_i + alpha n_i 1_j
      if (i < 3) mixed = multiply_add(n[j], all_four(beta), mixed);
      D = multiply_add(mixed, all_four(-coupling), D);
      out.D[i][j] = i < 3 && j < 3 ? D + volume : D;
    }
  }
  out.status.fill(PointStatus::yielded);
}

// s = 0,  p = p_trial.
void DruckerPrager::drop_deviator(const FourInvariants& trial, const FourMask& here,
                                  FourPointsOut<4>& out) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    out.sigma[i] = here ? kUnit[i] * trial.p : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      const double D = p_.elastic.K * kUnit[i] * kUnit[j] + kApexStiffness * D_elastic_(at(i), at(j));
      out.D[i][j] = here ? all_four(D) : out.D[i][j];
    }
  }
  set_status(here, PointStatus::apex, out);
}

// p = p_max; the deviator is cut to what the cone leaves there, which is nothing at the apex.
void DruckerPrager::return_to_cap(const FourInvariants& trial, const FourMask& here,
                                  FourPointsOut<4>& out) const {
  const double left = std::max(p_.cone.k - 3.0 * p_.cone.alpha * p_max_, 0.0);
  const bool at_apex = p_max_ < p_.mean_tension || left <= kRounding * p_.cone.k;
  const Four none{}, whole = all_four(1.0);
  const FourMask corner = trial.q > left;
  const Four theta = at_apex ? none : corner ? left / trial.q : whole;
  const FourMask cut = corner & (theta > 0.0);
  const Four shear = 2.0 * p_.elastic.G * theta, length = std::sqrt(2.0) * trial.q;
  FourTensors n;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) n[i] = trial.s[i] / length;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    const Four sigma = multiply_add(all_four(p_max_), all_four(kUnit[i]), theta * trial.s[i]);
    const Four turned = -shear * n[i];
    out.sigma[i] = here ? sigma : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      Four D = shear * kProjection[i][j];
      D = cut ? multiply_add(turned, n[j], D) : D;
      D = multiply_add(all_four(kApexStiffness), all_four(D_elastic_(at(i), at(j))), D);
      out.D[i][j] = here ? D : out.D[i][j];
    }
  }
  set_status(here, at_apex ? PointStatus::apex : PointStatus::cut_off, out);
}

// Point by point, in place of the return to the cone.
void DruckerPrager::take_exact_answers(const FourPointsIn<4>& in, const FourMask& here,
                                       FourPointsOut<4>& out) const {
  const int places = bits_of_four(here);
  for (std::size_t l = 0; l < kAbreast; ++l) {
    if ((places >> l & 1) == 0) continue;
    PointIn<4> point;
    PointOut<4> answer;
    for (std::size_t i = 0; i < 4; ++i) {
      point.sigma0[at(i)] = one_of_four(in.sigma0[i], l);
      point.deps[at(i)] = one_of_four(in.deps[i], l);
    }
    if (!integrate_exactly(point, answer)) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      one_of_four(out.sigma[i], l) = answer.sigma[at(i)];
      for (std::size_t j = 0; j < 4; ++j) one_of_four(out.D[i][j], l) = answer.D(at(i), at(j));
    }
  }
}

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

MaterialEntry drucker_prager_entry() {
  return {
      "drucker_prager",       "Drucker-Prager cone, elastic - perfectly plastic, any dilation", 4, rows(), make,
      DruckerPrager::kHistory};
}

}  // namespace sage
