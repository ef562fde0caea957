// Loops over 8 x 8 tiles, compiled for several processors, of which a run takes those that suit its machine
// (docs/decisions/0018).  A call is for a whole column of tiles or more, so that it costs nothing beside its work.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solvers/front.hpp"

namespace sage {

// What kernels see of a TileProfile.
struct ProfileShape {
  int tiles = 0;  // tile columns
  const int* top = nullptr;
  const std::int64_t* offset = nullptr;
  const int *right_start = nullptr, *right = nullptr;  // tile row K -> columns J > K that hold a tile (K, J)

  [[gnu::always_inline]] int height(int J) const { return J - top[J]; }
  [[gnu::always_inline]] std::int64_t tile(int K, int J) const {
    return offset[J] + std::int64_t{K - top[J]} * kTileTerms;
  }
};

// Where the profile solver keeps its factors (skyline.cpp).
struct ProfileFactors {
  ProfileShape shape;
  bool symmetric = false;
  double* upper = nullptr;     // tiles of U; symmetric: none
  double* lower = nullptr;     // tiles of L, transposed
  double* diagonal = nullptr;  // diagonal tiles of U, or symmetric: of L
  double* unit = nullptr;      // diagonal tiles of L, wherever they are
  double* reciprocal = nullptr;
  double* column = nullptr;  // symmetric: the column of U in work
};

// Diagonal blocks of a triangular factor: term [k * 8 + i], k < i, couples i to k; reciprocal holds
// 1 / diagonal.
struct TileTriangle {
  const double* tiles = nullptr;       // off-diagonal tiles
  const double* diagonal = nullptr;    // diagonal tiles
  const double* reciprocal = nullptr;  // 8 a tile column; nullptr = unit diagonal
};

// `maximum`: 8 doubles that take the largest |term| of the reduced matrix, each of some of the terms.  Elimination does
// not look at pivots: they stand on the diagonal of the diagonal tile when it comes back, and the caller checks them
// before he goes on.
struct TileKernels {
  const char* name;
  int width;  // panels of a border that are worked on side by side: Front::width

  // Profile solver: column J of tiles, diagonal and all above it.
  void (*reduce_profile_column)(const ProfileFactors& factors, int J, double* maximum);
  // x = T^-1 x with T lower triangular, and x = T^-T x; x is in elimination order, padded to whole tiles.
  void (*profile_forward)(const ProfileShape& shape, const TileTriangle& T, double* x);
  void (*profile_backward)(const ProfileShape& shape, const TileTriangle& T, double* x);

  // Multifrontal solver.  Column J of the pivots, diagonal and all above it.
  void (*reduce_pivot_column)(const Arms& arms, int J, double* maximum);
  // Border columns begin .. end - 1 of both arms; begin is a multiple of the width.
  void (*reduce_border_columns)(const Arms& arms, int begin, int end, double* maximum);
  // Border columns begin .. end - 1 of the border matrix take the product of `count` pivots from tile K on.
  void (*update_border)(const Arms& arms, double* border_matrix, int K, int count, int begin, int end);
  // Substitution in a front: y holds its pivots, then its border, each padded to whole tiles.  Forward leaves what
  // the border takes in place of the border (0 before); backward needs the border.  reciprocal: nullptr = unit diagonal.
  // sums: kTile * kMostSums doubles for each tile of pivots.
  void (*forward_front)(const Front& front, const double* arm, const double* reciprocal, double* y);
  void (*backward_front)(const Front& front, const double* arm, const double* reciprocal, double* y,
                         double* sums);
};

inline constexpr int kMostSums = 4;  // of one term, side by side

// For the processor that the whole program is compiled for: AVX2, or SSE2 where the build has no AVX.
extern const TileKernels kBuildKernels;
// For AVX-512.  Only where the build has AVX2, else sums of products would be rounded otherwise: SAGE_HAVE_AVX512.
extern const TileKernels kAvx512Kernels;

}  // namespace sage
