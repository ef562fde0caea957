// Quadrilaterals of any even degree p: products of Lagrange polynomials through the Gauss-Lobatto
// points, which keep high degrees well-conditioned (Szabo & Babuska 1991; Karniadakis & Sherwin 2005).
// Nodes: corners, then the inner nodes of each edge in its counter-clockwise direction, then the nodes
// inside row by row, xi fastest.
#pragma once

#include "elements/shapes.hpp"

namespace sage {

// -1, 1 and the zeros of P_p' between them, in rising order.
template <int p>
constexpr std::array<double, static_cast<std::size_t>(p) + 1> gauss_lobatto();

template <>
constexpr std::array<double, 5> gauss_lobatto<4>() {
  return {-1.0, -0.6546536707079771438, 0.0, 0.6546536707079771438, 1.0};
}

template <>
constexpr std::array<double, 7> gauss_lobatto<6>() {
  return {-1.0, -0.83022389627856692987, -0.4688487934707142138,
          0.0,  0.4688487934707142138,   0.83022389627856692987,
          1.0};
}

template <>
constexpr std::array<double, 9> gauss_lobatto<8>() {
  return {-1.0, -0.89975799541146015731, -0.67718627951073775345, -0.36311746382617815871,
          0.0,  0.36311746382617815871,  0.67718627951073775345,  0.89975799541146015731,
          1.0};
}

// Place in rising order (0, p, 1, 2 ... p - 1) of a node of the line: end, end, inner nodes in order.
template <int p>
constexpr int lobatto_rising(int node) {
  return node == 0 ? 0 : node == 1 ? p : node - 1;
}

// Nodes of the line; columns and rows (0 ... p) of the square's nodes; and their places.
template <int p>
constexpr auto lobatto_line_nodes() {
  std::array<double, static_cast<std::size_t>(p) + 1> xi{};
  for (int i = 0; i <= p; ++i) xi[i] = gauss_lobatto<p>()[lobatto_rising<p>(i)];
  return xi;
}
template <int p>
constexpr auto lobatto_grid() {
  std::array<std::array<int, 2>, static_cast<std::size_t>((p + 1) * (p + 1))> at{
      {{0, 0}, {p, 0}, {p, p}, {0, p}}};
  std::size_t n = 4;
  for (int i = 1; i < p; ++i) at[n++] = {i, 0};
  for (int i = 1; i < p; ++i) at[n++] = {p, i};
  for (int i = 1; i < p; ++i) at[n++] = {p - i, p};
  for (int i = 1; i < p; ++i) at[n++] = {0, p - i};
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) at[n++] = {i, j};
  return at;
}
template <int p>
constexpr auto lobatto_nodes() {
  constexpr auto grid = lobatto_grid<p>();
  std::array<ParentPoint, grid.size()> at{};
  for (std::size_t i = 0; i < at.size(); ++i)
    at[i] = {gauss_lobatto<p>()[grid[i][0]], gauss_lobatto<p>()[grid[i][1]]};
  return at;
}

template <int p>
struct LobattoLine {
  static constexpr int nodes = p + 1;
  static constexpr auto node_xi = lobatto_line_nodes<p>();
  static Vector<nodes> N(double xi);
  static Vector<nodes> dN(double xi);
};

template <int p>
struct LobattoQuad {
  static constexpr int nodes = (p + 1) * (p + 1), corners = 4, degree = p;
  static constexpr auto grid = lobatto_grid<p>();
  static constexpr auto node_at = lobatto_nodes<p>();
  static constexpr Basis stress_basis = Basis::tensor_lower;
  using Edge = LobattoLine<p>;
  using LoadRule = GaussSquare<p + 1>;
  static Vector<nodes> N(const ParentPoint& q);
  static Eigen::Matrix<double, nodes, 2> dN(const ParentPoint& q);
  static const EdgeNodes& edges();
};

}  // namespace sage
