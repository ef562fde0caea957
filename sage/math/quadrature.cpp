#include "sage/math/quadrature.hpp"

#include <cmath>
#include <numbers>

namespace sage {

// Newton's method for the zeros of the Legendre polynomial.
std::vector<LinePoint> gauss_line(int points) {
  std::vector<LinePoint> line;
  for (int i = 0; i < points; ++i) {
    double t = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double p0 = 1.0, p1 = t;
      for (int k = 2; k <= points; ++k) {
        const double next = ((2 * k - 1) * t * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = next;
      }
      slope = points * (t * p1 - p0) / (t * t - 1.0);
      const double change = p1 / slope;
      t -= change;
      if (std::abs(change) < 1e-16) break;
    }
    line.push_back({t, 2.0 / ((1.0 - t * t) * slope * slope)});
  }
  return line;
}

std::vector<RulePoint> gauss_area(bool triangle, int n) {
  const std::vector<LinePoint> line = gauss_line(n);
  std::vector<RulePoint> rule;
  for (const LinePoint& a : line)
    for (const LinePoint& b : line) {
      if (!triangle) {
        rule.push_back({a.xi, b.xi, a.w * b.w});
        continue;
      }
      const double s = 0.5 * (1.0 + a.xi), t = 0.5 * (1.0 + b.xi);
      rule.push_back({s, (1.0 - s) * t, 0.25 * a.w * b.w * (1.0 - s)});
    }
  return rule;
}

}  // namespace sage
