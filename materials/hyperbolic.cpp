#include "materials/hyperbolic.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

using Real = HyperbolicReal;

constexpr double kSmallestTangent = 1e-4;   // of E_i; reached only for R_f near 1
constexpr double kTensionStiffness = 1e-3;  // share of the modulus left in tension
// Stress levels.  Isotropic loading leaves some of 1e-16 (rounding) to 1e-9 (what equilibrium leaves), and such
// a memory must not choose between E_t and E_ur.
constexpr double kRounding = 1e-11;   // so far below the memory is on it
constexpr double kLeastBlend = 1e-4;  // least width of the blend

Real floored(const HyperbolicParameters& p, const Real& sigma_3) {
  return max(sigma_3 / p.p_a, Real(p.floor));
}

// SL = (sigma_1 - sigma_3)/(sigma_1 - sigma_3)_f with the floored sigma_3 in the strength.
Real level(const HyperbolicParameters& p, const Real& sigma_1, const Real& sigma_3) {
  const Real q_f = deviator_strength(p, p.p_a * floored(p, sigma_3));
  return q_f.v > 0.0 ? max(sigma_1 - sigma_3, Real(0.0)) / q_f : Real(1.0);
}

struct Young {
  Real E, E_i, SL;
  bool unloading;
};

// E_t = E_i (1 - R_f SL)^2 on first loading, E_ur below 3/4 of the critical level (of a memory below 4e-4: 1e-4
// below it), linear between.
Young young(const HyperbolicParameters& p, const Real& sigma_1, const Real& sigma_3, const Real& memory) {
  const Real s = floored(p, sigma_3);
  const Real E_i = p.K * p.p_a * pow(s, p.n);
  const Real E_ur = p.K_ur * p.p_a * pow(s, p.n);
  const Real SL = level(p, sigma_1, sigma_3);
  const Real y = 1.0 - p.R_f * min(SL, Real(1.0));
  const Real E_t = max(E_i * y * y, kSmallestTangent * E_i);

  const Real critical = memory / pow(s, 0.25);
  const Real share = 1.0 - (critical - SL - kRounding) / max(0.25 * critical, Real(kLeastBlend));
  Young young{E_t, E_i, SL, share.v < 1.0};
  if (share.v <= 0.0) young.E = E_ur;
  if (share.v > 0.0 && young.unloading) young.E = E_ur + share * (E_t - E_ur);

  // Tension: linear loss of stiffness over a floor's width.
  if (sigma_3.v < 0.0) young.E = young.E * max(1.0 + sigma_3 / (p.floor * p.p_a), Real(kTensionStiffness));
  return young;
}

// nu_t = (G - F log10(sigma_3/p_a))/(1 - A)^2,  A = d (sigma_1 - sigma_3)/(E_i (1 - R_f SL)), in [0, nu_max].
Real poisson_1970(const HyperbolicParameters& p, const Real& sigma_1, const Real& sigma_3, const Young& young) {
  const Real nu_i = p.G - (p.F / std::log(10.0)) * log(floored(p, sigma_3));
  const Real below = young.E_i * (1.0 - p.R_f * young.SL);
  if (!(below.v > 0.0)) return p.nu_max;
  const Real one_minus_A = 1.0 - p.d * max(sigma_1 - sigma_3, Real(0.0)) / below;
  if (!(one_minus_A.v > 0.0)) return p.nu_max;
  return max(Real(0.0), min(nu_i / (one_minus_A * one_minus_A), Real(p.nu_max)));
}

// Whether the strength grows with sigma_3 = 10^decade p_a, far beyond any test at 3: d/d sigma_3 of
// sigma_3 sin phi/(1 - sin phi) >= 0.
bool grows(const HyperbolicParameters& h, double decade) {
  const double phi = h.phi0 - h.dphi * decade, sine = std::sin(phi);
  return sine * (1.0 - sine) >= std::cos(phi) * h.dphi / std::log(10.0);
}

