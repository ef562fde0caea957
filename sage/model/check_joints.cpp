// Parts of a mesh that look joined and are not: nodes at one place, nodes on an edge they don't belong to,
// components without a common node.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "sage/model/builder.hpp"

namespace sage::build {

namespace {

constexpr double kTogether = 1e-6;  // of the shortest edge there: closer nodes are at one place
constexpr int kListed = 5;

std::string number_of(const Model& model, int node) {
  return std::to_string(model.mesh.number[static_cast<std::size_t>(node)]);
}

// The first few of a list, then how many more there are.
struct Examples {
  int count = 0;
  std::string words;
  void add(const std::string& one) {
    if (++count <= kListed) words += (count > 1 ? ", " : "") + one;
  }
  std::string text() const {
    return words + (count > kListed ? " and " + std::to_string(count - kListed) + " more" : "");
  }
};

// For every node the shortest edge of the solids around it; infinite where there is none.
std::vector<double> shortest_edges(const Model& model) {
  std::vector<double> shortest(static_cast<std::size_t>(model.mesh.nodes()),
                               std::numeric_limits<double>::infinity());
  for (const Group& group : model.groups)
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const int* nodes = group.nodes_of(e);
        const double length = (model.mesh.x.col(nodes[edge[0]]) - model.mesh.x.col(nodes[edge[1]])).norm() /
                              static_cast<double>(edge.size() - 1);
        for (int local : edge) {
          double& s = shortest[static_cast<std::size_t>(nodes[local])];
          s = std::min(s, length);
        }
      }
  return shortest;
}

std::vector<char> interface_nodes(const Model& model) {
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    if (group.element->traits().law_size == 2)
      for (int node : group.nodes) flags[static_cast<std::size_t>(node)] = 1;
  return flags;
}

// Nodes in the order of x, to search a strip of them.
std::vector<int> by_x(const Model& model, const std::vector<int>& nodes) {
  std::vector<int> order = nodes;
  std::sort(order.begin(), order.end(), [&](int i, int j) { return model.mesh.x(0, i) < model.mesh.x(0, j); });
  return order;
}

// Coincident nodes that no interface joins: often two parts that were meant to be one.
void warn_coincident(Builder& b, const std::vector<double>& shortest) {
  const Mesh& mesh = b.model.mesh;
  std::vector<int> used;
  double widest = 0.0;
  for (int n = 0; n < mesh.nodes(); ++n) {
    const double s = shortest[static_cast<std::size_t>(n)];
    if (!std::isfinite(s)) continue;
    used.push_back(n);
    widest = std::max(widest, kTogether * s);
  }
  const std::vector<int> order = by_x(b.model, used);
  const std::vector<char> joined = interface_nodes(b.model);
  Examples pairs;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && mesh.x(0, order[j]) - mesh.x(0, order[i]) <= widest; ++j) {
      const auto a = static_cast<std::size_t>(order[i]), c = static_cast<std::size_t>(order[j]);
      const double tolerance = kTogether * std::min(shortest[a], shortest[c]);
      if ((mesh.x.col(order[i]) - mesh.x.col(order[j])).norm() > tolerance || (joined[a] && joined[c]))
        continue;
      pairs.add(number_of(b.model, order[i]) + " and " + number_of(b.model, order[j]));
    }
  if (pairs.count > 0)
    b.warning({b.deck.file, 0, 0, 0}, std::to_string(pairs.count) +
                                          " pair(s) of nodes at one place are joined by no interface: " +
                                          pairs.text() + "; the parts are not connected there");
}

struct Edge {
  std::vector<int> nodes;  // corner, corner, inner
  int element = 0;         // deck number
  int uses = 1;
};

// Solid edges by their corners.  Where two elements of an edge have different inner nodes, those of one of them
// hang.
std::map<std::pair<int, int>, Edge> solid_edges(const Model& model, Examples& hanging) {
  std::map<std::pair<int, int>, Edge> edges;
  for (const Group& group : model.groups) {
    if (group.element->traits().law_size != 4) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& local : group.element->edges()) {
        Edge edge;
        for (int i : local) edge.nodes.push_back(group.nodes_of(e)[i]);
        edge.element = group.element_numbers[static_cast<std::size_t>(e)];
        const auto [it, fresh] = edges.try_emplace(std::minmax(edge.nodes[0], edge.nodes[1]), edge);
        if (fresh) continue;
        ++it->second.uses;
        const Edge& other = it->second;
        const Edge &longer = edge.nodes.size() > other.nodes.size() ? edge : other,
                   &shorter = edge.nodes.size() > other.nodes.size() ? other : edge;
        if (longer.nodes.size() > shorter.nodes.size())
          hanging.add("node " + number_of(model, longer.nodes[2]) + " of element " +
                      std::to_string(longer.element) + " on an edge of element " +
                      std::to_string(shorter.element) + " (nodes " + number_of(model, edge.nodes[0]) + " and " +
                      number_of(model, edge.nodes[1]) + ")");
      }
  }
  return edges;
}

// Nodes that stand on an edge of an element which does not have them: there displacements of both sides differ.
void warn_hanging(Builder& b, const std::vector<double>& shortest) {
  const Model& model = b.model;
  Examples hanging;
  const auto edges = solid_edges(model, hanging);
  std::vector<int> outline;
  for (const auto& [ends, edge] : edges)
    if (edge.uses == 1) outline.insert(outline.end(), edge.nodes.begin(), edge.nodes.end());
  std::sort(outline.begin(), outline.end());
  outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
  const std::vector<int> order = by_x(model, outline);
  const auto x = [&](int node) { return Vector2(model.mesh.x.col(node)); };
  for (const auto& [ends, edge] : edges) {
    if (edge.uses > 1 || edge.nodes.size() > 2) continue;  // inner nodes may bend an edge
    const Vector2 from = x(ends.first), along = x(ends.second) - from;
    const double length = along.norm();
    const double low = std::min(from.x(), x(ends.second).x()) - kTogether * length;
    const double high = std::max(from.x(), x(ends.second).x()) + kTogether * length;
    auto it = std::lower_bound(order.begin(), order.end(), low,
                               [&](int node, double value) { return model.mesh.x(0, node) < value; });
    for (; it != order.end() && model.mesh.x(0, *it) <= high; ++it) {
      if (*it == ends.first || *it == ends.second) continue;
      const Vector2 d = x(*it) - from;
      const double t = d.dot(along) / (length * length);
      const double off = std::abs(d.x() * along.y() - d.y() * along.x()) / length;
      const double near = kTogether * std::min(length, shortest[static_cast<std::size_t>(*it)]);
      if (off > near || t * length <= near || (1.0 - t) * length <= near) continue;
      hanging.add("node " + number_of(model, *it) + " on an edge of element " + std::to_string(edge.element) +
                  " (nodes " + number_of(model, ends.first) + " and " + number_of(model, ends.second) + ")");
    }
  }
  if (hanging.count > 0)
    b.warning({b.deck.file, 0, 0, 0},
              std::to_string(hanging.count) + " hanging node(s): " + hanging.text() +
                  "; the element does not have that node, and the mesh can gape or overlap there");
}

}  // namespace

void check_joints(Builder& b) {
  const std::vector<double> shortest = shortest_edges(b.model);
  warn_coincident(b, shortest);
  warn_hanging(b, shortest);
}

}  // namespace sage::build
