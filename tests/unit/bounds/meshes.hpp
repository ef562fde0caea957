// Meshes of blocks for tests of bounds.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "sage/bounds/domain.hpp"

namespace sage::bounds {

// From a (small steps) to b, each step `ratio` times the one before.
inline std::vector<double> graded(double a, double b, int steps, double ratio) {
  std::vector<double> x{a};
  double sum = 0.0, step = 1.0;
  for (int i = 0; i < steps; ++i, step *= ratio) sum += step;
  step = (b - a) / sum;
  for (int i = 0; i < steps; ++i, step *= ratio) x.push_back(x.back() + step);
  return x;
}

// Both lists joined at their common first place, the first one reversed.
inline std::vector<double> both_ways(std::vector<double> down, const std::vector<double>& up) {
  std::reverse(down.begin(), down.end());
  down.insert(down.end(), up.begin() + 1, up.end());
  return down;
}

// Four triangles in every cell that is wanted.  Held: the lowest side in x and y, the outer left and right in x.
inline Domain block(const std::vector<double>& X, const std::vector<double>& Y,
                    const std::function<bool(double, double)>& wanted = {}) {
  Domain d;
  const std::size_t nx = X.size();
  std::vector<int> number(nx * Y.size(), -1);
  const auto node = [&](std::size_t i, std::size_t j) {
    int& n = number[j * nx + i];
    if (n < 0) {
      n = static_cast<int>(d.x.size());
      d.x.emplace_back(X[i], Y[j]);
    }
    return n;
  };
  const auto hold = [&](int a, int b, bool y) { d.boundary.push_back({.a = a, .b = b, .held = {true, y}}); };
  for (std::size_t j = 0; j + 1 < Y.size(); ++j)
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      const Vector2 middle(0.5 * (X[i] + X[i + 1]), 0.5 * (Y[j] + Y[j + 1]));
      if (wanted && !wanted(middle.x(), middle.y())) continue;
      const std::array<int, 4> q{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
      const int centre = static_cast<int>(d.x.size());
      d.x.push_back(middle);
      for (std::size_t k = 0; k < 4; ++k) d.triangles.push_back({{q[k], q[(k + 1) % 4], centre}, 0, 0});
      if (j == 0) hold(q[0], q[1], true);
      if (i == 0) hold(q[3], q[0], false);
      if (i + 2 == nx) hold(q[1], q[2], false);
    }
  return d;
}

// Sides along the level y between two places: acts on their boundary entries, which are made where there are none.
inline void along_level(Domain& d, double y, double from, double to,
                        const std::function<void(Boundary&)>& act) {
  for (const Edge& edge : edges_of(d).all) {
    if (edge.triangle[1] >= 0) continue;
    const Vector2 &a = d.x[edge.a], &b = d.x[edge.b];
    const double low = std::min(a.x(), b.x()), high = std::max(a.x(), b.x());
    if (std::abs(a.y() - y) + std::abs(b.y() - y) > 1e-9 || low < from - 1e-9 || high > to + 1e-9) continue;
    Boundary one{.a = edge.a, .b = edge.b};
    act(one);
    d.boundary.push_back(one);
  }
}

}  // namespace sage::bounds
