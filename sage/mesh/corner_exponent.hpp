// How smooth the elastic solution is at a corner of one material (Williams 1952).  Not part of the public interface.
#pragma once

namespace sage::mesh {

enum class Side {
  free,
  held,
  across,  // held at right angles to itself, free to slide: a line of symmetry
  along,   // held along itself, free to lift: a line of antisymmetry
};

// From this exponent on the displacements ~ rho^lambda, and with them stresses ~ rho^(lambda - 1), have slopes
// without bound no more.
inline constexpr double kSmoothExponent = 2.0;

// The smallest real part lambda > 0 of the exponents at a corner between two sides, of those that are no whole numbers
// (their displacements are polynomials).  angle: of the material, radians.  Only exponents below kSmoothExponent are looked
// for; where there is none, that.  Plane strain; in a ring the same.
double corner_exponent(Side a, Side b, double angle, double poissons_ratio);

}  // namespace sage::mesh
