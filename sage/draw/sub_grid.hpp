// A grid inside an element, so that a picture shows curved sides and what lies between the nodes.
#pragma once

#include "sage/draw/contour.hpp"
#include "sage/model/model.hpp"

namespace sage {

struct SubGrid {
  Eigen::MatrixXd N;                    // places x nodes: shape functions at every place of the grid
  CellGrid cells;                       // of those places
  std::vector<std::vector<int>> edges;  // places from end to end of each edge, as Element::edges orders them
};

// `along_xi` x `along_eta` cells of a quadrilateral; a triangle has along_xi cells along each of its sides and
// does not look at along_eta.  The element must be one with an inside (no interface).
SubGrid sub_grid(const Group& group, int along_xi, int along_eta);

// Cells along a side that is `length` long on the paper, in units of the picture: a cell stays small against
// what the eye tells apart, and there are never more than what a polynomial of this degree needs.
int sub_grid_cells(double length, int degree);

}  // namespace sage
