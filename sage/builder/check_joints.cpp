// Parts of a mesh that look joined and are not: nodes at one place, nodes on an edge they don't belong to,
// components without a common node; joints without a solid on one side.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/model/activity.hpp"

namespace sage::builder {

namespace {

constexpr double kTogether = 1e-6;  // of the shortest edge there: closer nodes are at one place
constexpr int kListed = 5;

std::string number_of(const Model& model, int node) {
  return std::to_string(model.mesh.number[node]);
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
  for (const Group& group : model.groups) {
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : edges) {
        const int* nodes = group.nodes_of(e);
        const double length = (model.mesh.x.col(nodes[edge[0]]) - model.mesh.x.col(nodes[edge[1]])).norm() /
                              static_cast<double>(edge.size() - 1);
        for (int local : edge) {
          double& s = shortest[nodes[local]];
          s = std::min(s, length);
        }
      }
  }
  return shortest;
}

std::vector<char> interface_nodes(const Model& model) {
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    if (group.interface())
      for (int node : group.nodes) flags[node] = 1;
  return flags;
}

// Sorts numbers that are spread evenly, as places in a mesh mostly are: each has its bucket at once.
void sort_spread(std::vector<std::pair<double, int>>& list) {
  if (list.empty()) return;
  const auto [low, high] = std::minmax_element(list.begin(), list.end());
  const double from = low->first;
  const double scale = static_cast<double>(list.size() - 1) / std::max(high->first - from, 1e-300);
  if (!std::isfinite(scale * (high->first - from))) return std::sort(list.begin(), list.end());
  const auto bucket = [&](double x) { return static_cast<std::size_t>((x - from) * scale); };
  std::vector<std::size_t> end(list.size() + 2, 0);
  for (const auto& one : list) ++end[bucket(one.first) + 2];
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<std::pair<double, int>> sorted(list.size());
  for (const auto& one : list) sorted[end[bucket(one.first) + 1]++] = one;
  for (std::size_t i = 1; i < end.size(); ++i)
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(end[i - 1]),
              sorted.begin() + static_cast<std::ptrdiff_t>(end[i]));
  list = std::move(sorted);
}

// Coincident nodes that no interface joins: often two parts that were meant to be one.  Neighbours are sought
// along a slanting line on which no two nodes of a regular mesh fall together, since its slope is irrational.
void warn_coincident(Builder& b, const std::vector<double>& shortest) {
  const Mesh& mesh = b.model.mesh;
  const Vector2 slant(std::cos(1.0), std::sin(1.0));
  std::vector<std::pair<double, int>> order;
  double widest = 0.0;
  for (int n = 0; n < mesh.nodes(); ++n) {
    const double s = shortest[n];
    if (!std::isfinite(s)) continue;
    order.emplace_back(slant.dot(mesh.x.col(n)), n);
    widest = std::max(widest, kTogether * s);
  }
  sort_spread(order);
  const std::vector<char> joined = interface_nodes(b.model);
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= widest; ++j) {
      const int first = std::min(order[i].second, order[j].second),
                second = std::max(order[i].second, order[j].second);
      const auto a = static_cast<std::size_t>(first), c = static_cast<std::size_t>(second);
      const double tolerance = kTogether * std::min(shortest[a], shortest[c]);
      if ((mesh.x.col(first) - mesh.x.col(second)).norm() > tolerance || (joined[a] && joined[c])) continue;
      found.emplace_back(first, second);
    }
  // Named from the lower left to the upper right.
  const auto place = [&](const std::pair<int, int>& pair) {
    const Vector2 along(0.8, 0.6);
    const std::pair a(along.dot(mesh.x.col(pair.first)), pair.first);
    const std::pair c(along.dot(mesh.x.col(pair.second)), pair.second);
    return std::pair(std::min(a, c), std::max(a, c));
  };
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& c) { return place(a) < place(c); });
  Examples pairs;
  for (const auto& [first, second] : found)
    pairs.add(number_of(b.model, first) + " and " + number_of(b.model, second));
  if (pairs.count > 0)
    b.warning("S336", b.at_line(0),
              std::to_string(pairs.count) + " pair(s) of nodes at one place are joined by no interface: " +
                  pairs.text() + "; the parts are not connected there");
}

