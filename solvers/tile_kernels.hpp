// Kernels on 8 x 8 tiles.  They are inline because a call would cost as much as the work.
#pragma once

#include "solvers/tile_profile.hpp"

namespace sage {

// Eight doubles that the compiler maps to the registers of the processor (1 x 512, 2 x 256 or 4 x 128 bits).
using Lanes = double __attribute__((vector_size(64), may_alias));

inline const Lanes& lanes(const double* p) {
  return *reinterpret_cast<const Lanes*>(p);
}
inline Lanes& lanes(double* p) {
  return *reinterpret_cast<Lanes*>(p);
}

// C[i][:] -= sum over k of A[k][i] B[k][:], k over `tiles` consecutive tiles of A and B.
inline void tile_subtract_product(double* C, const double* A, const double* B, int tiles) {
  Lanes c[kTile];
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) c[i] = lanes(C + i * kTile);
  for (int k = 0; k < tiles * kTile; ++k) {
    const Lanes b = lanes(B + k * kTile);
#pragma GCC unroll 8
    for (int i = 0; i < kTile; ++i) c[i] -= A[k * kTile + i] * b;
  }
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) lanes(C + i * kTile) = c[i];
}

inline void tile_raise_maximum(Lanes& maximum, const Lanes& x) {
  const Lanes positive = x < 0.0 ? -x : x;
  maximum = positive > maximum ? positive : maximum;
}

// C = T^-1 C with T lower triangular as in TileTriangle.  maximum takes the largest |term| before it is divided
// by the diagonal: a term of the reduced matrix.
template <bool unit>
inline void tile_solve(double* C, const double* T, const double* reciprocal, Lanes& maximum) {
  Lanes c[kTile];
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) c[i] = lanes(C + i * kTile);
#pragma GCC unroll 8
  for (int k = 0; k < kTile; ++k) {
    tile_raise_maximum(maximum, c[k]);
    if constexpr (!unit) c[k] *= reciprocal[k];
#pragma GCC unroll 8
    for (int i = k + 1; i < kTile; ++i) c[i] -= T[k * kTile + i] * c[k];
  }
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) lanes(C + i * kTile) = c[i];
}

inline double largest(const Lanes& x) {
  double maximum = 0.0;
  for (int i = 0; i < kTile; ++i) maximum = x[i] > maximum ? x[i] : maximum;
  return maximum;
}

}  // namespace sage
