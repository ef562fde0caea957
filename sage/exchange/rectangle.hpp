// A rectangular mesh numbered by rule: columns x rows of cells, nodes counted along one direction first.
#pragma once

#include <array>
#include <vector>

#include "sage/core/types.hpp"

namespace sage {

struct Rectangle {
  bool triangles = false;  // two a cell, the diagonal from lower left to upper right of a cell that runs down
  int nodes_per_element = 8;  // 3 6 15 or 4 8 9
  bool along_x = true;        // nodes and elements are counted along x first
  std::vector<double> x, y;   // edges of the columns and rows, in the order of counting

  int columns() const { return static_cast<int>(x.size()) - 1; }
  int rows() const { return static_cast<int>(y.size()) - 1; }
  // Intervals along a cell's side; 0 = an element that doesn't exist.
  int intervals() const;
  bool serendipity() const { return !triangles && nodes_per_element == 8; }

  // On the grid of all nodes: i = 0 .. intervals * columns along x, j along y in the order of `y`.
  bool exists(int i, int j) const { return !serendipity() || i % 2 == 0 || j % 2 == 0; }
  int number(int i, int j) const;  // from 1
  Vector2 position(int i, int j) const;

  int elements() const { return columns() * rows() * (triangles ? 2 : 1); }
  int cell(int element) const { return triangles ? element / 2 : element; }
  std::array<int, 2> cell_place(int cell) const;  // column, row
  // Node numbers of element 0 .. elements()-1 in this program's order: counter-clockwise corners, mid-side
  // nodes edge by edge, inner nodes.
  std::vector<int> nodes(int element) const;
};

}  // namespace sage
