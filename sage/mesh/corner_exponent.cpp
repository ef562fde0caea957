// With displacements rho^lambda f(theta) the conditions on both sides give one equation for lambda.  kappa = 3 - 4 nu:
//   both alike    q sin(lambda a) - lambda sin(a) = 0  (symmetric about the bisector), + (antisymmetric),
//                 q = kappa where held, -1 where free
//   held and free kappa sin^2(lambda a) + lambda^2 sin^2(a) = 4 (1 - nu)^2
// A side that is held across or along is the bisector of twice the corner.
#include "sage/mesh/corner_exponent.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace sage::mesh {

namespace {

using Complex = std::complex<double>;

// Value and slope at lambda.
using ValueAndSlope = std::pair<Complex, Complex>;

struct AlikeSides {
  double q, sign, angle;
  ValueAndSlope operator()(Complex lambda) const {
    return {q * std::sin(lambda * angle) - sign * lambda * std::sin(angle),
            q * angle * std::cos(lambda * angle) - sign * std::sin(angle)};
  }
};

struct HeldAndFree {
  double nu, angle;
  ValueAndSlope operator()(Complex lambda) const {
    const double kappa = 3.0 - 4.0 * nu, s = std::sin(angle);
    const Complex sine = std::sin(lambda * angle), cosine = std::cos(lambda * angle);
    return {kappa * sine * sine + s * s * lambda * lambda - 4.0 * (1.0 - nu) * (1.0 - nu),
            2.0 * kappa * angle * sine * cosine + 2.0 * s * s * lambda};
  }
};

bool counts(Complex lambda) {
  constexpr double kWhole = 1e-6, kLeast = 0.05;
  if (!(lambda.real() > kLeast && lambda.real() < kSmoothExponent)) return false;
  return std::abs(lambda - std::round(lambda.real())) > kWhole;
}

// By Newton's method from places all over the strip 0 < Re lambda < 2.
template <class Equation>
double smallest_root(const Equation& equation) {
  constexpr int kColumns = 10, kRows = 6, kMostSteps = 40;
  constexpr double kFar = 6.0, kSmall = 1e-12;
  double smallest = kSmoothExponent;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int column = i % kColumns, row = i / kColumns;
    Complex lambda(0.21 * (1 + column), 0.31 * row);
    for (int step = 0; step < kMostSteps && std::abs(lambda) < kFar; ++step) {
      const auto [value, slope] = equation(lambda);
      const Complex change = value / slope;
      lambda -= change;
      if (std::abs(change) > kSmall) continue;
      if (counts(lambda)) smallest = std::min(smallest, lambda.real());
      break;
    }
  }
  return smallest;
}

// Between two sides that are held across or along: sin((lambda +- 1) a) = 0 where they are alike, else cos.
double between_mirrors(bool alike, double angle) {
  double smallest = kSmoothExponent;
  for (int k = 0; k <= 12; ++k)
    for (const double one : {-1.0, 1.0}) {
      const double lambda = (k + (alike ? 0.0 : 0.5)) * std::numbers::pi / angle + one;
      if (counts(lambda)) smallest = std::min(smallest, lambda);
    }
  return smallest;
}

}  // namespace

double corner_exponent(Side a, Side b, double angle, double nu) {
  const auto is_mirror = [](Side side) { return side == Side::across || side == Side::along; };
  const auto q = [&](Side side) { return side == Side::held ? 3.0 - 4.0 * nu : -1.0; };
  if (is_mirror(a) && is_mirror(b)) return between_mirrors(a == b, angle);
  if (is_mirror(a)) std::swap(a, b);
  if (is_mirror(b)) return smallest_root(AlikeSides{q(a), b == Side::across ? 1.0 : -1.0, 2.0 * angle});
  if (a == b)
    return std::min(smallest_root(AlikeSides{q(a), 1.0, angle}), smallest_root(AlikeSides{q(a), -1.0, angle}));
  return smallest_root(HeldAndFree{nu, angle});
}

}  // namespace sage::mesh
