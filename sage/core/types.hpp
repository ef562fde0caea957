// Fixed-size algebra used across the program.
// Components of a solid tensor: [xx yy zz xy]; zz is out of plane (plane strain) or hoop (axisymmetric).
// Strain carries the engineering shear gamma_xy.  Inside the program tension is positive.
#pragma once

#include <Eigen/Core>

namespace sage {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;
template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

using Vector2 = Vector<2>;
using Vector4 = Vector<4>;
using Matrix2 = Matrix<2>;
using Matrix4 = Matrix<4>;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace sage
