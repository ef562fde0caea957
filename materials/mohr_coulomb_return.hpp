// Return to the planes of Mohr-Coulomb and of a tension cut-off, in principal stresses.
// Clausen, Damkilde & Andersen (2006, 2007); docs/theory/mohr_coulomb.md
#pragma once

#include "materials/linear_elastic.hpp"
#include "materials/stress_measures.hpp"
#include "sage/core/law.hpp"

namespace sage {

// With s1 >= s2 >= s3, tension positive:  f = N s1 - s3 - Y <= 0 and s1 <= T; flow g = M s1 - s3.
struct MohrCoulombPlanes {
  double N;  // (1 + sin phi)/(1 - sin phi)                                  [-]
  double Y;  // 2 c sqrt(N), the unconfined compressive strength             [stress]
  double M;  // N with the dilation angle                                    [-]
  double T;  // tension cut-off, infinite for none; the apex counts anyway   [stress]

  double apex() const;  // s1 = s2 = s3 = Y/(N-1), infinite for N = 1
};

struct MohrCoulombReturn {
  Vector4 sigma;
  Matrix4 R;  // d sigma/d sigma_trial; the tangent is R D_elastic
  PointStatus status;
};

// f > 0 or s1 > T by more than rounding?
bool outside(const MohrCoulombPlanes& planes, const Principal& sigma);
inline bool outside(const MohrCoulombPlanes& planes, const Vector4& sigma) {
  return outside(planes, principal(sigma));
}

// For a trial stress that is outside.  Finds the set of active planes whose multipliers are not negative and
// whose stress keeps the order of the principals; the apex where there is none.
MohrCoulombReturn return_to_planes(const MohrCoulombPlanes& planes, const ElasticModuli& elastic,
                                   const Principal& trial);
inline MohrCoulombReturn return_to_planes(const MohrCoulombPlanes& planes, const ElasticModuli& elastic,
                                          const Vector4& trial) {
  return return_to_planes(planes, elastic, principal(trial));
}

// Planes that move with one number, such as a plastic strain, and how fast.
struct MovingPlanes {
  MohrCoulombPlanes planes;
  MohrCoulombPlanes rates;  // d/d(number) of N, Y, M and T
};

struct MovedReturn {
  MohrCoulombReturn back;
  Vector4 rate;   // d(back.sigma)/d(number) at a constant trial stress
  Vector4 first;  // d(largest principal stress)/d(back.sigma), while the axes are those of the trial stress
};

// The return to planes where they are, with what it needs to find the number that a law wants.
MovedReturn return_to_moving_planes(const MovingPlanes& moving, const ElasticModuli& elastic,
                                    const Vector4& trial);

}  // namespace sage
