#include "elements/shapes.hpp"

#include <cstddef>

namespace sage {

namespace {

// The inner nodes of Line5, and a node's place along [-1, 1] in Line3 from its coordinate.
int line3_node(double xi) {
  return xi < 0.0 ? 0 : (xi > 0.0 ? 1 : 2);
}

// P_m(L) of Tri15 and its derivative.
struct Factor {
  double value, slope;
};

Factor lagrange_factor(int m, double L) {
  Factor f{1.0, 0.0};
  for (int s = 0; s < m; ++s) {
    const double a = (4.0 * L - s) / (s + 1.0);
    f.slope = f.slope * a + f.value * 4.0 / (s + 1.0);
    f.value *= a;
  }
  return f;
}

struct Factors {
  Factor L1, L2, L3;
};

Factors tri15_factors(std::size_t node, const ParentPoint& q) {
  const int j = static_cast<int>(4.0 * Tri15::node_at[node][0]);
  const int k = static_cast<int>(4.0 * Tri15::node_at[node][1]);
  return {lagrange_factor(4 - j - k, 1.0 - q[0] - q[1]), lagrange_factor(j, q[0]), lagrange_factor(k, q[1])};
}

}  // namespace

// Lagrange: N_i = prod_{j != i} (xi - xi_j) / (xi_i - xi_j)
Vector<5> Line5::N(double xi) {
  Vector<5> N = Vector<5>::Ones();
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      if (j != i) N(static_cast<int>(i)) *= (xi - node_xi[j]) / (node_xi[i] - node_xi[j]);
  return N;
}

Vector<5> Line5::dN(double xi) {
  Vector<5> dN = Vector<5>::Zero();
  for (std::size_t i = 0; i < 5; ++i) {
    double value = 1.0, slope = 0.0;
    for (std::size_t j = 0; j < 5; ++j) {
      if (j == i) continue;
      const double d = node_xi[i] - node_xi[j];
      slope = slope * (xi - node_xi[j]) / d + value / d;
      value *= (xi - node_xi[j]) / d;
    }
    dN(static_cast<int>(i)) = slope;
  }
  return dN;
}

Vector<4> Quad4::N(const ParentPoint& q) {
  Vector<4> N;
  for (std::size_t i = 0; i < 4; ++i)
    N(static_cast<int>(i)) = 0.25 * (1.0 + q[0] * node_at[i][0]) * (1.0 + q[1] * node_at[i][1]);
  return N;
}

Eigen::Matrix<double, 4, 2> Quad4::dN(const ParentPoint& q) {
  Eigen::Matrix<double, 4, 2> dN;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [a, b] = node_at[i];
    dN.row(static_cast<int>(i)) << 0.25 * a * (1.0 + q[1] * b), 0.25 * b * (1.0 + q[0] * a);
  }
  return dN;
}

Vector<8> Quad8::N(const ParentPoint& q) {
  const auto [x, y] = q;
  Vector<8> N;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto [a, b] = node_at[i];
    double& Ni = N(static_cast<int>(i));
    if (a == 0.0)
      Ni = 0.5 * (1.0 - x * x) * (1.0 + y * b);
    else if (b == 0.0)
      Ni = 0.5 * (1.0 + x * a) * (1.0 - y * y);
    else
      Ni = 0.25 * (1.0 + x * a) * (1.0 + y * b) * (x * a + y * b - 1.0);
  }
  return N;
}

Eigen::Matrix<double, 8, 2> Quad8::dN(const ParentPoint& q) {
  const auto [x, y] = q;
  Eigen::Matrix<double, 8, 2> dN;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto [a, b] = node_at[i];
    auto row = dN.row(static_cast<int>(i));
    if (a == 0.0)
      row << -x * (1.0 + y * b), 0.5 * b * (1.0 - x * x);
    else if (b == 0.0)
      row << 0.5 * a * (1.0 - y * y), -y * (1.0 + x * a);
    else
      row << 0.25 * a * (1.0 + y * b) * (2.0 * x * a + y * b), 0.25 * b * (1.0 + x * a) * (x * a + 2.0 * y * b);
  }
  return dN;
}

