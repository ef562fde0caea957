#include "sage/bounds/check.hpp"

#include <algorithm>
#include <cmath>

#include "sage/math/dense.hpp"

namespace sage::bounds {

Check check_stress(const ConeProgram& program, const Eigen::Matrix3Xd& sigma, double tau) {
  Check check;
  check.value = tau;
  const Eigen::VectorXd loads = program.b0 + tau * program.b1, rest = loads - forces(program, sigma);
  const double size =
      std::max(program.b0.cwiseAbs().maxCoeff(), std::abs(tau) * program.b1.cwiseAbs().maxCoeff());
  check.residual = rest.cwiseAbs().maxCoeff() / std::max(size, 1e-300);
  double least = 1e300, largest = 0.0;
  for (std::size_t c = 0; c < program.cones.size(); ++c) {
    const Cone& cone = program.cones[c];
    const Vector3 s = cone.h0 + tau * cone.h1 - cone.G * sigma.col(static_cast<Eigen::Index>(c));
    least = std::min(least, s[0] - std::hypot(s[1], s[2]));
    largest = std::max(largest, s[0]);
  }
  check.reserve = least / largest;
  return check;
}

Check check_velocity(const ConeProgram& program, const Eigen::VectorXd& u) {
  Check check;
  const Eigen::Matrix3Xd e = strains(program, u);
  double scale = 0.0, dissipation = 0.0, strength = 0.0, least = 1e300, residual = 0.0;
  for (std::size_t c = 0; c < program.cones.size(); ++c) {
    const Cone& cone = program.cones[c];
    const auto k = static_cast<Eigen::Index>(c);
    const Matrix3 back = dense_matrix::pseudo_inverse(cone.G);
    Vector3 z = back.transpose() * e.col(k);
    residual = std::max(residual, (e.col(k) - cone.G.transpose() * z).cwiseAbs().maxCoeff());
    const double bent = std::hypot(z[1], z[2]);
    if (cone.G.row(0).isZero())
      z[0] = bent;
    else
      least = std::min(least, z[0] - bent);
    scale = std::max(scale, z[0]);
    dissipation += cone.h0.dot(z);
    strength += cone.h1.dot(z);
  }
  check.residual = residual / std::max(scale, 1e-300);
  check.reserve = least > 1e299 ? 0.0 : least / std::max(scale, 1e-300);
  const double power = program.b1.dot(u) - strength;
  check.value = (dissipation - program.b0.dot(u)) / power;
  if (!(power > 0.0)) check.reserve = -1.0;
  return check;
}

}  // namespace sage::bounds
