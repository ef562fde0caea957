// Splits elements into smaller ones of the same kind, before mid-side and inner nodes are made.  Loads on
// edges, fixities and reports go along.  Not part of the public interface.
#pragma once

#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "sage/mesh/edges.hpp"
#include "sage/model/arc_sides.hpp"

namespace sage::mesh {

// Corners of one child in the parent's coordinates, counter-clockwise.  Interfaces are squares whose lower side
// is the bottom and whose upper side is the top.
using ChildCorners = std::vector<Place>;

class Subdivision {
 public:
  // Throws InputError for elements whose cards give more than corners and mid-side nodes.
  explicit Subdivision(Work& b);
  // Room for so many new nodes.
  void reserve(int nodes) { nodes_.reserve(nodes); }

  // The first child takes the element's place and number; the others come after the group's last.
  void split(int group, int element, const std::vector<ChildCorners>& children);

  // Cuts a structure that lies along a side of a solid or an interface, as that side is cut: at t, counted from its
  // first node.  Throws InputError where it has a hinge.
  void split_line(int group, int element, double t);

  // New nodes into the mesh, fixities and reports along the edges that were cut, loads
  // on the edges of children.
  void finish();

 private:
  // A part of a split element's edge.
  struct Segment {
    int element = 0, edge = 0;
    double from = 0.0, to = 1.0;
  };
  struct SplitElement;

  void share_middles();
  void refuse_hinge(const Group& group, int element) const;
  int node_at(SplitElement& parent, const Place& q, bool middle);
  int cut(int a, int z, int middle, double t);
  void carry_loads(Stage& stage) const;
  void divide_arcs();

  Work* b_;
  NewNodes nodes_;
  InnerNodes inner_;
  ArcSides arcs_;
  EdgeTable edges_;                       // every edge there was before, with what was cut
  std::set<std::pair<int, int>> loaded_;  // group, element: pressures act on its edges
  std::map<std::tuple<int, int, int>, std::vector<Segment>> segments_;  // of those: group, element, edge
  int last_number_ = 0;
  std::vector<std::pair<Place, int>> corners_;  // of the element in hand, for its children
  std::vector<int> child_;                      // nodes of the child in hand
};

// Every element into four, interfaces into two, n times.  option: its name in messages.
void refine(Work& b, int times, const std::string& option);

// Layers of ever smaller elements around each of the nodes (indices): those that have it as a corner are split
// so that the part at the node is `ratio` times as large, again and again.
void grade(Work& b, int node, int layers, double ratio);

// The coarsest mesh of quadrilaterals that means the same: outline, groups, supports, loads and
// reported numbers stay. False where there is none coarser, or elements are no quadrilaterals of
// corners and mid-side nodes.
bool coarsen(Work& b);

// Elements at these corners (indices of nodes) that are much longer than wide are cut, and what lies beside them, from
// one end of the mesh to the other.  False: none was.
bool square_at(Work& b, const std::vector<int>& corners);

// Corners of the mesh where the solution is singular: see docs/theory/accuracy.md.  Sorted indices.
std::vector<int> singular_corners(const Model& model);

}  // namespace sage::mesh
