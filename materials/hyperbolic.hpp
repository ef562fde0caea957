// Hyperbolic moduli of Duncan & Chang (1970) and Duncan, Byrne, Wong & Mabry (1980), as functions of the
// principal stresses.  Compression positive in this file.  docs/theory/hyperbolic.md
#pragma once

#include "materials/dual.hpp"
#include "materials/parameters.hpp"

namespace sage {

enum class VolumeRule {
  poisson_1970,  // nu_t from G, F, d
  bulk_1980,     // B from K_b, m
  bulk_selig,    // B from B_i, eps_u and the mean stress
};

struct HyperbolicParameters {
  double K, n, R_f, K_ur;  // modulus number, exponent, failure ratio, unload-reload number
  VolumeRule volume;
  double K_b, m;         // bulk_1980: bulk modulus number, exponent
  double B_i, eps_u;     // bulk_selig: initial bulk modulus number, ultimate volume strain
  double G, F, d;        // poisson_1970
  double c, phi0, dphi;  // cohesion [stress], angle at p_a and loss of angle a decade [rad]
  double p_a;            // atmospheric pressure                    [stress]
  double nu_max;         // upper bound of Poisson's ratio
  double floor;          // moduli see at least sigma_3 = floor p_a
  double decades = 3.0;  // phi falls up to sigma_3 = 10^decades p_a
};

// Derivatives are with respect to (sigma_1, sigma_3, memory).
using HyperbolicReal = Dual<3>;

struct HyperbolicModuli {
  HyperbolicReal K, G;                  // bulk and shear modulus                         [stress]
  bool unloading;                       // below the largest stress state so far
  double dK_mean = 0.0, dG_mean = 0.0;  // with respect to the mean stress: bulk_selig alone
};

// phi = phi0 - dphi log10(sigma_3/p_a), between the floor and 10^decades p_a   [rad]
HyperbolicReal friction_angle(const HyperbolicParameters& p, const HyperbolicReal& sigma_3);
// (sigma_1 - sigma_3)_f = (2 c cos phi + 2 sigma_3 sin phi)/(1 - sin phi); phi is taken at the floored sigma_3.
HyperbolicReal deviator_strength(const HyperbolicParameters& p, const HyperbolicReal& sigma_3);

// Stress level seen by the moduli, and the stress state number SL (sigma_3/p_a)^(1/4) of Duncan et al. (1984).
double hyperbolic_level(const HyperbolicParameters& p, double sigma_1, double sigma_3);
HyperbolicReal stress_state(const HyperbolicParameters& p, double sigma_1, double sigma_3);

// `memory` is the largest stress state number so far; `mean`, the mean stress of all three, counts for bulk_selig.
HyperbolicModuli hyperbolic_moduli(const HyperbolicParameters& p, double sigma_1, double sigma_3, double memory,
                                   double mean = 0.0);

// Rows and reading that the hyperbolic laws share.
std::vector<Parameter> hyperbolic_rows(VolumeRule volume);  // everything up to the friction angles
// From a table that has them, largest_poissons_ratio and stress_floor.
HyperbolicParameters hyperbolic_parameters(const Parameters& p, VolumeRule volume);

}  // namespace sage
