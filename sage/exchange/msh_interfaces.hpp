// Interfaces in MSH, which has no element for them: two physical curves, `interface_bottom=NAME` and
// `interface_top=NAME`, with a line each for every interface element, at one place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::msh {

inline constexpr std::string_view kInterfaceBottom = "interface_bottom=", kInterfaceTop = "interface_top=";

// Local nodes of an interface element in the order of a line of Gmsh's: its ends, then those between; node i of
// the top lies on node i of the bottom.  Empty where the entry does not say where its nodes are.
struct InterfaceSides {
  std::vector<int> bottom, top;
};
InterfaceSides interface_sides(const ElementEntry& entry);

// The first interface of the catalogue whose sides have so many nodes; nullptr = there is none.
const ElementEntry* interface_of(const Registry<ElementEntry>& elements, std::size_t nodes_of_a_side,
                                 int& code);

}  // namespace sage::msh
