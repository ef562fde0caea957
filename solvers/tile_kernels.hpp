// Kernels on 8 x 8 tiles.  They are inline because a call would cost as much as the work.
#pragma once

#include "solvers/tile_profile.hpp"

namespace sage {

// Eight doubles that the compiler maps to the registers of the processor (1 x 512, 2 x 256 or 4 x 128 bits).
using Lanes = double __attribute__((vector_size(64), may_alias));
using LaneIndex = long long __attribute__((vector_size(64)));

inline const Lanes& lanes(const double* p) {
  return *reinterpret_cast<const Lanes*>(p);
}
inline Lanes& lanes(double* p) {
  return *reinterpret_cast<Lanes*>(p);
}

// A block of tile rows and tiles side by side whose terms stay in registers while sums over k run: 8 rows of 3
// tiles take 24 of AVX-512's 32 registers; half a tile is what the 16 registers of AVX2 hold.
#ifdef __AVX512F__
inline constexpr int kRowsInRegisters = 8, kWidth = 3;
#else
inline constexpr int kRowsInRegisters = 4, kWidth = 1;
#endif

// C[i][:] -= sum over k of A[k][i] B[k][:], k over `tiles` consecutive tiles of A and B, for `width` tiles C
// side by side with their own B; strides are from one such tile to the next.
template <int width>
inline void tile_subtract_products(double* C, std::ptrdiff_t c_stride, const double* A, const double* B,
                                   std::ptrdiff_t b_stride, int tiles) {
  constexpr int rows = kRowsInRegisters;
  for (int first = 0; first < kTile; first += rows) {
    Lanes c[width][rows];
#pragma GCC unroll 4
    for (int w = 0; w < width; ++w)
#pragma GCC unroll 8
      for (int i = 0; i < rows; ++i) c[w][i] = lanes(C + w * c_stride + (first + i) * kTile);
    for (int k = 0; k < tiles * kTile; ++k) {
      Lanes b[width];
#pragma GCC unroll 4
      for (int w = 0; w < width; ++w) b[w] = lanes(B + w * b_stride + k * kTile);
#pragma GCC unroll 8
      for (int i = 0; i < rows; ++i)
#pragma GCC unroll 4
        for (int w = 0; w < width; ++w) c[w][i] -= A[k * kTile + first + i] * b[w];
    }
#pragma GCC unroll 4
    for (int w = 0; w < width; ++w)
#pragma GCC unroll 8
      for (int i = 0; i < rows; ++i) lanes(C + w * c_stride + (first + i) * kTile) = c[w][i];
  }
}

inline void tile_subtract_product(double* C, const double* A, const double* B, int tiles) {
  tile_subtract_products<1>(C, 0, A, B, 0, tiles);
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

// Elimination within a diagonal tile A = L U without pivoting.  On return A holds U and `unit` the
// unit-diagonal L, transposed; check(k, pivot) sees every pivot before it is used.
template <class Check>
inline void tile_factorise(double* A, double* unit, double* reciprocal, Lanes& maximum, Check&& check) {
  for (int k = 0; k < kTile; ++k) {
    const double* row = A + k * kTile;
    check(k, row[k]);
    tile_raise_maximum(maximum, lanes(row));
    reciprocal[k] = 1.0 / row[k];
    for (int i = k + 1; i < kTile; ++i) {
      const double factor = A[i * kTile + k] * reciprocal[k];
      unit[k * kTile + i] = factor;
      for (int j = k; j < kTile; ++j) A[i * kTile + j] -= factor * row[j];
    }
  }
}

// Copies the upper triangle of a diagonal tile to the lower.
inline void tile_mirror(double* A) {
  for (int i = 1; i < kTile; ++i)
    for (int j = 0; j < i; ++j) A[i * kTile + j] = A[j * kTile + i];
}

inline double largest(const Lanes& x) {
  double maximum = 0.0;
  for (int i = 0; i < kTile; ++i) maximum = x[i] > maximum ? x[i] : maximum;
  return maximum;
}

// z -= sum over k of tile terms [k][:] y[k], k over `tiles` consecutive tiles.
inline void tile_forward_panel(const double* tile, const double* y, int tiles, double* z) {
  Lanes sum[4] = {lanes(z), Lanes{}, Lanes{}, Lanes{}};
  for (int k = 0; k < tiles * kTile; k += 4)
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) sum[m] -= y[k + m] * lanes(tile + (k + m) * kTile);
  lanes(z) = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// z = T^-1 z with the lower triangular diagonal tile T; reciprocal = nullptr for a unit diagonal.
inline void tile_forward_diagonal(const double* T, const double* reciprocal, double* z) {
  for (int k = 0; k < kTile; ++k) {
    if (reciprocal) z[k] *= reciprocal[k];
    for (int i = k + 1; i < kTile; ++i) z[i] -= T[k * kTile + i] * z[k];
  }
}

// row[i] += lane by lane T[i][:] y: the sum of its lanes is (T y)[i].
inline void tile_multiply_rows(const double* T, const double* y, Lanes* row) {
  const Lanes factor = lanes(y);
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) row[i] += lanes(T + i * kTile) * factor;
}

// z[i] -= sum of the lanes of row[i].
inline void tile_subtract_sums(const Lanes* row, double* z) {
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) {
    const Lanes& r = row[i];
    z[i] -= ((r[0] + r[4]) + (r[2] + r[6])) + ((r[1] + r[5]) + (r[3] + r[7]));
  }
}

// z = T^-T z.
inline void tile_backward_diagonal(const double* T, const double* reciprocal, double* z) {
  for (int k = kTile - 1; k >= 0; --k) {
    for (int i = k + 1; i < kTile; ++i) z[k] -= T[k * kTile + i] * z[i];
    if (reciprocal) z[k] *= reciprocal[k];
  }
}

}  // namespace sage
