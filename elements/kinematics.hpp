// The only difference between the two geometries.  x is r and y is z when axisymmetric;
// the ring is a full circle.
#pragma once

#include "sage/core/element.hpp"

namespace sage {

struct PlaneStrain {
  static constexpr Geometry geometry = Geometry::plane_strain;
  // Thickness that an area of the mesh stands for: 1 (unit length).
  template <class Real>
  static Real measure(const Real& /*x*/) {
    return Real{} + 1.0;
  }
  // Strain zz per unit displacement in x of a node.
  static double hoop(double /*N*/, double /*x*/) { return 0.0; }
};

struct Axisymmetric {
  static constexpr Geometry geometry = Geometry::axisymmetric;
  // Circumference of the full circle: 2 pi r.                                      [chapter 7, Eq 7.22]
  template <class Real>
  static Real measure(const Real& r) {
    return 2.0 * kPi * r;
  }
  // eps_theta = u_r / r.  Integration points have r > 0, so r = 0 never arrives here.
  static double hoop(double N, double r) { return N / r; }
};

}  // namespace sage