// B = B_i p_a (1 + sigma_m/(B_i p_a eps_u))^2 [Selig 1988]; no less than B_i p_a where the mean stress is tensile.
// One of its derivatives is not among those of Real: K and G are made with a number that has it too.
HyperbolicModuli selig(const HyperbolicParameters& p, const Young& young, double mean) {
  using Wide = Dual<4>;
  const auto narrow = [](const Wide& x) {
    Real r = x.v;
    r.d = x.d.head<3>();
    return r;
  };
  Wide E = young.E.v;
  E.d << young.E.d, 0.0;
  const double B_i = p.B_i * p.p_a;
  const Wide stiffening = 1.0 + max(Wide::variable(mean, 3), Wide(0.0)) / (B_i * p.eps_u);
  const Wide B = B_i * stiffening * stiffening;
  const Wide K = max(E / 3.0, min(B, E / (3.0 * (1.0 - 2.0 * p.nu_max))));
  const Wide G = 3.0 * K * E / (9.0 * K - E);
  return {narrow(K), narrow(G), young.unloading, K.d[3], G.d[3]};
}

}  // namespace

HyperbolicReal friction_angle(const HyperbolicParameters& p, const HyperbolicReal& sigma_3) {
  if (p.dphi == 0.0) return p.phi0;
  const Real decades = log(floored(p, sigma_3)) / std::log(10.0);
  return p.phi0 - p.dphi * min(decades, Real(p.decades));
}

HyperbolicReal deviator_strength(const HyperbolicParameters& p, const HyperbolicReal& sigma_3) {
  const Real phi = friction_angle(p, sigma_3);
  return (2.0 * p.c * cos(phi) + 2.0 * sigma_3 * sin(phi)) / (1.0 - sin(phi));
}

double hyperbolic_level(const HyperbolicParameters& p, double sigma_1, double sigma_3) {
  return level(p, sigma_1, sigma_3).v;
}

HyperbolicReal stress_state(const HyperbolicParameters& p, double sigma_1, double sigma_3) {
  const Real s1 = Real::variable(sigma_1, 0), s3 = Real::variable(sigma_3, 1);
  return min(level(p, s1, s3), Real(1.0)) * pow(floored(p, s3), 0.25);
}

HyperbolicModuli hyperbolic_moduli(const HyperbolicParameters& p, double sigma_1, double sigma_3, double memory,
                                   double mean) {
  const Real s1 = Real::variable(sigma_1, 0), s3 = Real::variable(sigma_3, 1);
  const Young young_now = young(p, s1, s3, Real::variable(memory, 2));
  if (p.volume == VolumeRule::bulk_selig) return selig(p, young_now, mean);
  const Real& E = young_now.E;
  HyperbolicModuli moduli{{}, {}, young_now.unloading};
  if (p.volume == VolumeRule::bulk_1980) {
    const Real B = p.K_b * p.p_a * pow(floored(p, s3), p.m);
    moduli.K = max(E / 3.0, min(B, E / (3.0 * (1.0 - 2.0 * p.nu_max))));  // 0 <= nu <= nu_max
    moduli.G = 3.0 * moduli.K * E / (9.0 * moduli.K - E);
  } else {
    const Real nu = poisson_1970(p, s1, s3, young_now);
    moduli.K = E / (3.0 * (1.0 - 2.0 * nu));
    moduli.G = E / (2.0 * (1.0 + nu));
  }
  return moduli;
}

