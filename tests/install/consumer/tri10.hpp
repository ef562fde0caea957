// An element of one's own: the ten-node triangle, cubic, behind sage/core/element.hpp.  This is the example of
// elements/README.md.
#pragma once

#include <array>
#include <cmath>

#include "elements/solid_entry.hpp"

namespace own {

using namespace sage;

struct Line4 {
  static constexpr int nodes = 4;
  static constexpr std::array<double, 4> node_xi{-1.0, 1.0, -1.0 / 3.0, 1.0 / 3.0};
  static Vector<4> N(double xi) {
    Vector<4> N = Vector<4>::Ones();
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i) N(static_cast<int>(i)) *= (xi - node_xi[j]) / (node_xi[i] - node_xi[j]);
    return N;
  }
  static Vector<4> dN(double xi) {
    Vector<4> dN = Vector<4>::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      double value = 1.0, slope = 0.0;
      for (std::size_t j = 0; j < 4; ++j) {
        if (j == i) continue;
        const double d = node_xi[i] - node_xi[j];
        slope = slope * (xi - node_xi[j]) / d + value / d;
        value *= (xi - node_xi[j]) / d;
      }
      dN(static_cast<int>(i)) = slope;
    }
    return dN;
  }
};

// N = P_i(L1) P_j(L2) P_k(L3), i + j + k = 3, P_m(L) = prod_{s<m} (3 L - s) / (s + 1).
struct Tri10 {
  static constexpr int nodes = 10, corners = 3, degree = 3;
  static constexpr double third = 1.0 / 3.0, two = 2.0 / 3.0;
  static constexpr std::array<ParentPoint, 10> node_at{{{0, 0},
                                                        {1, 0},
                                                        {0, 1},
                                                        {third, 0},
                                                        {two, 0},
                                                        {two, third},
                                                        {third, two},
                                                        {0, two},
                                                        {0, third},
                                                        {third, third}}};
  static constexpr Basis stress_basis = Basis::quadratic;
  using Edge = Line4;
  using LoadRule = Triangle16;

  // P_m and its derivative.
  static std::array<double, 2> factor(long m, double L) {
    double value = 1.0, slope = 0.0;
    for (long s = 0; s < m; ++s) {
      const double d = static_cast<double>(s) + 1.0, f = (3.0 * L - static_cast<double>(s)) / d;
      slope = slope * f + value * 3.0 / d;
      value *= f;
    }
    return {value, slope};
  }
  static std::array<std::array<double, 2>, 3> factors(const ParentPoint& q, std::size_t node) {
    const long j = std::lround(3.0 * node_at[node][0]), k = std::lround(3.0 * node_at[node][1]);
    return {factor(3 - j - k, 1.0 - q[0] - q[1]), factor(j, q[0]), factor(k, q[1])};
  }
  static Vector<10> N(const ParentPoint& q) {
    Vector<10> N;
    for (std::size_t i = 0; i < 10; ++i) {
      const auto f = factors(q, i);
      N(static_cast<int>(i)) = f[0][0] * f[1][0] * f[2][0];
    }
    return N;
  }
  static Eigen::Matrix<double, 10, 2> dN(const ParentPoint& q) {
    Eigen::Matrix<double, 10, 2> dN;
    for (std::size_t i = 0; i < 10; ++i) {
      const auto f = factors(q, i);
      const double along = f[0][1] * f[1][0] * f[2][0];  // d/dL1
      dN.row(static_cast<int>(i)) << f[0][0] * f[1][1] * f[2][0] - along, f[0][0] * f[1][0] * f[2][1] - along;
    }
    return dN;
  }
  static const EdgeNodes& edges() {
    static const EdgeNodes edges{{0, 1, 3, 4}, {1, 2, 5, 6}, {2, 0, 7, 8}};
    return edges;
  }
};

// VTK and Gmsh count its nodes as it does.
inline ElementEntry tri10() {
  ElementEntry entry = with_shape<Tri10>({.name = "tri10", .summary = "ten-node triangle, cubic"});
  entry.vtk = {69, {}};
  entry.gmsh = {21, {}};
  return element_entry(entry, {solid<Tri10, Triangle12>({1, "twelve points", "degree 6"}, "tri10")});
}

}  // namespace own
