// A tiny dense finite-element program for patch tests: mesh of one or more groups,
// prescribed displacements, solve.
#pragma once

#include <vector>

#include "sage/conformance/element_cases.hpp"

namespace sage::conformance {

struct CornerMesh {
  Eigen::Matrix2Xd x;                   // corners
  std::vector<std::vector<int>> quads;  // counter-clockwise
};

// The patch of MacNeal & Harder (1985): 0.24 x 0.12, five quadrilaterals, four inner nodes.  Touches x = 0,
// where one triangle of the split mesh has a single vertex.
CornerMesh macneal_harder();

// nx x ny quadrilaterals over (x0, x1) x (y0, y1), inner nodes moved by up to `shift` of a cell.
CornerMesh perturbed_grid(int nx, int ny, double x0, double x1, double y0, double y1, double shift);

struct PatchMesh {
  Eigen::Matrix2Xd x;
  std::vector<std::vector<int>> elements;
  int dofs() const { return static_cast<int>(2 * x.cols()); }
};

// The mesh with the nodes of `entry`; each quadrilateral becomes two triangles (diagonal from its first corner)
// where the entry has three corners.
PatchMesh make_mesh(const ElementEntry& entry, const CornerMesh& corners);

// Elements of one kind and law.
struct Group {
  const Element* element;
  LawRef law;
  std::vector<std::vector<int>> elements;
};

// Coordinates or displacements of one element's nodes.
Eigen::Matrix2Xd element_nodes(const Eigen::Matrix2Xd& x, const std::vector<int>& nodes);

struct DenseSystem {
  Eigen::MatrixXd K;
  Eigen::VectorXd f;                          // internal force at u
  std::vector<std::vector<ElementRun>> runs;  // by group, with stress and strain at u
};

// K and f at the displacements u (2 x nodes), from the unstressed state.
DenseSystem assemble(const Eigen::Matrix2Xd& x, const std::vector<Group>& groups, const Eigen::Matrix2Xd& u);

// Linear problem: u given where fixed, loads elsewhere.  Returns u, 2 x nodes.
Eigen::Matrix2Xd solve(const Eigen::Matrix2Xd& x, const std::vector<Group>& groups,
                       const std::vector<char>& fixed, const Eigen::Matrix2Xd& prescribed,
                       const Eigen::VectorXd& load);

// Edges of the element with these nodes that no other element of the mesh has.
std::vector<int> own_edges(const PatchMesh& mesh, const Element& element, const std::vector<int>& nodes);

// Nodes on such edges, one flag a node.
std::vector<char> boundary_nodes(const PatchMesh& mesh, const Element& element);

}  // namespace sage::conformance
