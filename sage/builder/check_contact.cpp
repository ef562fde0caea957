// Elements of contact: their edge is one of a solid, which stands on the left of their line, and something holds the line.
#include <algorithm>
#include <map>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/core/contact.hpp"

namespace sage::builder {

namespace {

using Ends = std::pair<int, int>;

Ends ends_of(int a, int b) {
  return std::minmax(a, b);
}

// An edge of a solid: its nodes, ends first, and the middle of the solid's nodes.
struct TouchedEdge {
  std::vector<int> nodes;
  Vector2 inside;
};

class ContactCheck {
 public:
  explicit ContactCheck(Builder& b) : b_(b), mesh_(b.model.mesh) {
    for (const Group& group : b.model.groups)
      if (is_contact(*group.entry))
        for (int e = 0; e < group.elements(); ++e)
          solid_edges_[ends_of(group.nodes_of(e)[0], group.nodes_of(e)[1])] = {};
    for (const Group& group : b.model.groups) {
      if (is_contact(*group.entry)) continue;
      others_.insert(group.nodes.begin(), group.nodes.end());
      if (group.solid()) take_edges(group);
    }
  }

  void check(const Group& group) {
    constexpr int kShown = 5;
    const auto edge = static_cast<std::size_t>(group.node_count()) - 2;
    for (int e = 0; e < group.elements() && shown_ < kShown; ++e) {
      const int* const nodes = group.nodes_of(e);
      const TouchedEdge& solid = solid_edges_[ends_of(nodes[0], nodes[1])];
      const int *const first = nodes + edge, *const second = first + 1;
      if (solid.nodes.empty())
        complain("S560", group, e,
                 "no solid has an edge from node " + number(nodes[0]) + " to node " + number(nodes[1]) +
                     "; expected the nodes of one edge, ends first");
      else if (solid.nodes.size() != edge || (edge == 3 && solid.nodes[2] != nodes[2]))
        complain(
            "S560", group, e,
            "the edge of the solid has the nodes " + list(solid.nodes) + "; expected these, the ends first" +
                (solid.nodes.size() <= 3 ? ", in an element contact" + std::to_string(solid.nodes.size() + 2)
                                         : "; there is no contact for edges of that many nodes"));
      else if (!given_.insert({ends_of(nodes[0], nodes[1]), ends_of(*first, *second)}).second)
        complain("S560", group, e, "the same edge and line are given twice");
      else if (left_of(*first, *second, solid.inside) <= 0.0)
        complain("S561", group, e,
                 "the solid is on the right of the way from node " + number(*first) + " to node " +
                     number(*second) + " of the line; exchange the two");
      else
        for (const int* node : {first, second})
          if (!others_.contains(*node) && !is_held(*node))
            complain("S561", group, e,
                     "node " + number(*node) +
                         " of the line is held by no support; expected x and y of both ends to be fixed");
    }
  }

 private:
  void take_edges(const Group& group) {
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      for (const std::vector<int>& edge : group.element->edges()) {
        const auto found = solid_edges_.find(ends_of(nodes[edge[0]], nodes[edge[1]]));
        if (found == solid_edges_.end()) continue;
        found->second.nodes.clear();
        for (const int local : edge) found->second.nodes.push_back(nodes[local]);
        found->second.inside.setZero();
        for (std::size_t i = 0; i < group.node_count(); ++i)
          found->second.inside += mesh_.x.col(nodes[i]) / static_cast<double>(group.node_count());
      }
    }
  }
  double left_of(int from, int to, const Vector2& place) const {
    const Vector2 way = mesh_.x.col(to) - mesh_.x.col(from), d = place - mesh_.x.col(from);
    return way.x() * d.y() - way.y() * d.x();
  }
  // In both directions, at some time.
  bool is_held(int node) const {
    bool held[2] = {false, false};
    const auto look = [&](const std::vector<Fixity>& fixities) {
      for (const Fixity& f : fixities)
        for (std::size_t c = 0; c < 2; ++c)
          held[c] = held[c] || (f.node == node && f.code[c] == FixityCode::fixed);
    };
    look(b_.model.fixities);
    for (const Stage& stage : b_.model.stages) look(stage.fixities);
    return held[0] && held[1];
  }
  std::string number(int node) const { return std::to_string(mesh_.number[node]); }
  std::string list(const std::vector<int>& nodes) const {
    std::string text;
    for (const int node : nodes) text += (text.empty() ? "" : " ") + number(node);
    return text;
  }
  void complain(Code code, const Group& group, int element, const std::string& words) {
    ++shown_;
    SourcePosition where = group.where;
    if (const auto e = static_cast<std::size_t>(element); e < group.element_lines.size())
      where = {b_.model.file, group.element_lines[e], 0, 0};
    b_.error(
        code, where,
        "element " + std::to_string(group.element_numbers[element]) + " (" + group.entry->name + "): " + words);
  }

  Builder& b_;
  const Mesh& mesh_;
  std::map<Ends, TouchedEdge> solid_edges_;
  std::set<int> others_;  // nodes of elements that are no contact
  std::set<std::pair<Ends, Ends>> given_;
  int shown_ = 0;
};

}  // namespace

void check_contact(Builder& b) {
  if (std::ranges::none_of(b.model.groups, [](const Group& group) { return is_contact(*group.entry); })) return;
  ContactCheck contact(b);
  for (const Group& group : b.model.groups)
    if (is_contact(*group.entry)) contact.check(group);
}

}  // namespace sage::builder
