// Mid-side and inner nodes that element cards leave blank.  They lie on straight edges, are shared by all
// elements of the edge, and inherit what both ends of a boundary edge are held to.
#include <algorithm>
#include <map>
#include <unordered_map>

#include "sage/model/builder.hpp"

namespace sage::build {

namespace {

using EdgeKey = std::pair<int, int>;  // end nodes, smaller first

struct MadeEdge {
  std::vector<int> nodes;  // from the smaller to the larger end node
  int uses = 0;
};

int add_node(std::vector<Vector2>& made, int first_new, const Vector2& x) {
  made.push_back(x);
  return first_new + static_cast<int>(made.size()) - 1;
}

void append_nodes(Mesh& mesh, const std::vector<Vector2>& made) {
  if (made.empty()) return;
  const Eigen::Index old = mesh.x.cols();
  mesh.x.conservativeResize(2, old + static_cast<Eigen::Index>(made.size()));
  int number = *std::max_element(mesh.number.begin(), mesh.number.end());
  for (std::size_t i = 0; i < made.size(); ++i) {
    mesh.x.col(old + static_cast<Eigen::Index>(i)) = made[i];
    mesh.number.push_back(++number);
  }
}

// Fixities of nodes: for each component the last code and value stated in the list.
using NodeFixities = std::unordered_map<int, const Fixity*>;

void inherit(std::vector<Fixity>& fixities, const std::map<EdgeKey, MadeEdge>& edges) {
  std::unordered_map<int, std::vector<Fixity>> of_node;
  for (const Fixity& f : fixities) of_node[f.node].push_back(f);
  const auto combined = [&](int node) {
    Fixity all;
    all.node = node;
    const auto it = of_node.find(node);
    if (it == of_node.end()) return all;
    for (const Fixity& f : it->second) {
      all.line = f.line;
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] != FixityCode::unchanged) {
          all.code[c] = f.code[c];
          all.value[c] = f.value[c];
        }
    }
    return all;
  };
  for (const auto& [ends, edge] : edges) {
    if (edge.uses != 1) continue;
    const Fixity a = combined(ends.first), z = combined(ends.second);
    Fixity mid;
    mid.line = a.line;
    bool any = false;
    for (std::size_t i = 0; i < edge.nodes.size(); ++i) {
      const double t = static_cast<double>(i + 1) / static_cast<double>(edge.nodes.size() + 1);
      for (std::size_t c = 0; c < 2; ++c) {
        mid.code[c] = a.code[c] == z.code[c] ? a.code[c] : FixityCode::unchanged;
        mid.value[c] = mid.code[c] == FixityCode::fixed ? (1 - t) * a.value[c] + t * z.value[c] : 0.0;
        any = any || mid.code[c] != FixityCode::unchanged;
      }
      if (!any) break;
      mid.node = edge.nodes[i];
      fixities.push_back(mid);
    }
  }
}

// Nodes within the edges.
std::size_t on_edges(const Element& element) {
  std::size_t count = 0;
  for (const std::vector<int>& edge : element.edges()) count += edge.size() - 2;
  return count;
}

// Interfaces use an edge too, but its other side is not the same body: only solids count for "boundary".
void make_group(Builder& b, Group& group, std::map<EdgeKey, MadeEdge>& edges, std::vector<Vector2>& made) {
  const Mesh& mesh = b.model.mesh;
  const ElementEntry& entry = *b.catalogue.elements.find(group.element_code);
  const auto n = group.node_count();
  const bool solid = group.element->traits().law_size == 4;
  const auto coordinates = [&](int node) -> Vector2 {
    return node < mesh.nodes() ? Vector2(mesh.x.col(node))
                               : made[static_cast<std::size_t>(node - mesh.nodes())];
  };
  for (int e = 0; e < group.elements(); ++e) {
    int* nodes = group.nodes.data() + static_cast<std::size_t>(e) * n;
    for (const std::vector<int>& local : group.element->edges()) {
      const int a = nodes[local[0]], z = nodes[local[1]];
      MadeEdge& edge = edges[{std::min(a, z), std::max(a, z)}];
      if (solid) ++edge.uses;
      const std::size_t inner = local.size() - 2;
      for (std::size_t i = 0; i < inner; ++i) {
        const std::size_t from_small = a < z ? i : inner - 1 - i;
        int& mid = nodes[local[i + 2]];
        if (mid < 0 && edge.nodes.size() > from_small) mid = edge.nodes[from_small];
      }
      if (inner == 0 || !edge.nodes.empty()) continue;
      edge.nodes.assign(inner, -1);
      for (std::size_t i = 0; i < inner; ++i) {
        const double t = static_cast<double>(i + 1) / static_cast<double>(inner + 1);
        int& mid = nodes[local[i + 2]];
        if (mid < 0) mid = add_node(made, mesh.nodes(), (1 - t) * coordinates(a) + t * coordinates(z));
        edge.nodes[a < z ? i : inner - 1 - i] = mid;
      }
    }
    if (!solid) continue;
    // Nodes inside, which no edge holds: the centre, or one on the way from the centre to each corner, in their
    // order (quartic triangle: area coordinates 1/2, 1/4, 1/4).
    Vector2 centre = Vector2::Zero();
    for (int c = 0; c < entry.corners; ++c) centre += coordinates(nodes[c]) / entry.corners;
    const std::size_t inside = n - static_cast<std::size_t>(entry.corners) - on_edges(*group.element);
    for (std::size_t i = n - inside; i < n; ++i) {
      const Vector2 x =
          inside == 1 ? centre : Vector2(0.75 * centre + 0.25 * coordinates(nodes[i + inside - n]));
      if (nodes[i] < 0) nodes[i] = add_node(made, mesh.nodes(), x);
    }
  }
}

}  // namespace

void make_mid_nodes(Builder& b) {
  std::map<EdgeKey, MadeEdge> edges;
  std::vector<Vector2> made;
  bool any = false;
  for (const Group& group : b.model.groups)
    any = any || std::find(group.nodes.begin(), group.nodes.end(), -1) != group.nodes.end();
  if (!any) return;
  for (Group& group : b.model.groups) make_group(b, group, edges, made);
  append_nodes(b.model.mesh, made);
  inherit(b.model.fixities, edges);
  for (Stage& stage : b.model.stages) inherit(stage.fixities, edges);
  for (Report& report : b.model.reports) {
    // A report along a boundary takes the mid-side nodes with it.
    const std::vector<int> corners = report.nodes;
    for (const auto& [ends, edge] : edges) {
      const bool both = std::find(corners.begin(), corners.end(), ends.first) != corners.end() &&
                        std::find(corners.begin(), corners.end(), ends.second) != corners.end();
      if (both && edge.uses == 1) report.nodes.insert(report.nodes.end(), edge.nodes.begin(), edge.nodes.end());
    }
  }
}

}  // namespace sage::build
