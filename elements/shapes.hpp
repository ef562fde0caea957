// Shape functions: for each shape its nodes in parent coordinates, N and dN/d(xi, eta), and its edges.
// Corners come first, counter-clockwise, then mid-side nodes edge by edge, then inner nodes (the order of
// Gmsh). Squares use (-1, 1)^2.  Triangles use xi = L2, eta = L3, so that node 1 is (0, 0).
#pragma once

#include <array>
#include <vector>

#include "sage/core/types.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

using ParentPoint = std::array<double, 2>;
using EdgeNodes = std::vector<std::vector<int>>;

// Polynomial that is fitted to the stress of the points to find it at the nodes:
// {1}, {1 xi}, {1 xi xi^2}, {1 xi eta}, {1 xi eta xi.eta}, {1 xi eta xi^2 xi.eta eta^2}.  tensor: all that n x
// n points can tell, degree n - 1 in xi and in eta; tensor_lower: degree n - 2.
enum class Basis { constant, line_linear, line_quadratic, linear, bilinear, quadratic, tensor, tensor_lower };

// ---- lines: end, end, inner nodes in order ----

struct Line2 {
  static constexpr int nodes = 2;
  static constexpr std::array<double, 2> node_xi{-1.0, 1.0};
  static Vector<2> N(double xi) { return {0.5 * (1.0 - xi), 0.5 * (1.0 + xi)}; }
  static Vector<2> dN(double /*xi*/) { return {-0.5, 0.5}; }
};

struct Line3 {
  static constexpr int nodes = 3;
  static constexpr std::array<double, 3> node_xi{-1.0, 1.0, 0.0};
  static Vector<3> N(double xi) { return {0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi}; }
  static Vector<3> dN(double xi) { return {xi - 0.5, xi + 0.5, -2.0 * xi}; }
};

struct Line5 {
  static constexpr int nodes = 5;
  static constexpr std::array<double, 5> node_xi{-1.0, 1.0, -0.5, 0.0, 0.5};
  static Vector<5> N(double xi);
  static Vector<5> dN(double xi);
};

// ---- quadrilaterals ----

// Bilinear.  N_i = (1 + xi xi_i)(1 + eta eta_i) / 4
struct Quad4 {
  static constexpr int nodes = 4, corners = 4, degree = 1;
  static constexpr std::array<ParentPoint, 4> node_at{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static constexpr Basis stress_basis = Basis::bilinear;
  using Edge = Line2;
  using LoadRule = GaussSquare<2>;  // exact for N r detJ
  static Vector<4> N(const ParentPoint& q);
  static Eigen::Matrix<double, 4, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

// Serendipity.  Corners (1 + xi xi_i)(1 + eta eta_i)(xi xi_i + eta eta_i - 1) / 4, mid-sides (1 - xi^2)(1 + eta
// eta_i) / 2
struct Quad8 {
  static constexpr int nodes = 8, corners = 4, degree = 2;
  static constexpr std::array<ParentPoint, 8> node_at{
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  static constexpr Basis stress_basis = Basis::bilinear;
  using Edge = Line3;
  using LoadRule = GaussSquare<4>;
  static Vector<8> N(const ParentPoint& q);
  static Eigen::Matrix<double, 8, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

// Biquadratic: products of Line3; node 9 is the centre.
struct Quad9 {
  static constexpr int nodes = 9, corners = 4, degree = 2;
  static constexpr std::array<ParentPoint, 9> node_at{
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}}};
  static constexpr Basis stress_basis = Basis::bilinear;
  using Edge = Line3;
  using LoadRule = GaussSquare<4>;
  static Vector<9> N(const ParentPoint& q);
  static Eigen::Matrix<double, 9, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

// ---- triangles ----

// N_i = L_i
struct Tri3 {
  static constexpr int nodes = 3, corners = 3, degree = 1;
  static constexpr std::array<ParentPoint, 3> node_at{{{0, 0}, {1, 0}, {0, 1}}};
  static constexpr Basis stress_basis = Basis::linear;
  using Edge = Line2;
  using LoadRule = Triangle3;
  static Vector<3> N(const ParentPoint& q);
  static Eigen::Matrix<double, 3, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

// Corners L_i (2 L_i - 1), mid-sides 4 L_i L_j
struct Tri6 {
  static constexpr int nodes = 6, corners = 3, degree = 2;
  static constexpr std::array<ParentPoint, 6> node_at{{{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}}};
  static constexpr Basis stress_basis = Basis::linear;
  using Edge = Line3;
  using LoadRule = Triangle12;
  static Vector<6> N(const ParentPoint& q);
  static Eigen::Matrix<double, 6, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

// Quartic: three nodes inside each edge and three inside the triangle.
// N = P_i(L1) P_j(L2) P_k(L3), i + j + k = 4, P_m(L) = prod_{s<m} (4 L - s) / (s + 1).
struct Tri15 {
  static constexpr int nodes = 15, corners = 3, degree = 4;
  static constexpr std::array<ParentPoint, 15> node_at{{{0, 0},
                                                        {1, 0},
                                                        {0, 1},
                                                        {.25, 0},
                                                        {.5, 0},
                                                        {.75, 0},
                                                        {.75, .25},
                                                        {.5, .5},
                                                        {.25, .75},
                                                        {0, .75},
                                                        {0, .5},
                                                        {0, .25},
                                                        {.25, .25},
                                                        {.5, .25},
                                                        {.25, .5}}};
  static constexpr Basis stress_basis = Basis::quadratic;
  using Edge = Line5;
  using LoadRule = Triangle16;
  static Vector<15> N(const ParentPoint& q);
  static Eigen::Matrix<double, 15, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

}  // namespace sage
