// Integration of d sigma = D(sigma) d eps with hyperbolic moduli: substeps of the modified Euler (Heun)
// method, as long as its error estimate allows (Sloan 1987), with the exact derivative of what was computed.
// An optional Mohr-Coulomb surface bounds the stress.  docs/theory/hyperbolic.md
#pragma once

#include "materials/hyperbolic.hpp"
#include "materials/mohr_coulomb_return.hpp"

namespace sage {

struct HyperbolicSteps {
  HyperbolicParameters moduli;
  bool in_plane{};     // sigma_1, sigma_3 of the plane only (the original programs), else of all three
  bool bounded{};      // return to Mohr-Coulomb with the same strength parameters
  double M{};          // flow of that return, (1 + sin psi)/(1 - sin psi)
  double T{};          // its tension cut-off                          [stress]
  double tolerance{};  // Euler error a substep, relative to the stress; Heun is far better
};

struct HyperbolicAnswer {
  Vector4 sigma;
  Matrix4 J;      // d sigma / d deps
  Matrix4 D;      // mean isotropic stiffness over the step: sigma - sigma0 = D deps while no surface is reached
  double memory;  // largest stress state number
  PointStatus status;
  bool accurate;  // false: not within the tolerance with the largest number of substeps
};

// Largest and smallest compression at a stress (tension positive in).
struct Extremes {
  double sigma_1, sigma_3;         // compression positive
  Vector4 gradient_1, gradient_3;  // d sigma_1/d sigma, d sigma_3/d sigma
};
Extremes extremes(const Vector4& sigma, bool in_plane);

HyperbolicAnswer integrate(const HyperbolicSteps& steps, const Vector4& sigma0, const Vector4& deps,
                           double memory);

// PathError.  With compliances linear in the stress, volume and shear strain lag halfway by
// a = (K1-K0)/(4(K0+K1)) and (G1-G0)/(4(G0+G1)) of their increments, not alike, and neighbours still
// differently: the strain path bends by up to a.  A stress about a |d sigma| off changes the moduli by about a of its share,
// so the end is off by 3 a^2 |d sigma|; the 3 is measured, in triaxial tests and under footings.
double path_error(const HyperbolicSteps& steps, const PointIn<4>& in, const Vector4& sigma, double memory0,
                  double memory1);

// The planes that touch the strength envelope sigma_1 = sigma_3 + (sigma_1 - sigma_3)_f at a given sigma_3.
MohrCoulombPlanes tangent_planes(const HyperbolicSteps& steps, double sigma_3);

}  // namespace sage
