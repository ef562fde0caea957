// Nodes that are made on the edges of elements, and what they take over from the ends.  Not part of the public
// interface.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "sage/model/builder.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage::build {

using EdgeKey = std::pair<int, int>;  // end nodes, smaller first

inline EdgeKey edge_key(int a, int z) {
  return {std::min(a, z), std::max(a, z)};
}

// Nodes inside an edge, from its smaller to its larger end node.
struct MadeEdge {
  std::vector<int> nodes;
  std::vector<double> at;  // place of each, 0 ... 1
  // Solids that have the edge; 1 = boundary (an interface beyond it is another body), 0 = an interface on a
  // rigid body.
  int solids = 0;
};

using MadeEdges = std::map<EdgeKey, MadeEdge>;

// Nodes of a boundary edge are held as both of its ends are, prescribed displacements linear between them, and
// belong to the reports that list both ends.
void inherit_along_edges(Model& model, const MadeEdges& edges);

// New nodes of a mesh, appended when all are known.
class NewNodes {
 public:
  explicit NewNodes(Mesh& mesh) : mesh_(&mesh), first_(mesh.nodes()) {}
  int add(const Vector2& x) {
    made_.push_back(x);
    return first_ + static_cast<int>(made_.size()) - 1;
  }
  Vector2 at(int node) const {
    return node < first_ ? Vector2(mesh_->x.col(node)) : made_[static_cast<std::size_t>(node - first_)];
  }
  void append();

 private:
  Mesh* mesh_;
  int first_;
  std::vector<Vector2> made_;
};

// Local number of the node in the middle of an edge; -1 where the edge has no inner node.  Degrees are even, so
// that there is one, and a card's mid-side node is always it.
inline int middle_of(const std::vector<int>& edge) {
  return edge.size() > 2 ? edge[2 + (edge.size() - 3) / 2] : -1;
}

}  // namespace sage::build