std::vector<Parameter> hyperbolic_rows(VolumeRule volume) {
  std::vector<Parameter> rows = {
      required("modulus_number", Dimension::none, "modulus number K, E_i = K p_a (sigma_3/p_a)^n",
               ParameterRole::modulus_number),
      required("modulus_exponent", Dimension::none, "modulus exponent n"),
      required("failure_ratio", Dimension::none, "failure ratio R_f"),
      required("unload_number", Dimension::none, "unload-reload modulus number K_ur",
               ParameterRole::modulus_number),
  };
  if (volume == VolumeRule::bulk_1980) {
    rows.push_back(required("bulk_number", Dimension::none,
                            "bulk modulus number K_b, B = K_b p_a (sigma_3/p_a)^m",
                            ParameterRole::modulus_number));
    rows.push_back(required("bulk_exponent", Dimension::none, "bulk modulus exponent m"));
  } else if (volume == VolumeRule::bulk_selig) {
    rows.push_back(required("bulk_number", Dimension::none,
                            "B_i/p_a: bulk modulus number, B = B_i (1 + sigma_m/(B_i eps_u))^2",
                            ParameterRole::modulus_number));
    rows.push_back(required("ultimate_volume_strain", Dimension::none,
                            "eps_u: volume strain that isotropic compression tends to"));
  } else {
    rows.push_back(required("poisson_G", Dimension::none, "G: initial Poisson's ratio at sigma_3 = p_a"));
    rows.push_back(required("poisson_F", Dimension::none, "F: its decrease for a tenfold sigma_3"));
    rows.push_back(required("poisson_d", Dimension::none, "d: its growth with axial strain"));
  }
  rows.push_back(required("cohesion", Dimension::stress, "cohesion c", ParameterRole::strength));
  rows.push_back(required("friction_angle", Dimension::angle, "friction angle phi_0 at sigma_3 = p_a",
                          ParameterRole::friction_angle));
  rows.push_back(optional("friction_loss", Dimension::angle, "decrease of phi for a tenfold sigma_3", 0.0,
                          ParameterRole::friction_loss));
  return rows;
}

HyperbolicParameters hyperbolic_parameters(const Parameters& p, VolumeRule volume) {
  HyperbolicParameters h{};
  h.K = p.positive("modulus_number");
  h.n = p.not_negative("modulus_exponent");
  h.R_f = p.between("failure_ratio", 0.0, 1.0);
  h.K_ur = p.positive("unload_number");
  h.volume = volume;
  if (volume == VolumeRule::bulk_1980) {
    h.K_b = p.positive("bulk_number");
    h.m = p.between("bulk_exponent", -2.0, 2.0);
  } else if (volume == VolumeRule::bulk_selig) {
    h.B_i = p.positive("bulk_number");
    h.eps_u = p.positive("ultimate_volume_strain");
  } else {
    h.G = p.between("poisson_G", 0.0, 1.0);
    h.F = p.between("poisson_F", -1.0, 1.0);
    h.d = p.not_negative("poisson_d");
  }
  h.c = p.not_negative("cohesion");
  h.phi0 = p.angle("friction_angle");
  h.dphi = p.angle("friction_loss");
  h.p_a = p.atmospheric_pressure();
  h.nu_max = p.between("largest_poissons_ratio", 0.0, 0.4999);
  h.floor = p.positive("stress_floor");
  const double steepest = h.phi0 - h.dphi * std::log10(h.floor);
  if (steepest >= 89.5 * kRadiansPerDegree)
    p.refuse("friction_loss", "must leave the friction angle below 89.5 degrees at the stress floor");
  // Clays of Selig's lose their whole angle before: phi stays where the strength would begin to fall.
  if (volume == VolumeRule::bulk_selig && grows(h, 0.0)) {
    double above = h.decades;
    for (h.decades = 0.0; above - h.decades > 1e-12;) {
      const double middle = 0.5 * (h.decades + above);
      (grows(h, middle) ? h.decades : above) = middle;
    }
    if (grows(h, 3.0)) h.decades = 3.0;
  }
  if (!grows(h, h.decades))
    p.refuse("friction_loss", volume == VolumeRule::bulk_selig
                                  ? "must leave a strength that grows with sigma_3 at p_a"
                                  : "must leave a strength that grows with sigma_3 up to 1000 p_a");
  return h;
}

}  // namespace sage
