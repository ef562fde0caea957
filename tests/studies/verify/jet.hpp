// A function of two variables with its first and second derivatives, for manufactured solutions: the field is
// written once and its strain, stress and body force follow.
#pragma once

#include <cmath>

namespace sage::verify {

struct Jet {
  double v = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  static Jet first(double value) { return {value, 1.0, 0.0, 0.0, 0.0, 0.0}; }
  static Jet second(double value) { return {value, 0.0, 1.0, 0.0, 0.0, 0.0}; }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.v + b.v, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  friend Jet operator*(double c, const Jet& a) {
    return {c * a.v, c * a.x, c * a.y, c * a.xx, c * a.xy, c * a.yy};
  }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + (-1.0) * b; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.v * b.v,
            a.x * b.v + a.v * b.x,
            a.y * b.v + a.v * b.y,
            a.xx * b.v + 2.0 * a.x * b.x + a.v * b.xx,
            a.xy * b.v + a.x * b.y + a.y * b.x + a.v * b.xy,
            a.yy * b.v + 2.0 * a.y * b.y + a.v * b.yy};
  }
};

// f(a) from f, f' and f''.
inline Jet chain(const Jet& a, double f, double df, double ddf) {
  return {f,
          df * a.x,
          df * a.y,
          df * a.xx + ddf * a.x * a.x,
          df * a.xy + ddf * a.x * a.y,
          df * a.yy + ddf * a.y * a.y};
}
inline Jet sin(const Jet& a) {
  return chain(a, std::sin(a.v), std::cos(a.v), -std::sin(a.v));
}
inline Jet cos(const Jet& a) {
  return chain(a, std::cos(a.v), -std::sin(a.v), -std::cos(a.v));
}

}  // namespace sage::verify
