// The edges of solids, each found at its smaller node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// An edge of one solid, by its corners; two solids side by side have two of them, one in each direction.
struct SolidEdge {
  int other = 0;  // its larger node
  int group = 0, element = 0;
  std::int16_t local = 0;  // edge of the element
  bool reversed = false;   // the element goes from the larger node to the smaller one
};

// Of the mesh as it is when this is made.
class SolidEdges {
 public:
  explicit SolidEdges(const Model& model);
  // Of the groups that are wanted, by their places in Model::groups.
  SolidEdges(const Model& model, const std::function<bool(std::size_t group)>& wanted);
  // Those whose smaller node this is, in the order of their larger nodes; those of one pair in the order of groups
  // and elements.
  std::span<const SolidEdge> at(int node) const {
    const auto i = static_cast<std::size_t>(node);
    return std::span(edges_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  // Whether one goes from node to node, as it does where its solid lies on the left.
  bool has(int from, int to) const;
  // act(node, edge) for those that one solid alone has, by rising nodes.
  template <class Act>
  void for_single(const Act& act) const {
    for (std::size_t node = 0; node + 1 < first_.size(); ++node)
      for (std::size_t i = first_[node], next = i; i < first_[node + 1]; i = next) {
        while (next < first_[node + 1] && edges_[next].other == edges_[i].other) ++next;
        if (next - i == 1) act(static_cast<int>(node), edges_[i]);
      }
  }

 private:
  std::vector<std::size_t> first_;  // of each node, and one behind the last
  std::vector<SolidEdge> edges_;
};

}  // namespace sage