// An edge of a solid, by its corners (the smaller node first).
struct EdgeUse {
  int a = 0, b = 0;
  int group = 0, element = 0, local = 0;
};

const std::vector<int>& local_nodes(const Model& model, const EdgeUse& use) {
  const Element& element = *model.groups[use.group].element;
  return element.edges()[use.local];
}

std::string element_of(const Model& model, const EdgeUse& use) {
  const Group& group = model.groups[use.group];
  return "element " + std::to_string(group.element_numbers[use.element]);
}

std::string ends_of(const Model& model, const EdgeUse& use) {
  return " (nodes " + number_of(model, use.a) + " and " + number_of(model, use.b) + ")";
}

// Edges that one solid alone has.  Where two have the same corners and not the same number of nodes, one hangs.
std::vector<EdgeUse> outline_edges(Builder& b, Examples& hanging) {
  const Model& model = b.model;
  std::vector<EdgeUse> alone;
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const std::span<const SolidEdge> edges = b.solid_edges().at(node);
    const auto use = [&](std::size_t i) {
      return EdgeUse{node, edges[i].other, edges[i].group, edges[i].element, edges[i].local};
    };
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
      for (end = i + 1; end < edges.size() && edges[end].other == edges[i].other;) ++end;
      if (end == i + 1) alone.push_back(use(i));
      for (std::size_t k = i + 1; k < end; ++k) {
        const bool more = local_nodes(model, use(k)).size() > local_nodes(model, use(i)).size();
        const EdgeUse longer = use(more ? k : i), shorter = use(more ? i : k);
        const std::vector<int>& nodes = local_nodes(model, longer);
        if (nodes.size() == local_nodes(model, shorter).size()) continue;
        const int* of_element = model.groups[longer.group].nodes_of(longer.element);
        hanging.add("node " + number_of(model, of_element[nodes[2]]) + " of " + element_of(model, longer) +
                    " on an edge of " + element_of(model, shorter) + ends_of(model, shorter));
      }
    }
  }
  return alone;
}

// Nodes that stand on an edge of an element which does not have them: there displacements of both sides differ.
void warn_hanging(Builder& b, const std::vector<double>& shortest) {
  const Model& model = b.model;
  Examples hanging;
  const std::vector<EdgeUse> edges = outline_edges(b, hanging);
  std::vector<std::pair<double, int>> order;  // the outline's nodes by x
  for (const EdgeUse& edge : edges)
    for (int local : local_nodes(model, edge)) {
      const int node = model.groups[edge.group].nodes_of(edge.element)[local];
      order.emplace_back(model.mesh.x(0, node), node);
    }
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  const auto x = [&](int node) { return Vector2(model.mesh.x.col(node)); };
  for (const EdgeUse& edge : edges) {
    if (local_nodes(model, edge).size() > 2) continue;  // inner nodes may bend an edge
    const Vector2 from = x(edge.a), along = x(edge.b) - from;
    const double length = along.norm(), reach = kTogether * length;
    const double low = std::min(from.x(), x(edge.b).x()) - reach,
                 high = std::max(from.x(), x(edge.b).x()) + reach;
    for (auto it = std::lower_bound(order.begin(), order.end(), std::pair(low, -1));
         it != order.end() && it->first <= high; ++it) {
      const int node = it->second;
      if (node == edge.a || node == edge.b) continue;
      const Vector2 d = x(node) - from;
      const double t = d.dot(along) / (length * length);
      const double off = std::abs(d.x() * along.y() - d.y() * along.x()) / length;
      const double near = kTogether * std::min(length, shortest[node]);
      if (off > near || t * length <= near || (1.0 - t) * length <= near) continue;
      hanging.add("node " + number_of(model, node) + " on an edge of " + element_of(model, edge) +
                  ends_of(model, edge));
    }
  }
  if (hanging.count > 0)
    b.warning("S337", b.at_line(0),
              std::to_string(hanging.count) + " hanging node(s): " + hanging.text() +
                  "; the element does not have that node, and the mesh can gape or overlap there");
}

