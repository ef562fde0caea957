// Symbolic side of the multifrontal solver (Duff & Reid 1983): one dense front for each
// part of the separator tree.
//
// A front has the pivots of its part and the equations that they touch later, its border.  Its local index runs
// over pivots and border, each padded to whole tiles of 8.  Arms hold the pivot rows (U) and, transposed, the
// pivot columns (L) in panels of 8 columns: term k * 8 + v of panel J couples pivot k to column v of J.  A
// panel has a row for each pivot up to its own last one, and none for padding.  The border matrix, which goes
// to the parent, is stored in panels of 8 columns too, tile (I, J) at border_panel(J) + I * 64.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sage/core/large_pages.hpp"
#include "solvers/assembled_matrix.hpp"
#include "solvers/nested_dissection.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

struct Front {
  int parent = -1;
  int first = 0;  // position of the first pivot in the elimination
  int pivots = 0;
  int border_begin = 0;  // into FrontTree::border
  int border = 0;
  int pivot_tiles = 0, border_tiles = 0;
  bool symmetric = false;      // of the border matrix only the upper triangle is there
  std::int64_t arms = 0;       // first term of its arms in the factors: U, then L
  std::int64_t border_at = 0;  // first term of its border matrix: in the workspace of its subtree, or
  bool shared = false;         // in the one that all share

  // Floating-point operations of the elimination of its pivots.
  double operations(bool symmetric_matrix) const {
    double count = 0.0;
    for (int left = border + pivots - 1; left >= border; --left)
      count += symmetric_matrix ? left * (left + 3.0) : left * (2.0 * left + 1.0);
    return count;
  }
  // First term of panel J in an arm.
  std::int64_t panel(int J) const {
    return J < pivot_tiles ? std::int64_t{32} * J * (J + 1)
                           : pivot_terms() + std::int64_t{8} * pivots * (J - pivot_tiles);
  }
  std::int64_t pivot_terms() const {  // the panels of pivots: the last one has no padding
    return std::int64_t{32} * pivot_tiles * (pivot_tiles - 1) + std::int64_t{8} * pivots;
  }
  std::int64_t arm_terms() const { return panel(pivot_tiles + border_tiles); }
  // Tiles of panel J of the border matrix.  Panels that are worked on side by side have the same.
  int border_rows(int J) const {
    return symmetric ? std::min(border_tiles, (J / kWidth + 1) * kWidth) : border_tiles;
  }
  // First term of panel J of the border matrix.
  std::int64_t border_panel(int J) const {
    if (!symmetric) return std::int64_t{kTileTerms} * J * border_tiles;
    const std::int64_t before = J / kWidth;  // blocks of such panels
    return kTileTerms * (kWidth * kWidth * before * (before + 1) / 2 + (J % kWidth) * border_rows(J));
  }
  std::int64_t border_terms() const { return border_panel(border_tiles); }
};

// Fronts begin .. end - 1: a whole subtree, whose root is end - 1.
struct Subtree {
  int begin = 0, end = 0;
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

  // Terms of the assembled matrix that front f takes: entries entry_start[f] .. entry_start[f + 1] - 1.
  std::vector<int> entry_start;
  LargeVector<int> entry_source, entry_target;  // target: term within the arms of its front
};

// Of the pair of pivots i, j of a front, local indices: its term within the arms.  U holds whole tiles of the
// diagonal; of symmetric matrices i <= j.
std::int64_t arm_target(const Front& front, int i, int j);

// border: so many equations, the last ones, stay.  Throws std::length_error where a front has more than 2^31 - 1
// terms.
FrontTree make_front_tree(const EquationGraph& graph, const AssembledMatrix& matrix, int leaf_equations,
                          int border = 0, int threads = 1);

}  // namespace sage
