// Mid-side and inner nodes that element cards leave blank.  Those on an edge are shared by all elements that
// have it and lie where the element's shape wants them (Gauss-Lobatto places in elements of high degree), on
// the straight edge, on the parabola through a given middle node, or on the circle that the edge follows; inner nodes lie on the map of the sides.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "sage/mesh/edges.hpp"
#include "sage/model/arc_sides.hpp"

namespace sage::mesh {

namespace {

// What has been made so far on the edges, and which element began each.
struct Making {
  explicit Making(Model& model)
      : nodes(model.mesh), edges(model, true), arcs(model.mesh), owner(edges.edges().size()), inner(model) {}

  struct Owner {
    const Group* group = nullptr;
    int element = 0;
    std::size_t inner = 0;  // nodes inside the edge
  };

  NewNodes nodes;
  EdgeTable edges;
  ArcSides arcs;
  std::vector<Owner> owner;                                 // of each edge
  std::unordered_map<std::size_t, std::vector<int>> given;  // of some: inner nodes that cards give, -1 = none
  InnerNodes inner;
};

std::string name_of(const Group& group, int e) {
  return "element " + std::to_string(group.element_numbers[e]) + " (" + group.element_name + ")";
}

// Place of an edge's inner node between its ends.
double place_on_edge(std::span<const Place> parent, const std::vector<int>& edge, std::size_t i) {
  const auto point = [&](int local) { return parent[local]; };
  const auto distance = [](const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); };
  return distance(point(edge[i]), point(edge[0])) / distance(point(edge[1]), point(edge[0]));
}

// False, and an error, where a neighbour has another number of nodes on the edge.
bool fits(Work& b, const Group& group, int e, Making& made, const EdgeTable::Edge& edge, std::size_t inner) {
  Making::Owner& owner = made.owner[made.edges.index(edge)];
  if (owner.group == nullptr) owner = {&group, e, inner};
  if (owner.inner == inner) return true;
  const auto number = [&](int node) { return std::to_string(b.model.mesh.number[node]); };
  b.error("S401", {b.deck.file, group.element_lines[e], 0, 0},
          name_of(group, e) + " has " + std::to_string(inner) + " node(s) inside its edge from node " +
              number(edge.ends.first) + " to " + number(edge.ends.second) + ", its neighbour " +
              name_of(*owner.group, owner.element) + " has " + std::to_string(owner.inner) +
              ": elements of different degree don't fit together");
  return false;
}

// Nodes that an element has inside an edge, in the order from its smaller end, and their places between the ends.
struct InnerOfEdge {
  int* nodes;
  const std::vector<int>& local;
  bool rising;  // the first end is the smaller one
  std::size_t count() const { return local.size() - 2; }
  // Index in `local` of number i from the smaller end.
  std::size_t index(std::size_t i) const { return 2 + (rising ? i : count() - 1 - i); }
  int& at(std::size_t i) const { return nodes[local[index(i)]]; }
};

void take_given(const Making& made, std::size_t edge, const InnerOfEdge& inner) {
  const auto it = made.given.find(edge);
  if (it == made.given.end() || it->second.size() != inner.count()) return;
  for (std::size_t i = 0; i < inner.count(); ++i)
    if (inner.at(i) < 0) inner.at(i) = it->second[i];
}

// The first element of an edge makes the nodes that it misses there, and all others take them over.
void make_edge(Work& b, const Group& group, int e, int* nodes, const std::vector<int>& local, Making& made) {
  const auto [a, z] = made.edges.ends(nodes[local[0]], nodes[local[1]]);
  EdgeTable::Edge& edge = *made.edges.find(a, z);
  const InnerOfEdge inner{nodes, local, a < z};
  if (!fits(b, group, e, made, edge, inner.count())) return;
  if (counts_for_outline(group)) ++edge.solids;
  if (inner.count() == 0) return;
  take_given(made, made.edges.index(edge), inner);
  if (edge.first >= 0) {
    int link = edge.first;
    for (std::size_t i = 0; i < inner.count(); ++i, link = made.edges.link(link).next)
      if (inner.at(i) < 0) inner.at(i) = made.edges.link(link).node;
    return;
  }
  const std::span<const Place> parent = group.entry->parent_nodes;
  std::optional<Vector2> middle;
  if (const int m = middle_of(local); m >= 0 && nodes[m] >= 0) middle = made.nodes.at(nodes[m]);
  for (std::size_t i = 2; i < local.size(); ++i)
    if (int& node = nodes[local[i]]; node < 0)
      node = made.nodes.add(along_side(made.nodes.at(a), made.nodes.at(z), middle, made.arcs.centre(a, z),
                                       place_on_edge(parent, local, i)));
  for (std::size_t i = 0; i < inner.count(); ++i) {
    const double t = place_on_edge(parent, local, inner.index(i));
    made.edges.add(edge, {{inner.rising ? t : 1 - t, inner.at(i)}});
  }
}

// A node inside an edge that only one of its elements gives is that of the others too.
void find_given(const Group& group, Making& made) {
  for (int e = 0; e < group.elements(); ++e)
    for (const std::vector<int>& local : group.element->edges()) {
      const int* nodes = group.nodes_of(e);
      const auto [a, z] = made.edges.ends(nodes[local[0]], nodes[local[1]]);
      for (std::size_t i = 2; i < local.size(); ++i) {
        if (nodes[local[i]] < 0) continue;
        const std::size_t inner = local.size() - 2;
        const std::size_t edge = made.edges.index(*made.edges.find(a, z));
        std::vector<int>& known = made.given.try_emplace(edge, inner, -1).first->second;
        if (known.size() != inner) continue;  // of another degree: fits() refuses it
        int& place = known[a < z ? i - 2 : inner + 1 - i];
        if (place < 0) place = nodes[local[i]];
      }
    }
}

// Nodes inside a solid that no edge holds.
void make_inner(const Group& group, int corners, int* nodes, Making& made) {
  const std::span<const Place> parent = group.entry->parent_nodes;
  CoarseShape shape;
  shape.corners = corners;
  for (int k = 0; k < corners; ++k) {
    const auto ku = static_cast<std::size_t>(k);
    shape.corner[ku] = made.nodes.at(nodes[k]);
    const std::vector<int>& edge = group.element->edges()[ku];
    if (const int middle = middle_of(edge); middle >= 0) shape.middle[ku] = made.nodes.at(nodes[middle]);
    shape.centre[ku] = made.arcs.centre(nodes[edge[0]], nodes[edge[1]]);
  }
  for (std::size_t i = static_cast<std::size_t>(corners); i < group.node_count(); ++i)
    if (nodes[i] < 0) {
      const Vector2 place = shape.at(parent[i]);
      nodes[i] = made.inner.at(nodes, corners, place, [&] { return made.nodes.add(place); });
    }
}

void make_group(Work& b, Group& group, Making& made) {
  const int corners = group.entry->corners;
  for (int e = 0; e < group.elements(); ++e) {
    int* nodes = group.nodes.data() + static_cast<std::size_t>(e) * group.node_count();
    const int before = b.problems.errors();
    for (const std::vector<int>& local : group.element->edges()) make_edge(b, group, e, nodes, local, made);
    if (b.problems.errors() > before) return;  // one message a group
    if (group.entry->fills_area()) make_inner(group, corners, nodes, made);
  }
}

}  // namespace

void make_mid_nodes(Work& b) {
  bool any = false;
  for (const Group& group : b.model.groups)
    any = any || std::find(group.nodes.begin(), group.nodes.end(), -1) != group.nodes.end();
  if (!any) return;
  Making made(b.model);
  for (const Group& group : b.model.groups) find_given(group, made);
  for (Group& group : b.model.groups) make_group(b, group, made);
  const int first_made = made.nodes.append();
  b.model.mesh.made_between = b.model.mesh.nodes() - first_made;
  inherit_along_edges(b.model, made.edges, first_made);
}

}  // namespace sage::mesh
