// Whether a field is what a bound needs, from the field alone.
#pragma once

#include "sage/bounds/cone_program.hpp"

namespace sage::bounds {

// What the check of one field found.
struct Check {
  // Largest error of equilibrium or of the flow rule, and least distance to yield or of a strain rate to the limit of
  // dilation (negative = beyond).  Both relative.
  double residual = 0.0, reserve = 0.0;
  double value = 0.0;                                                     // tau, in the units of the program
  bool passed() const { return residual <= 1e-11 && reserve >= -1e-14; }  // rounding
};

// Equilibrium and yield of a stress field.  sigma: 3 x points.
Check check_stress(const ConeProgram& program, const Eigen::Matrix3Xd& sigma, double tau);

// Flow rule of a velocity field and the power of dissipation.  u: one entry an equation.  A field in which the live loads do no
// work has a reserve of -1.
Check check_velocity(const ConeProgram& program, const Eigen::VectorXd& u);

}  // namespace sage::bounds
