#include "elements/lobatto.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "elements/solid_entry.hpp"

namespace sage {

namespace {

// Values and slopes of the Lagrange polynomials, in rising order of their points:
// l_i = prod_{j != i} (x - x_j) / (x_i - x_j)
template <int p>
struct Lagrange {
  Vector<p + 1> value, slope;

  explicit Lagrange(double x) {
    constexpr auto at = gauss_lobatto<p>();
    for (int i = 0; i <= p; ++i) {
      double v = 1.0, s = 0.0;
      for (int j = 0; j <= p; ++j) {
        if (j == i) continue;
        const double xi = at[i], xj = at[j];
        const double factor = (x - xj) / (xi - xj);
        s = s * factor + v / (xi - xj);
        v *= factor;
      }
      value(i) = v;
      slope(i) = s;
    }
  }
};

// VTK's Lagrange quadrilateral has the nodes of its third and fourth side in the direction of the first two.
template <int p>
std::vector<int> vtk_order() {
  std::vector<int> order(LobattoQuad<p>::nodes);
  std::iota(order.begin(), order.end(), 0);
  for (const std::ptrdiff_t side : {2, 3}) {
    const auto first = order.begin() + 4 + side * (p - 1);
    std::reverse(first, first + (p - 1));
  }
  return order;
}

template <int p>
ElementEntry lobatto_entry(const char* name, const char* summary, const char* rule) {
  return element_entry(with_shape<LobattoQuad<p>>(
                           {.name = name, .summary = summary, .card_nodes = 8, .vtk = {70, vtk_order<p>()}}),
                       {solid<LobattoQuad<p>, GaussSquare<p + 1>>({1, "full", rule}, name)});
}

}  // namespace

template <int p>
auto LobattoLine<p>::N(double xi) -> Vector<nodes> {
  const Lagrange<p> l(xi);
  Vector<nodes> N;
  for (int i = 0; i < nodes; ++i) N(i) = l.value(lobatto_rising<p>(i));
  return N;
}

template <int p>
auto LobattoLine<p>::dN(double xi) -> Vector<nodes> {
  const Lagrange<p> l(xi);
  Vector<nodes> dN;
  for (int i = 0; i < nodes; ++i) dN(i) = l.slope(lobatto_rising<p>(i));
  return dN;
}

template <int p>
auto LobattoQuad<p>::N(const ParentPoint& q) -> Vector<nodes> {
  const Lagrange<p> X(q[0]), Y(q[1]);
  Vector<nodes> N;
  for (std::size_t i = 0; i < nodes; ++i) N(static_cast<int>(i)) = X.value(grid[i][0]) * Y.value(grid[i][1]);
  return N;
}

template <int p>
auto LobattoQuad<p>::dN(const ParentPoint& q) -> Eigen::Matrix<double, nodes, 2> {
  const Lagrange<p> X(q[0]), Y(q[1]);
  Eigen::Matrix<double, nodes, 2> dN;
  for (std::size_t i = 0; i < nodes; ++i)
    dN.row(static_cast<int>(i)) << X.slope(grid[i][0]) * Y.value(grid[i][1]),
        X.value(grid[i][0]) * Y.slope(grid[i][1]);
  return dN;
}

template <int p>
const EdgeNodes& LobattoQuad<p>::edges() {
  static const EdgeNodes edges = [] {
    EdgeNodes all;
    for (int e = 0; e < 4; ++e) {
      std::vector<int>& edge = all.emplace_back(std::vector<int>{e, (e + 1) % 4});
      for (int i = 0; i < p - 1; ++i) edge.push_back(4 + e * (p - 1) + i);
    }
    return all;
  }();
  return edges;
}

template struct LobattoLine<4>;
template struct LobattoLine<6>;
template struct LobattoLine<8>;
template struct LobattoQuad<4>;
template struct LobattoQuad<6>;
template struct LobattoQuad<8>;

ElementEntry quad25_entry() {
  return lobatto_entry<4>("quad25", "25-node quadrilateral of degree 4; cards give 4 or 8 nodes", "5x5 Gauss");
}

ElementEntry quad49_entry() {
  return lobatto_entry<6>("quad49", "49-node quadrilateral of degree 6; cards give 4 or 8 nodes", "7x7 Gauss");
}

ElementEntry quad81_entry() {
  return lobatto_entry<8>("quad81", "81-node quadrilateral of degree 8; cards give 4 or 8 nodes", "9x9 Gauss");
}

}  // namespace sage