// A structure along a side of a solid must have all of the side's nodes, and no others: elsewhere both part.
void warn_structures_on_sides(Builder& b) {
  const Model& model = b.model;
  Examples found;
  for (const Group& group : model.groups) {
    if (!group.structure() || group.entry->corners != 2) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int first = std::min(group.nodes_of(e)[0], group.nodes_of(e)[1]),
                last = std::max(group.nodes_of(e)[0], group.nodes_of(e)[1]);
      for (const SolidEdge& edge : b.solid_edges().at(first)) {
        if (edge.other != last) continue;
        const EdgeUse use{first, last, edge.group, edge.element, edge.local};
        const std::size_t nodes = local_nodes(model, use).size();
        if (nodes == group.node_count()) continue;
        found.add("element " + std::to_string(group.element_numbers[e]) + " (" + group.element_name +
                  ") on a side of " + element_of(model, use) + " with " + std::to_string(nodes) + " nodes");
        break;
      }
    }
  }
  if (found.count > 0)
    b.warning("S337", b.at_line(0),
              std::to_string(found.count) + " structure(s) with other nodes than the sides that they lie on: " +
                  found.text() + "; between their ends the two are not connected");
}

// Flags of nodes that solids have: those of the groups that `counts` lets through.
template <class Counts>
std::vector<char> solid_nodes(const Model& model, Counts counts) {
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (model.groups[g].solid() && counts(g))
      for (int node : model.groups[g].nodes) flags[node] = 1;
  return flags;
}

// Nodes of active joints that no active solid has and that are free to move: where they stand once the joint
// opens is arbitrary.  A side that is held is a rigid body.
void warn_bare_joints(Builder& b) {
  const Model& model = b.model;
  if (!std::ranges::any_of(model.groups, [](const Group& g) { return g.interface(); })) return;
  const std::vector<char> ever = solid_nodes(model, [](std::size_t) { return true; });
  std::vector<char> reported(model.groups.size(), 0);
  Activity activity(model);
  for (const Stage& stage : model.stages) {
    activity.enter(stage);
    const std::vector<char> now = solid_nodes(model, [&](std::size_t g) { return activity.group[g] != 0; });
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      if (!group.interface() || !activity.group[g] || reported[g]) continue;
      Examples elements, nodes;
      std::vector<int> bare;
      for (int e = 0; e < group.elements(); ++e) {
        const std::size_t before = bare.size();
        for (std::size_t i = 0; i < group.node_count(); ++i) {
          const int node = group.nodes_of(e)[i];
          const auto n = static_cast<std::size_t>(node);
          const bool held = activity.holds(node, 0) && activity.holds(node, 1);
          // Nodes that no solid ever has are a body of the deck's own, which its loads may hold.
          if (ever[n] && !now[n] && !held) bare.push_back(node);
        }
        if (bare.size() > before) elements.add(std::to_string(group.element_numbers[e]));
      }
      if (bare.empty()) continue;
      reported[g] = 1;
      std::sort(bare.begin(), bare.end());
      bare.erase(std::unique(bare.begin(), bare.end()), bare.end());
      for (const int node : bare) nodes.add(number_of(model, node));
      b.warning("S338", stage.where,
                "stage " + std::to_string(stage.number) + ": no solid is active on one side of joint group " +
                    std::to_string(group.number) + ", element(s) " + elements.text() + ": node(s) " +
                    nodes.text() +
                    " hang on the joint alone, and where they stand once it opens is arbitrary; remove the "
                    "joint with its solid, place it with its solid, or hold the nodes");
    }
  }
}

}  // namespace

void check_joints(Builder& b) {
  warn_bare_joints(b);
  const std::vector<double> shortest = shortest_edges(b.model);
  warn_coincident(b, shortest);
  warn_hanging(b, shortest);
  warn_structures_on_sides(b);
}

}  // namespace sage::builder
