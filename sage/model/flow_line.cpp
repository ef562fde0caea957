#include "sage/model/flow_line.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

namespace sage {

namespace {

// An element with some of its nodes on the line, and its edges as pairs of corners.
struct Neighbour {
  std::size_t group = 0;
  int element = 0;
  std::vector<std::vector<int>> edges;  // nodes of each, in order along the edge
};

// Nodes of an edge from its first corner to its second.
std::vector<int> along(const int* nodes, const std::vector<int>& edge) {
  std::vector<int> list{nodes[edge[0]]};
  for (std::size_t i = 2; i < edge.size(); ++i) list.push_back(nodes[edge[i]]);
  list.push_back(nodes[edge[1]]);
  return list;
}

std::vector<Neighbour> neighbours_of(const Model& model, const std::vector<char>& active,
                                     const std::vector<char>& on_line) {
  std::vector<Neighbour> list;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.flow() || !active[g]) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      const auto listed = [&](int n) { return on_line[n] != 0; };
      if (std::none_of(nodes, nodes + group.node_count(), listed)) continue;
      Neighbour one{g, e, {}};
      for (const std::vector<int>& edge : group.element->edges()) one.edges.push_back(along(nodes, edge));
      list.push_back(std::move(one));
    }
  }
  return list;
}

using Step = std::pair<int, int>;  // from node to node

// A list whose first node comes again is a closed line.  Where nodes were added on either side of the first, the
// walk may have gone round the wrong way.
void close(const std::vector<int>& nodes, std::vector<int>& order) {
  const auto again = std::find(nodes.begin() + 1, nodes.end(), nodes.front());
  if (again == nodes.end()) return;
  const auto place = [&](int node) { return std::find(order.begin(), order.end(), node); };
  if (place(nodes[1]) > place(*(again - 1))) std::reverse(order.begin() + 1, order.end());
  order.push_back(order.front());
}

// The nodes in the order of the line: a walk along element edges, from its first node towards its second.
// Empty where there is no such walk over all of them.
std::vector<int> walk(const std::vector<Neighbour>& around, const std::vector<int>& nodes) {
  const std::set<int> on_line(nodes.begin(), nodes.end());
  std::map<int, std::set<int>> next;
  for (const Neighbour& one : around)
    for (const std::vector<int>& edge : one.edges) {
      if (!std::ranges::all_of(edge, [&](int n) { return on_line.contains(n); })) continue;
      for (std::size_t i = 1; i < edge.size(); ++i) {
        next[edge[i - 1]].insert(edge[i]);
        next[edge[i]].insert(edge[i - 1]);
      }
    }
  std::unordered_map<int, std::size_t> place;  // in the list, where a node first stands
  for (std::size_t i = 0; i < nodes.size(); ++i) place.try_emplace(nodes[i], i);
  std::vector<int> order{nodes.front()};
  std::set<int> seen{nodes.front()};
  while (true) {
    int best = -1;
    // Where the way parts, the list says which comes first; what refining added comes before what it lies
    // between.
    for (const int candidate : next[order.back()])
      if (!seen.contains(candidate) && (best < 0 || place.at(candidate) < place.at(best))) best = candidate;
    if (best < 0) break;
    order.push_back(best);
    seen.insert(best);
  }
  if (seen.size() != on_line.size()) return {};
  close(nodes, order);
  return order;
}

enum class Side { none, left, right, both };

Side joined(Side a, Side b) {
  if (a == Side::none || a == b) return b;
  return b == Side::none ? a : Side::both;
}

// On which side of the line an edge's element lies: elements have their edges counter-clockwise.
Side side_of(const std::vector<int>& edge, const std::set<Step>& steps) {
  const auto all = [&](bool forward) {
    for (std::size_t i = 1; i < edge.size(); ++i)
      if (!steps.contains(forward ? Step{edge[i - 1], edge[i]} : Step{edge[i], edge[i - 1]})) return false;
    return true;
  };
  return all(true) ? Side::left : all(false) ? Side::right : Side::none;
}

