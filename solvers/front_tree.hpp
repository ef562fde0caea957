// Symbolic side of the multifrontal solver (Duff & Reid 1983): one dense front for each part of the separator
// tree.
//
// A front has the pivots of its part and the equations that they touch later, its border.  Its local index runs
// over pivots and border, each padded to whole tiles of 8.  Arms hold the pivot rows (U) and, transposed, the
// pivot columns (L), as tiles of tile_profile.hpp: tile (K, J) with K < pivot tiles begins at term (J * pivot
// tiles + K) * 64.  The border matrix, which goes to the parent, is stored in panels of 8 columns: tile (I, J)
// at (J * border tiles + I) * 64.
#pragma once

#include <cstdint>
#include <vector>

#include "solvers/assembled_matrix.hpp"
#include "solvers/nested_dissection.hpp"

namespace sage {

struct Front {
  int parent = -1;
  int first = 0;  // position of the first pivot in the elimination
  int pivots = 0;
  int border_begin = 0;  // into FrontTree::border
  int border = 0;
  int pivot_tiles = 0, border_tiles = 0;
  std::int64_t arms = 0;       // first term of its arms in the factors: U, then L
  std::int64_t workspace = 0;  // first term of its border matrix in the workspace

  std::int64_t arm_terms() const { return std::int64_t{64} * pivot_tiles * (pivot_tiles + border_tiles); }
  std::int64_t border_terms() const { return std::int64_t{64} * border_tiles * border_tiles; }
};

struct FrontTree {
  std::vector<int> order, position;  // position in the elimination -> equation, and back
  std::vector<Front> fronts;         // in the order of elimination
  IndexLists children;               // front -> fronts
  std::vector<int> border;           // positions of every front's border, ascending
  std::vector<int> in_parent;        // their local indices in the parent front
  std::int64_t factor_terms = 0, workspace_terms = 0;

  // Terms of the assembled matrix that front f takes: entries entry_start[f] .. entry_start[f + 1] - 1.
  std::vector<int> entry_start, entry_source;
  std::vector<std::int64_t> entry_target;  // term within the arms of its front
};

FrontTree make_front_tree(const EquationGraph& graph, const AssembledMatrix& matrix, int leaf_equations);

}  // namespace sage
