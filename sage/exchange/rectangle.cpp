#include "sage/exchange/rectangle.hpp"

#include <utility>

namespace sage {

int Rectangle::intervals() const {
  if (triangles)
    return nodes_per_element == 3 ? 1 : nodes_per_element == 6 ? 2 : nodes_per_element == 15 ? 4 : 0;
  return nodes_per_element == 4 ? 1 : nodes_per_element == 8 || nodes_per_element == 9 ? 2 : 0;
}

int Rectangle::number(int i, int j) const {
  const int first = along_x ? i : j, second = along_x ? j : i;
  const int cells = along_x ? columns() : rows();
  const int line = intervals() * cells + 1;
  if (!serendipity()) return second * line + first + 1;
  // Lines through corners hold 2n + 1 nodes, lines between them n + 1.
  return second / 2 * (line + cells + 1) + (second % 2 == 1 ? line + first / 2 : first) + 1;
}

Vector2 Rectangle::position(int i, int j) const {
  const int k = intervals();
  const auto along = [k](const std::vector<double>& at, int i_grid) {
    const auto cell = static_cast<std::size_t>(i_grid / k);
    const double t = static_cast<double>(i_grid % k) / k;
    return t == 0.0 ? at[cell] : (1.0 - t) * at[cell] + t * at[cell + 1];
  };
  return {along(x, i), along(y, j)};
}

std::array<int, 2> Rectangle::cell_place(int cell) const {
  if (along_x) return {cell % columns(), cell / columns()};
  return {cell / rows(), cell % rows()};
}

std::vector<int> Rectangle::nodes(int element) const {
  const int k = intervals();
  const auto [column, row] = cell_place(cell(element));
  const int left = column * k, right = left + k, begin = row * k, end = begin + k;
  std::vector<std::array<int, 2>> corner;
  if (!triangles)
    corner = {{left, end}, {right, end}, {right, begin}, {left, begin}};
  else if (element % 2 == 0)
    corner = {{left, begin}, {left, end}, {right, begin}};
  else
    corner = {{right, end}, {right, begin}, {left, end}};
  // Counter-clockwise where the rows run down (y falls) and the columns to the right; otherwise turned round.
  if ((x[1] > x[0]) == (y[1] > y[0])) std::swap(corner[1], corner.back());
  std::vector<int> list;
  for (const auto& c : corner) list.push_back(number(c[0], c[1]));
  for (std::size_t e = 0; e < corner.size(); ++e) {
    const auto &a = corner[e], &z = corner[(e + 1) % corner.size()];
    for (int m = 1; m < k; ++m)
      list.push_back(number(a[0] + m * (z[0] - a[0]) / k, a[1] + m * (z[1] - a[1]) / k));
  }
  if (nodes_per_element == 9) list.push_back(number(left + 1, begin + 1));
  if (nodes_per_element == 15) {
    // Inner nodes at (1/4, 1/4), (1/2, 1/4), (1/4, 1/2) of the triangle.
    const auto &a = corner[0], &b = corner[1], &c = corner[2];
    for (const auto& [s, t] : {std::pair{1, 1}, std::pair{2, 1}, std::pair{1, 2}})
      list.push_back(number(a[0] + (s * (b[0] - a[0]) + t * (c[0] - a[0])) / k,
                            a[1] + (s * (b[1] - a[1]) + t * (c[1] - a[1])) / k));
  }
  return list;
}

}  // namespace sage
