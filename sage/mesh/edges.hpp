// Nodes that are made on the edges of elements, and what they take over from the ends.  Not
// part of the public interface.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "sage/mesh/work.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage::mesh {

using EdgeKey = std::pair<int, int>;  // end nodes, smaller first

inline EdgeKey edge_key(int a, int z) {
  return {std::min(a, z), std::max(a, z)};
}

// Bodies that share an edge make it an inner one; water that flows through a body lies on the same edges.
inline bool counts_for_outline(const Group& group) {
  return group.entry->fills_area() && !(group.flow() && group.overlay);
}

// A node inside an edge, at its place 0 ... 1 from the smaller to the larger end node.
struct OnEdge {
  double at = 0.0;
  int node = 0;
};

// The edges of elements, by their ends, with the nodes inside them, in flat tables: a mesh of a million edges has no
// time for a tree of them.  Edges stand by rising key.
//
// Beyond the end of an interface inside the ground two elements share an edge but for its first node, which is the pair that
// opens there.  Such edges are one, so that finer meshes are joined from their first new node on, as coarse ones are.
class EdgeTable {
 public:
  struct Edge {
    EdgeKey ends;
    // Solids that have the edge; 1 = boundary (an interface beyond it is another body), 0 = an interface on a
    // rigid body.
    int solids = 0;
    int first = -1, last = -1;  // its nodes in a chain; -1: none
  };
  struct Link : OnEdge {
    int next = -1;
    int near = -1;   // the end that the place is counted from; -1: a card gives the node
    long place = 0;  // in 1e-15 of the edge
  };

  // Of all elements, or of all but structures.
  EdgeTable(const Model& model, bool structures);

  Edge* find(int a, int z);  // nullptr: no element has it
  // The ends, in the same order, of the edge that stands for it.
  std::pair<int, int> ends(int a, int z) const;
  std::size_t index(const Edge& edge) const { return static_cast<std::size_t>(&edge - edges_.data()); }
  void add(Edge& edge, const Link& link);
  const std::vector<Edge>& edges() const { return edges_; }
  const Link& link(int i) const { return links_[i]; }

 private:
  void join_beyond_interfaces(const Model& model);

  std::map<EdgeKey, EdgeKey> standing_for_;  // ends in the same order
  std::vector<int> start_;                   // of each node: the edges of which it is the smaller end
  std::vector<Edge> edges_;
  std::vector<Link> links_;
};

// What nodes that were made (indices from first_made on) take over from those that their edge had before, which
// keep what the deck says of them.  A made node is held while both known nodes around it are: on an outer edge
// if one list of cards (those before the stages, or those of one stage) holds both, on an edge whose middle
// node a card gives in any case.  Prescribed displacements are interpolated through all known nodes of the
// edge.  It belongs to the reports that list both nodes around it.
void inherit_along_edges(Model& model, const EdgeTable& edges, int first_made);

// Nodes that are made inside elements.  Elements on the same corners, as those of water in soil, share them.
class InnerNodes {
 public:
  // Of a model in which no group lies on another one it keeps nothing.
  explicit InnerNodes(const Model& model)
      : keep_(std::ranges::any_of(model.groups, [](const Group& group) { return group.overlay; })) {}
  // make() where an element on these corners has no node at the place yet.
  template <class Make>
  int at(const int* nodes, int corners, const Vector2& place, const Make& make) {
    if (!keep_) return make();
    std::vector<int> key(nodes, nodes + corners);
    std::sort(key.begin(), key.end());
    auto& known = known_[std::move(key)];
    for (const auto& [there, node] : known)
      if ((there - place).norm() <= 1e-9 * (there.norm() + place.norm())) return node;
    return known.emplace_back(place, make()).second;
  }

 private:
  bool keep_;
  std::map<std::vector<int>, std::vector<std::pair<Vector2, int>>> known_;  // by corners
};

// New nodes of a mesh, appended when all are known.
class NewNodes {
 public:
  explicit NewNodes(Mesh& mesh) : mesh_(&mesh), first_(mesh.nodes()) {}
  int add(const Vector2& x) {
    made_.push_back(x);
    return first_ + static_cast<int>(made_.size()) - 1;
  }
  Vector2 at(int node) const { return node < first_ ? Vector2(mesh_->x.col(node)) : made_[node - first_]; }
  void reserve(int nodes) { made_.reserve(nodes); }
  int append();  // index of the first of them

 private:
  Mesh* mesh_;
  int first_;
  std::vector<Vector2> made_;
};

}  // namespace sage::mesh
