#include "sage/exchange/msh_interfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sage::msh {

namespace {

std::vector<int> side_of(const ElementEntry& entry, bool top) {
  std::vector<int> nodes;
  for (int i = 0; i < entry.nodes; ++i)
    if ((entry.parent_nodes[i][1] > 0.0) == top) nodes.push_back(i);
  const auto order = [&](int i) {
    const double xi = entry.parent_nodes[i][0];
    return std::pair(std::abs(xi) < 1.0, xi);
  };
  std::ranges::sort(nodes, {}, order);
  return nodes;
}

}  // namespace

InterfaceSides interface_sides(const ElementEntry& entry) {
  if (entry.parent_nodes.size() != static_cast<std::size_t>(entry.nodes)) return {};
  InterfaceSides sides{side_of(entry, false), side_of(entry, true)};
  if (sides.bottom.size() != sides.top.size()) return {};
  return sides;
}

const ElementEntry* interface_of(const Registry<ElementEntry>& elements, std::size_t nodes_of_a_side,
                                 int& code) {
  for (const auto& [number, entry] : elements.entries())
    if (entry.interface() && interface_sides(entry).bottom.size() == nodes_of_a_side) {
      code = number;
      return &entry;
    }
  return nullptr;
}

}  // namespace sage::msh
