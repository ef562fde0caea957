// Symbolic side of the multifrontal solver (Duff & Reid 1983): one dense front for each
// part of the separator tree.
//
// A front has the pivots of its part and the equations that they touch later, its border (front.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "sage/platform/large_pages.hpp"
#include "solvers/assembled_matrix.hpp"
#include "solvers/front.hpp"
#include "solvers/nested_dissection.hpp"

namespace sage {

// Floating-point operations of the elimination of a front's pivots.
double elimination_operations(const Front& front, bool symmetric_matrix);

// Fronts begin .. end - 1: a whole subtree, whose root is end - 1.
struct Subtree {
  int begin = 0, end = 0;
};

// source: term of the matrix; target: term within the arms of its front.
struct Entries {
  LargeVector<int> source, target;
};

// Entries begin .. end - 1 of a list.
struct EntryRange {
  int list = 0, begin = 0, end = 0;
};

struct FrontTree {
  std::vector<int> order, position;  // position in the elimination -> equation, and back
  std::vector<Front> fronts;         // in the order of elimination
  IndexLists children;               // front -> fronts
  std::vector<int> border;           // positions of every front's border, ascending
  std::vector<int> in_parent;        // their local indices in the parent front
  std::int64_t factor_terms = 0;
  int kept = -1;  // the front of a border that stays: the last one, whose pivots are not eliminated; -1 = none

  // Work that can be done side by side: subtrees first, each with a workspace, then the fronts above them in
  // turn.  The division depends on the tree alone, so that answers do not depend on the number of threads.
  std::vector<Subtree> subtrees;
  std::vector<int> top;
  std::int64_t subtree_terms = 0, shared_terms = 0;  // of the workspaces

  // Terms of the assembled matrix, by the fronts that take them: a list for each subtree, so that it can go when its
  // subtree is done, and the last one for the fronts above them.
  std::vector<Entries> entries;
  std::vector<EntryRange> entries_of;  // front
};

// Of the pair of pivots i, j of a front, local indices: its term within the arms.  U holds whole tiles of the
// diagonal; of symmetric matrices i <= j.
std::int64_t arm_target(const Front& front, int i, int j);

// All but the lists of entries.  width: of the kernels (TileKernels).  border: so many equations, the last ones, stay.
// Throws std::length_error where a front has more than 2^31 - 1 terms.
FrontTree make_front_tree(const EquationGraph& graph, const AssembledMatrix& matrix, int leaf_equations,
                          int width, int border = 0, int threads = 1);

// Makes the lists of entries, of a new tree or of one that has given them away.
void list_entries(const AssembledMatrix& matrix, FrontTree& tree);

}  // namespace sage
