// Nested dissection without coordinates: separators are levels of breadth-first searches.
#pragma once

#include <cstddef>
#include <vector>

#include "solvers/equation_graph.hpp"

namespace sage {

// Parts in the order of elimination: children before their parent, every subtree contiguous.  A leaf is a part
// of the graph small enough to be one dense block; any other part is the separator of what lies below it.
struct SeparatorTree {
  IndexLists groups;        // part -> groups, ascending
  std::vector<int> parent;  // part -> part, -1 = root
};

// Groups from which on another thread gains time with a side of a separator: some milliseconds of work.
inline constexpr std::size_t kGroupsWorthAThread = 5000;

// Parts of at most `leaf_equations` equations are not divided further.  George & Liu (1981), chapter 8: a level
// of the search separates what lies before it from what lies behind.  Two searches compete: from the end of a
// pseudo-diameter, and from the separator above; the smaller balanced separator wins.
// The groups of the last `border` equations are the last part, and the parent of all that had none: what is before
// them is divided as if they were not there.
// The tree is the same for any number of threads.
SeparatorTree nested_dissection(const EquationGraph& graph, int leaf_equations, int border = 0, int threads = 1,
                                std::size_t worth_a_thread = kGroupsWorthAThread);

}  // namespace sage
