// One dense front of the multifrontal solver, and where its terms stand.
//
// Its local index runs over pivots and border, each padded to whole tiles of 8.  Arms hold the pivot rows (U) and,
// transposed, the pivot columns (L) in panels of 8 columns: term k * 8 + v of panel J couples pivot k to column v of
// J.  A panel has a row for each pivot up to its own last one, and none for padding.  The border matrix, which goes
// to the parent, is stored in panels of 8 columns too, tile (I, J) at border_panel(J) + I * 64.
//
// Kernels that are compiled for other processors than the rest see this file: its functions are inlined always,
// so that nobody else gets theirs (docs/decisions/0018).
#pragma once

#include <cstddef>
#include <cstdint>

namespace sage {

inline constexpr int kTile = 8;
inline constexpr int kTileTerms = kTile * kTile;

struct Front {
  int parent = -1;
  int first = 0;  // position of the first pivot in the elimination
  int pivots = 0;
  int border_begin = 0;  // into FrontTree::border
  int border = 0;
  int pivot_tiles = 0, border_tiles = 0;
  bool symmetric = false;      // of the border matrix only the upper triangle is there
  int width = 1;               // panels of the border that the kernels take side by side
  std::int64_t arms = 0;       // first term of its arms in the factors: U, then L; twins share them
  std::int64_t border_at = 0;  // first term of its border matrix: in the workspace of its subtree, or
  bool shared = false;         // in the one that all share

  // First term of panel J in an arm.
  [[gnu::always_inline]] std::int64_t panel(int J) const {
    return J < pivot_tiles ? std::int64_t{32} * J * (J + 1)
                           : pivot_terms() + std::int64_t{8} * pivots * (J - pivot_tiles);
  }
  [[gnu::always_inline]] std::int64_t pivot_terms()
      const {  // the panels of pivots: the last one has no padding
    return std::int64_t{32} * pivot_tiles * (pivot_tiles - 1) + std::int64_t{8} * pivots;
  }
  [[gnu::always_inline]] std::int64_t arm_terms() const { return panel(pivot_tiles + border_tiles); }
  [[gnu::always_inline]] int live(int K) const {  // rows of tile row K
    const int left = pivots - K * kTile;
    return left < kTile ? left : kTile;
  }
  [[gnu::always_inline]] std::ptrdiff_t stride() const {  // between panels of the border
    return std::ptrdiff_t{kTile} * pivots;
  }
  // Tiles of panel J of the border matrix.  Panels that are worked on side by side have the same.
  [[gnu::always_inline]] int border_rows(int J) const {
    const int rows = (J / width + 1) * width;
    return symmetric && rows < border_tiles ? rows : border_tiles;
  }
  // First term of panel J of the border matrix.
  [[gnu::always_inline]] std::int64_t border_panel(int J) const {
    if (!symmetric) return std::int64_t{kTileTerms} * J * border_tiles;
    const std::int64_t before = J / width;  // blocks of such panels
    return kTileTerms * (width * width * before * (before + 1) / 2 + (J % width) * border_rows(J));
  }
  [[gnu::always_inline]] std::int64_t border_terms() const { return border_panel(border_tiles); }
};

// A front while it is in work.  K counts tiles of pivots; J counts tiles of pivots, then of the border.
struct Arms {
  const Front& front;
  double* upper;       // U; for symmetric matrices D L^T
  double* lower;       // L, transposed; for symmetric matrices in a scratch array
  double* reciprocal;  // of the pivots
  [[gnu::always_inline]] double* u(int K, int J) const { return upper + front.panel(J) + K * kTileTerms; }
  [[gnu::always_inline]] double* l(int K, int I) const { return lower + front.panel(I) + K * kTileTerms; }
};

}  // namespace sage
