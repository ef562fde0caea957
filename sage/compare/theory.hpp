// What theory expects of two runs side by side, where it expects anything: found from the scenes.
#pragma once

#include "sage/compare/side.hpp"

namespace sage::compare {

// found against expected, and in words why and under which condition.  NaN in `found` = the runs don't show it.
struct Expectation {
  std::string what;
  double expected = 0.0, found = 0.0;
  std::string unit;  // "-" for ratios
  std::string why;
};

// Drained strength of a perfectly plastic point compressed along y under the lateral stress sigma3 (compression
// +): deviator at failure; infinite where the cone has none, NaN where the law is not one of the two.
double strength_deviator(const Material& material, Geometry geometry, double sigma3);

// Friction angle phi* [rad] and cohesion c* to which a Drucker-Prager cone (alpha, k) with flow beta is equal
// in plane-strain collapse: sin phi* = 3 alpha sqrt(1-3 beta^2)/(1-3 alpha beta), c* cos phi* = k sqrt(1-3
// beta^2)/(1-3 alpha beta).  phi* = NaN where the sine is 1 or more: no strength limit in plane strain.
struct PlaneStrainStrength {
  double phi = 0.0, c = 0.0;
};
PlaneStrainStrength plane_strain_strength(double alpha, double k, double beta);

// Apparent modulus of a stage, d(mean stress of the top) / d(strain of the height); NaN without a strain.
double apparent_modulus(const Side& side, std::size_t stage);

// Whether the former means something for a stage: the mesh fills its box, and bottom and top stay plane over
// the stage, as between platens or under an even pressure.
bool uniform_ends(const Side& side, std::size_t stage);

// The largest |sigma_zz - sigma_zz0 - nu (d sigma_xx + d sigma_yy)| over the points of linear elastic groups,
// divided by the largest stress change there; NaN where there is no such group.
double plane_strain_defect(const Side& side);

// What theory expects of B / A for the last value of a report's column ("fy"); NaN, and why = "nothing is
// known", where it expects nothing.
struct ExpectedRatio {
  double value = 0.0;
  std::string why;
};
ExpectedRatio expected_ratio(const Side& a, const Side& b, std::size_t report, const std::string& column);

std::vector<Expectation> expectations(const Side& a, const Side& b);

}  // namespace sage::compare
