// Numbers that carry their derivatives, so that a law is written once, as the paper prints it, and its tangent
// can't disagree with its stress.  v is the value, d the derivatives with respect to N chosen variables.
#pragma once

#include <cmath>

#include "sage/core/types.hpp"

namespace sage {

template <int N>
struct Dual {
  double v = 0.0;
  Vector<N> d = Vector<N>::Zero();

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: a constant; implicit so that formulas read as printed
  Dual(double value, const Vector<N>& derivative) : v(value), d(derivative) {}

  // The variable number i, dv/dv = 1.
  static Dual variable(double value, int i) { return {value, Vector<N>::Unit(i)}; }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.v / b.v;
    return {q, (a.d - q * b.d) / b.v};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
};

template <int N>
Dual<N> max(const Dual<N>& a, const Dual<N>& b) {
  return a < b ? b : a;
}
template <int N>
Dual<N> min(const Dual<N>& a, const Dual<N>& b) {
  return b < a ? b : a;
}
template <int N>
Dual<N> sqrt(const Dual<N>& a) {
  const double root = std::sqrt(a.v);
  return {root, a.d / (2.0 * root)};
}
template <int N>
Dual<N> log(const Dual<N>& a) {
  return {std::log(a.v), a.d / a.v};
}
template <int N>
Dual<N> exp(const Dual<N>& a) {
  const double e = std::exp(a.v);
  return {e, e * a.d};
}
template <int N>
Dual<N> sin(const Dual<N>& a) {
  return {std::sin(a.v), std::cos(a.v) * a.d};
}
template <int N>
Dual<N> cos(const Dual<N>& a) {
  return {std::cos(a.v), -std::sin(a.v) * a.d};
}
template <int N>
Dual<N> pow(const Dual<N>& a, double n) {
  const double power = std::pow(a.v, n);
  return {power, n * power / a.v * a.d};
}

}  // namespace sage
