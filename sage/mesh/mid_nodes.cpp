// Mid-side and inner nodes that element cards leave blank.  Those on an edge are shared by all elements that
// have it and lie where the element's shape wants them (Gauss-Lobatto places in elements of high degree), on
// the straight edge or on the parabola through a given middle node; inner nodes lie on the map of the sides.
#include <algorithm>
#include <cmath>

#include "sage/mesh/edges.hpp"

namespace sage::mesh {

namespace {

// What has been made so far on the edges, and which element began each.
struct Making {
  NewNodes nodes;
  MadeEdges edges;
  std::map<EdgeKey, std::pair<std::size_t, std::string>> owner;  // inner nodes, "element 7 (quad8)"
  std::map<EdgeKey, std::vector<int>> given;                     // inner nodes that cards give, -1 = none
  InnerNodes inner;
};

// Place of an edge's inner node between its ends.
double place_on_edge(std::span<const Place> parent, const std::vector<int>& edge, std::size_t i) {
  const auto point = [&](int local) { return parent[static_cast<std::size_t>(local)]; };
  const auto distance = [](const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); };
  return distance(point(edge[i]), point(edge[0])) / distance(point(edge[1]), point(edge[0]));
}

// False, and an error, where a neighbour has another number of nodes on the edge.
bool fits(Work& b, const Group& group, int e, Making& made, const EdgeKey& key, std::size_t inner) {
  const auto eu = static_cast<std::size_t>(e);
  const std::string name =
      "element " + std::to_string(group.element_numbers[eu]) + " (" + group.element_name + ")";
  const auto [it, is_new] = made.owner.try_emplace(key, inner, name);
  if (is_new || it->second.first == inner) return true;
  const auto number = [&](int node) {
    return std::to_string(b.model.mesh.number[static_cast<std::size_t>(node)]);
  };
  b.error("S401", {b.deck.file, group.element_lines[eu], 0, 0},
          name + " has " + std::to_string(inner) + " node(s) inside its edge from node " + number(key.first) +
              " to " + number(key.second) + ", its neighbour " + it->second.second + " has " +
              std::to_string(it->second.first) + ": elements of different degree don't fit together");
  return false;
}

void make_edge(Work& b, const Group& group, int e, int* nodes, const std::vector<int>& local, Making& made) {
  const int a = nodes[local[0]], z = nodes[local[1]];
  const std::size_t inner = local.size() - 2;
  const EdgeKey key = edge_key(a, z);
  if (!fits(b, group, e, made, key, inner)) return;
  MadeEdge& edge = made.edges[key];
  if (counts_for_outline(group)) ++edge.solids;
  if (inner == 0) return;
  const bool begun = !edge.nodes.empty();
  if (!begun) edge.nodes.assign(inner, {0.0, -1});
  const std::span<const Place> parent = group.entry->parent_nodes;
  const auto from_small = [&](std::size_t i) { return a < z ? i : inner - 1 - i; };
  if (const auto it = made.given.find(key); it != made.given.end() && it->second.size() == inner)
    for (std::size_t i = 0; i < inner; ++i)
      if (int& node = nodes[local[i + 2]]; node < 0) node = it->second[from_small(i)];
  std::optional<Vector2> middle;
  if (const int m = middle_of(local); m >= 0 && nodes[m] >= 0) middle = made.nodes.at(nodes[m]);
  for (std::size_t i = 0; i < inner; ++i) {
    const std::size_t at = from_small(i);
    int& mid = nodes[local[i + 2]];
    if (mid < 0 && begun) mid = edge.nodes[at].node;
    if (begun) continue;
    const double t = place_on_edge(parent, local, i + 2);
    if (mid < 0) mid = made.nodes.add(along_edge(made.nodes.at(a), made.nodes.at(z), middle, t));
    edge.nodes[at] = {a < z ? t : 1 - t, mid};
  }
}

// A node inside an edge that only one of its elements gives is that of the others too.
void find_given(const Group& group, std::map<EdgeKey, std::vector<int>>& given) {
  for (int e = 0; e < group.elements(); ++e)
    for (const std::vector<int>& local : group.element->edges()) {
      const int* nodes = group.nodes_of(e);
      const int a = nodes[local[0]], z = nodes[local[1]];
      for (std::size_t i = 2; i < local.size(); ++i) {
        if (nodes[local[i]] < 0) continue;
        const std::size_t inner = local.size() - 2;
        std::vector<int>& known = given.try_emplace(edge_key(a, z), inner, -1).first->second;
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
    const int middle = middle_of(group.element->edges()[ku]);
    if (middle >= 0) shape.middle[ku] = made.nodes.at(nodes[middle]);
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
  Making made{NewNodes(b.model.mesh), {}, {}, {}, InnerNodes(b.model)};
  for (const Group& group : b.model.groups) find_given(group, made.given);
  for (Group& group : b.model.groups) make_group(b, group, made);
  const int first_made = made.nodes.append();
  b.model.mesh.made_between = b.model.mesh.nodes() - first_made;
  inherit_along_edges(b.model, made.edges, first_made);
}

}  // namespace sage::mesh