Vector<9> Quad9::N(const ParentPoint& q) {
  const Vector<3> X = Line3::N(q[0]), Y = Line3::N(q[1]);
  Vector<9> N;
  for (std::size_t i = 0; i < 9; ++i)
    N(static_cast<int>(i)) = X(line3_node(node_at[i][0])) * Y(line3_node(node_at[i][1]));
  return N;
}

Eigen::Matrix<double, 9, 2> Quad9::dN(const ParentPoint& q) {
  const Vector<3> X = Line3::N(q[0]), Y = Line3::N(q[1]), dX = Line3::dN(q[0]), dY = Line3::dN(q[1]);
  Eigen::Matrix<double, 9, 2> dN;
  for (std::size_t i = 0; i < 9; ++i) {
    const int a = line3_node(node_at[i][0]), b = line3_node(node_at[i][1]);
    dN.row(static_cast<int>(i)) << dX(a) * Y(b), X(a) * dY(b);
  }
  return dN;
}

Vector<3> Tri3::N(const ParentPoint& q) {
  return {1.0 - q[0] - q[1], q[0], q[1]};
}

Eigen::Matrix<double, 3, 2> Tri3::dN(const ParentPoint& /*q*/) {
  Eigen::Matrix<double, 3, 2> dN;
  dN << -1.0, -1.0, 1.0, 0.0, 0.0, 1.0;
  return dN;
}

Vector<6> Tri6::N(const ParentPoint& q) {
  const double L1 = 1.0 - q[0] - q[1], L2 = q[0], L3 = q[1];
  Vector<6> N;
  N << L1 * (2.0 * L1 - 1.0), L2 * (2.0 * L2 - 1.0), L3 * (2.0 * L3 - 1.0), 4.0 * L1 * L2, 4.0 * L2 * L3,
      4.0 * L3 * L1;
  return N;
}

// d/dxi = d/dL2 - d/dL1 and d/deta = d/dL3 - d/dL1
Eigen::Matrix<double, 6, 2> Tri6::dN(const ParentPoint& q) {
  const double L1 = 1.0 - q[0] - q[1], L2 = q[0], L3 = q[1];
  Eigen::Matrix<double, 6, 2> dN;
  dN << 1.0 - 4.0 * L1, 1.0 - 4.0 * L1, 4.0 * L2 - 1.0, 0.0, 0.0, 4.0 * L3 - 1.0, 4.0 * (L1 - L2), -4.0 * L2,
      4.0 * L3, 4.0 * L2, -4.0 * L3, 4.0 * (L1 - L3);
  return dN;
}

Vector<15> Tri15::N(const ParentPoint& q) {
  Vector<15> N;
  for (std::size_t i = 0; i < 15; ++i) {
    const Factors f = tri15_factors(i, q);
    N(static_cast<int>(i)) = f.L1.value * f.L2.value * f.L3.value;
  }
  return N;
}

Eigen::Matrix<double, 15, 2> Tri15::dN(const ParentPoint& q) {
  Eigen::Matrix<double, 15, 2> dN;
  for (std::size_t i = 0; i < 15; ++i) {
    const Factors f = tri15_factors(i, q);
    const double d1 = f.L1.slope * f.L2.value * f.L3.value;
    dN.row(static_cast<int>(i)) << f.L1.value * f.L2.slope * f.L3.value - d1,
        f.L1.value * f.L2.value * f.L3.slope - d1;
  }
  return dN;
}

const EdgeNodes& Quad4::edges() {
  static const EdgeNodes edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return edges;
}

const EdgeNodes& Quad8::edges() {
  static const EdgeNodes edges{{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}};
  return edges;
}

const EdgeNodes& Quad9::edges() {
  return Quad8::edges();
}

const EdgeNodes& Tri3::edges() {
  static const EdgeNodes edges{{0, 1}, {1, 2}, {2, 0}};
  return edges;
}

const EdgeNodes& Tri6::edges() {
  static const EdgeNodes edges{{0, 1, 3}, {1, 2, 4}, {2, 0, 5}};
  return edges;
}

const EdgeNodes& Tri15::edges() {
  static const EdgeNodes edges{{0, 1, 3, 4, 5}, {1, 2, 6, 7, 8}, {2, 0, 9, 10, 11}};
  return edges;
}

}  // namespace sage