// The side of each element around a node.  Elements that share an edge there which is not of the line lie on
// the same one.
std::vector<Side> sides_around(int node, const std::vector<const Neighbour*>& around,
                               const std::set<Step>& steps) {
  std::vector<std::size_t> same(around.size());
  std::iota(same.begin(), same.end(), std::size_t{0});
  std::map<std::pair<int, int>, std::size_t> first;  // element with the edge, by its ends
  std::vector<Side> own(around.size(), Side::none);
  for (std::size_t i = 0; i < around.size(); ++i)
    for (const std::vector<int>& edge : around[i]->edges) {
      const Side side = side_of(edge, steps);
      if (std::ranges::find(edge, node) == edge.end()) continue;
      own[i] = joined(own[i], side);
      if (side != Side::none) continue;
      const auto [found, added] = first.try_emplace(std::minmax(edge.front(), edge.back()), i);
      if (added) continue;
      const std::size_t from = same[i], to = same[found->second];
      std::ranges::replace(same, from, to);
    }
  std::vector<Side> sides(around.size(), Side::none);
  for (std::size_t i = 0; i < around.size(); ++i)
    for (std::size_t k = 0; k < around.size(); ++k)
      if (same[i] == same[k]) sides[i] = joined(sides[i], own[k]);
  return sides;
}

// False: the line does not part the elements around the node.
bool add_corners(const Model& model, int node, const std::vector<Neighbour>& around,
                 const std::set<Step>& steps, FlowLine& line) {
  std::vector<const Neighbour*> here;
  std::vector<int> local;
  for (const Neighbour& one : around) {
    const Group& group = model.groups[one.group];
    const int* const begin = group.nodes_of(one.element);
    const int* const end = begin + group.node_count();
    const int* const found = std::find(begin, end, node);
    if (found == end) continue;
    here.push_back(&one);
    local.push_back(static_cast<int>(found - begin));
  }
  const std::vector<Side> sides = sides_around(node, here, steps);
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (sides[i] == Side::both) return false;
    if (sides[i] == Side::left) line.corners.push_back({here[i]->group, here[i]->element, local[i]});
  }
  return true;
}

void add_edges(const std::vector<Neighbour>& around, const std::set<Step>& steps, FlowLine& line) {
  for (const Neighbour& one : around)
    for (std::size_t e = 0; e < one.edges.size(); ++e)
      if (side_of(one.edges[e], steps) == Side::left)
        line.edges.push_back({one.group, one.element, static_cast<int>(e)});
}

}  // namespace

FlowLine flow_line(const Model& model, const std::vector<char>& active, const std::vector<int>& nodes) {
  FlowLine line;
  const auto number = [&](int node) { return std::to_string(model.mesh.number[node]); };
  const std::set<int> on_line(nodes.begin(), nodes.end());
  if (on_line.size() < 2) return line.fault = "it needs two nodes or more", line;
  std::vector<char> listed(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const int node : nodes) listed[node] = 1;
  const std::vector<Neighbour> around = neighbours_of(model, active, listed);
  const std::vector<int> order = walk(around, nodes);
  if (order.empty()) {
    line.fault =
        "its nodes do not follow each other along edges of flow elements that are active (mid-side nodes "
        "belong to the list)";
    return line;
  }
  std::set<Step> steps;
  for (std::size_t i = 1; i < order.size(); ++i) steps.insert({order[i - 1], order[i]});
  for (const int node : on_line) {
    if (add_corners(model, node, around, steps, line)) continue;
    line.fault =
        "it ends at node " + number(node) +
        ", inside the flow: it must begin and end at its edge, or be closed (its first node also last)";
    return line;
  }
  if (line.corners.empty())
    line.fault =
        "no flow element that is active lies on its left; list its nodes so that the water that flows out "
        "comes from the left";
  add_edges(around, steps, line);
  return line;
}

}  // namespace sage
