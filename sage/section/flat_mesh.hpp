// A mesh of corners before nodes are split.  Not part of the public interface.
#pragma once

#include <array>
#include <vector>

#include "sage/section/arrangement.hpp"
#include "sage/section/size_field.hpp"

namespace sage::section {

struct Cell {
  std::array<int, 4> nodes{-1, -1, -1, -1};  // counter-clockwise; the last is -1 for a triangle
  int area = -1;
  int corners() const { return nodes[3] < 0 ? 3 : 4; }
};

// Nodes 0 ... vertices - 1 are the vertices of the arrangement, those on pieces follow.
struct FlatMesh {
  std::vector<Vector2> x;
  std::vector<std::vector<int>> on_piece;   // by piece: its nodes from first to last
  std::vector<std::vector<double>> places;  // by piece: t of those nodes on its curve
  std::vector<Cell> cells;
};

// Number of edges of each piece that the sizes ask for; `factor` makes longer edges.
std::vector<int> edges_by_size(const Arrangement& arrangement, const SizeField& sizes, double factor);
// Nodes on pieces, by the sizes; `even` spaces them equally, as blocks need.
FlatMesh divide(const Arrangement& arrangement, const SizeField& sizes, const std::vector<int>& edges,
                bool even);

// Arcs whose straight edges cross or touch those of other pieces.
std::vector<int> crossed_arcs(const Arrangement& arrangement, const FlatMesh& mesh);

// Every edge in two, every quadrilateral in four, every triangle in three quadrilaterals.  Nodes on arcs stay there.
FlatMesh into_quadrilaterals(const Arrangement& arrangement, const FlatMesh& coarse);

// Joins pairs of triangles to quadrilaterals, the best first, not across pieces, nor so that two sides of one lie on a
// circle: the corner between them would become flat in finer meshes, which follow it.  No triangle has two such sides, since
// those of Gmsh are Delaunay's, and the circle would hold the other corners.
void join_triangles(const Arrangement& arrangement, FlatMesh& mesh);

// Moves nodes inside of faces towards the middle of their neighbours where that makes no cell worse than half as good as
// the worst around.
void smooth(FlatMesh& mesh, std::size_t fixed_nodes);

// The least cross product of two sides at a corner over the product of their lengths, of a good cell positive.
double worst_corner(const FlatMesh& mesh, const Cell& cell);

// Edges across an area of four sides; empty and `why` where a face is none.  Index of the first such area in `area`.
std::vector<int> edges_of_blocks(const Arrangement& arrangement, const std::vector<int>& wished, int& area);
// Cells of faces with four sides, two triangles each where asked for.
void fill_blocks(const Arrangement& arrangement, FlatMesh& mesh, bool triangles);
// Lines across the whole section through all its vertices; empty unless all curves are horizontal or vertical.
std::vector<Curve> cuts_through(const Arrangement& arrangement);

// Triangles of all faces by Gmsh.  Throws SectionError.
void fill_by_gmsh(const Section& section, const Arrangement& arrangement, const SizeField& sizes, double factor,
                  FlatMesh& mesh);

// Middle nodes, and copies of nodes along lines with interfaces.
SectionMesh split(const Section& section, const Arrangement& arrangement, const FlatMesh& mesh);

}  // namespace sage::section
