// Which side of an interface is whose.  The pairs of a zero-thickness interface coincide, so coordinates can't
// show swapped sides (opening and closing would change places).  The solids at the sides can: their nodes run
// counter- clockwise, so each lies to the left of its own directed edges.
#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "sage/builder/builder.hpp"
#include "sage/core/contact.hpp"

namespace sage::builder {

namespace {

// Directed edge between nodes of interfaces -> number of a solid to the left of it.  All solids count, active now or in
// a later stage.
class EdgesOfSolids {
 public:
  explicit EdgesOfSolids(const Model& model) : of_interface_(static_cast<std::size_t>(model.mesh.nodes()), 0) {
    for (const Group& group : model.groups)
      if (group.interface())
        for (const int node : group.nodes) of_interface_[node] = 1;
    for (const Group& group : model.groups) {
      if (!group.solid()) continue;
      for (int e = 0; e < group.elements(); ++e)
        for (const std::vector<int>& edge : group.element->edges())
          add_edge(group.nodes_of(e), edge, group.element_numbers[e]);
    }
  }

  // Number of the solid to the left of a -> b, 0 if there is none.
  int left_of(int a, int b) const {
    const auto it = solid_.find(key(a, b));
    return it == solid_.end() ? 0 : it->second;
  }

 private:
  static std::uint64_t key(int a, int b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32U | static_cast<std::uint32_t>(b);
  }

  // From corner to corner, and piece by piece over mid-side nodes: linear interfaces
  // may lie on a quadratic edge.
  void add_edge(const int* nodes, const std::vector<int>& edge, int number) {
    const int first = nodes[edge[0]], last = nodes[edge[1]];
    add_piece(first, last, number);
    if (edge.size() == 2) return;
    int from = first;
    for (std::size_t i = 2; i < edge.size(); ++i) {
      add_piece(from, nodes[edge[i]], number);
      from = nodes[edge[i]];
    }
    add_piece(from, last, number);
  }
  void add_piece(int a, int b, int number) {
    if (of_interface_[a] && of_interface_[b]) solid_.try_emplace(key(a, b), number);
  }

  std::vector<char> of_interface_;  // of each node
  std::unordered_map<std::uint64_t, int> solid_;
};

// The solids on the two hands of one side, which is walked in the direction 1 -> 2.
struct Side {
  int left = 0, right = 0;  // element numbers, 0 = none
  bool touched() const { return left > 0 || right > 0; }
};

std::string owner(int element, const char* nodes, const char* hand) {
  return "element " + std::to_string(element) + ", which owns its nodes " + nodes + ", lies to the " + hand +
         " of the line from node 1 to node 2";
}

// The node fields of the element card at a line; the line alone where no such card is found.
SourcePosition node_fields(const Builder& b, int line, int nodes) {
  for (const CardView& card : b.deck.all("element")) {
    if (card.card().line != line) continue;
    SourcePosition where = card.where("n1");
    const SourcePosition last = card.where("n" + std::to_string(nodes));
    if (last.line == where.line && last.last_column > where.first_column) where.last_column = last.last_column;
    return where;
  }
  return b.at_line(line);
}

class SideCheck {
 public:
  explicit SideCheck(Builder& b) : b_(b), solids_(b.model) {}

  void check(const Group& group) {
    int alone = 0, first_alone = 0, error_line = 0;
    for (int e = 0; e < group.elements(); ++e) {
      const int* n = group.nodes_of(e);
      const Side bottom{solids_.left_of(n[0], n[1]), solids_.left_of(n[1], n[0])};
      const Side top{solids_.left_of(n[3], n[2]), solids_.left_of(n[2], n[3])};
      const int line = group.element_lines[e];
      const int number = group.element_numbers[e];
      if (!bottom.touched() && !top.touched() && ++alone == 1) first_alone = number;
      const int nodes = static_cast<int>(group.node_count());
      const std::string wrong = trouble(bottom, top, *group.entry);
      if (wrong.empty() || line == error_line) continue;  // one message a card
      error_line = line;
      b_.error("S327", node_fields(b_, line, nodes),
               "element " + std::to_string(number) + " (" + group.element_name + "): " + wrong);
    }
    if (alone > 0)
      b_.note("S335", group.where,
              "group " + std::to_string(group.number) + ": " + std::to_string(alone) +
                  " interface element(s) touch no solid on either side, the first is element " +
                  std::to_string(first_alone) + "; which side is which can't be checked there");
  }

 private:
  // The nodes of the element whose top is this one's bottom: "4 3 2 1".
  static std::string swapped_order(const ElementEntry& entry) {
    std::string order;
    for (const auto& [x, y] : entry.parent_nodes) {
      const auto it = std::ranges::find(entry.parent_nodes, std::array{x, -y});
      order += (order.empty() ? "" : " ") + std::to_string(it - entry.parent_nodes.begin() + 1);
    }
    return order;
  }

  // Nodes 1 2 belong to a body on the right of 1 -> 2, nodes 3 4 to one on the left.  Empty = as it should be.
  static std::string trouble(const Side& bottom, const Side& top, const ElementEntry& entry) {
    const bool wrong_bottom = bottom.left > 0 && bottom.right == 0;
    const bool wrong_top = top.right > 0 && top.left == 0;
    if (wrong_bottom && top.left > 0)
      return "both sides belong to bodies on the left of the line from node 1 to node 2, elements " +
             std::to_string(bottom.left) + " and " + std::to_string(top.left) + ", which overlap there";
    if (wrong_top && bottom.right > 0)
      return "both sides belong to bodies on the right of the line from node 1 to node 2, elements " +
             std::to_string(bottom.right) + " and " + std::to_string(top.right) + ", which overlap there";
    if (!wrong_bottom && !wrong_top) return {};
    std::string words = "its sides are swapped: ";
    if (wrong_bottom) words += owner(bottom.left, "1 and 2", "left");
    if (wrong_bottom && wrong_top) words += ", and ";
    if (wrong_top) words += owner(top.right, "3 and 4", "right");
    return words +
           "; nodes 1 and 2 must be those of the body on the right of that line (below it where it runs along "
           "+x), "
           "nodes 3 and 4 those of the body on the left: node order " +
           swapped_order(entry) + " would be right";
  }

  Builder& b_;
  EdgesOfSolids solids_;
};

}  // namespace

void check_interfaces(Builder& b) {
  bool any = false;
  const auto has_pairs = [](const Group& group) { return group.interface() && !is_contact(*group.entry); };
  for (const Group& group : b.model.groups) any = any || has_pairs(group);
  if (!any) return;
  SideCheck sides(b);
  for (const Group& group : b.model.groups)
    if (has_pairs(group)) sides.check(group);
}

}  // namespace sage::builder
