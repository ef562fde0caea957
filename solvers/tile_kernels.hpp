// Kernels on 8 x 8 tiles.  They are inline because a call would cost as much as the work.
#pragma once

#include <cstdint>

#include "solvers/tile_profile.hpp"

namespace sage {

// One register of doubles, and the block of a tile whose terms stay in registers while sums over k run.
// AVX-512: 8 rows of 3 tiles take 24 of its 32 registers.  AVX2 and SSE2: 4 rows of 2 registers take 8 of 16.
#if defined(__AVX512F__)
inline constexpr int kLanes = 8, kBlockRows = 8, kBlockParts = 1, kWidth = 3;
#elif defined(__AVX2__)
inline constexpr int kLanes = 4, kBlockRows = 4, kBlockParts = 2, kWidth = 1;
#else
inline constexpr int kLanes = 2, kBlockRows = 4, kBlockParts = 2, kWidth = 1;
#endif
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

inline const Lanes& lanes(const double* p) {
  return *reinterpret_cast<const Lanes*>(p);
}
inline Lanes& lanes(double* p) {
  return *reinterpret_cast<Lanes*>(p);
}

// C[i][:] -= sum over k of A[k][i] B[k][:] for `rows` rows i from `row` and lanes from `lane`: what fits the
// registers.  k runs over `count` rows of A and B.
template <int width, int rows>
inline void tile_subtract_block(double* C, std::ptrdiff_t c_stride, const double* A, const double* B,
                                std::ptrdiff_t b_stride, int count, int row, int lane) {
  constexpr int columns = width * kBlockParts;
  const auto column = [&](std::ptrdiff_t stride, int v) {
    return (v / kBlockParts) * stride + lane + (v % kBlockParts) * kLanes;
  };
  Lanes c[columns][rows];
#pragma GCC unroll 4
  for (int v = 0; v < columns; ++v)
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) c[v][i] = lanes(C + column(c_stride, v) + (row + i) * kTile);
  for (int k = 0; k < count; ++k) {
    Lanes b[columns];
#pragma GCC unroll 4
    for (int v = 0; v < columns; ++v) b[v] = lanes(B + column(b_stride, v) + k * kTile);
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i)
#pragma GCC unroll 4
      for (int v = 0; v < columns; ++v) c[v][i] -= A[k * kTile + row + i] * b[v];
  }
#pragma GCC unroll 4
  for (int v = 0; v < columns; ++v)
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) lanes(C + column(c_stride, v) + (row + i) * kTile) = c[v][i];
}

// C[i][:] -= sum over k of A[k][i] B[k][:], k over `count` rows of A and B, i over the first `live` rows, for
// `width` tiles C side by side with their own B; strides are from one such tile to the next.
template <int width>
inline void tile_subtract_products(double* C, std::ptrdiff_t c_stride, const double* A, const double* B,
                                   std::ptrdiff_t b_stride, int count, int live = kTile) {
  if (count == 0) return;
  for (int lane = 0; lane < kTile; lane += kBlockParts * kLanes) {
    int row = 0;
    for (; row + kBlockRows <= live; row += kBlockRows)
      tile_subtract_block<width, kBlockRows>(C, c_stride, A, B, b_stride, count, row, lane);
    for (; row + 2 <= live; row += 2)
      tile_subtract_block<width, 2>(C, c_stride, A, B, b_stride, count, row, lane);
    if (row < live) tile_subtract_block<width, 1>(C, c_stride, A, B, b_stride, count, row, lane);
  }
}

// The same for one tile and k over whole tiles.
inline void tile_subtract_product(double* C, const double* A, const double* B, int tiles) {
  tile_subtract_products<1>(C, 0, A, B, 0, tiles * kTile);
}

inline void tile_raise_maximum(Lanes& maximum, const Lanes& x) {
  using Bits = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  const Lanes positive = reinterpret_cast<Lanes>(reinterpret_cast<Bits>(x) & (Bits{} + kAllButSign));
  maximum = positive > maximum ? positive : maximum;
}

// C = T^-1 C for the first `live` rows, with T lower triangular as in TileTriangle.  maximum takes the largest
// |term| before it is divided by the diagonal: a term of the reduced matrix.
template <bool unit, int live = kTile>
inline void tile_solve(double* C, const double* T, const double* reciprocal, Lanes& maximum) {
#pragma GCC unroll 4
  for (int lane = 0; lane < kTile; lane += kLanes) {
    Lanes c[live];
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) c[i] = lanes(C + i * kTile + lane);
#pragma GCC unroll 8
    for (int k = 0; k < live; ++k) {
      tile_raise_maximum(maximum, c[k]);
      if constexpr (!unit) c[k] *= reciprocal[k];
#pragma GCC unroll 8
      for (int i = k + 1; i < live; ++i) c[i] -= T[k * kTile + i] * c[k];
    }
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) lanes(C + i * kTile + lane) = c[i];
  }
}

// The same with a number of rows that is known only at run time.
template <bool unit>
inline void tile_solve_rows(int live, double* C, const double* T, const double* reciprocal, Lanes& maximum) {
  switch (live) {
    case 1:
      return tile_solve<unit, 1>(C, T, reciprocal, maximum);
    case 2:
      return tile_solve<unit, 2>(C, T, reciprocal, maximum);
    case 3:
      return tile_solve<unit, 3>(C, T, reciprocal, maximum);
    case 4:
      return tile_solve<unit, 4>(C, T, reciprocal, maximum);
    case 5:
      return tile_solve<unit, 5>(C, T, reciprocal, maximum);
    case 6:
      return tile_solve<unit, 6>(C, T, reciprocal, maximum);
    case 7:
      return tile_solve<unit, 7>(C, T, reciprocal, maximum);
    default:
      return tile_solve<unit, 8>(C, T, reciprocal, maximum);
  }
}

// target[k][:] = factor[k] source[k][:] for the first `live` rows.
inline void tile_scale_rows(double* target, const double* source, const double* factor, int live = kTile) {
  for (int k = 0; k < live; ++k)
    for (int lane = 0; lane < kTile; lane += kLanes)
      lanes(target + k * kTile + lane) = factor[k] * lanes(source + k * kTile + lane);
}

// Elimination within the first `live` rows of a diagonal tile A = L U without pivoting.  On return A holds U
// and `unit` the unit-diagonal L, transposed; check(k, pivot) sees every pivot before it is used.
template <class Check>
inline void tile_factorise(double* A, double* unit, double* reciprocal, Lanes& maximum, Check&& check,
                           int live = kTile) {
  for (int k = 0; k < live; ++k) {
    const double* row = A + k * kTile;
    check(k, row[k]);
    for (int lane = 0; lane < kTile; lane += kLanes) tile_raise_maximum(maximum, lanes(row + lane));
    reciprocal[k] = 1.0 / row[k];
    for (int i = k + 1; i < live; ++i) {
      const double factor = A[i * kTile + k] * reciprocal[k];
      unit[k * kTile + i] = factor;
      for (int j = k; j < kTile; ++j) A[i * kTile + j] -= factor * row[j];
    }
    for (int i = live; i < kTile; ++i) unit[k * kTile + i] = 0.0;
  }
}

// Elimination within the upper triangle of a symmetric diagonal tile A = L D L^T, whose lower triangle is never
// read.  On return L, transposed, stands above A's diagonal; check(k, pivot) sees every pivot before it is used.
template <class Check>
inline void tile_factorise_symmetric(double* A, double* reciprocal, Lanes& maximum, Check&& check) {
  for (int k = 0; k < kTile; ++k) {
    double* row = A + k * kTile;
    check(k, row[k]);
    tile_raise_maximum(maximum, Lanes{} + row[k]);
    reciprocal[k] = 1.0 / row[k];
    for (int i = k + 1; i < kTile; ++i) {
      const double factor = row[i] * reciprocal[k];
      for (int j = i; j < kTile; ++j) A[i * kTile + j] -= factor * row[j];
    }
    for (int i = k + 1; i < kTile; ++i) row[i] *= reciprocal[k];
  }
}

// Copies the upper triangle of a diagonal tile to the lower, in the first `live` rows.
inline void tile_mirror(double* A, int live) {
  for (int i = 1; i < live; ++i)
    for (int j = 0; j < i; ++j) A[i * kTile + j] = A[j * kTile + i];
}

inline double largest(const Lanes& x) {
  double maximum = 0.0;
  for (int i = 0; i < kLanes; ++i) maximum = x[i] > maximum ? x[i] : maximum;
  return maximum;
}

// z -= sum over k of terms [k][:] y[k], k over `count` consecutive rows.
inline void tile_forward_rows(const double* tile, const double* y, int count, double* z) {
  for (int lane = 0; lane < kTile; lane += kLanes) {
    Lanes sum[4] = {lanes(z + lane), Lanes{}, Lanes{}, Lanes{}};
    int k = 0;
    for (; k + 4 <= count; k += 4)
#pragma GCC unroll 4
      for (int m = 0; m < 4; ++m) sum[m] -= y[k + m] * lanes(tile + (k + m) * kTile + lane);
    for (; k < count; ++k) sum[0] -= y[k] * lanes(tile + k * kTile + lane);
    lanes(z + lane) = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

// The same over whole tiles.
inline void tile_forward_panel(const double* tile, const double* y, int tiles, double* z) {
  tile_forward_rows(tile, y, tiles * kTile, z);
}

// z = T^-1 z with the first `live` rows of the lower triangular diagonal tile T; reciprocal = nullptr for a
// unit diagonal.
inline void tile_forward_diagonal(const double* T, const double* reciprocal, double* z, int live = kTile) {
  for (int k = 0; k < live; ++k) {
    if (reciprocal) z[k] *= reciprocal[k];
    for (int i = k + 1; i < live; ++i) z[i] -= T[k * kTile + i] * z[k];
  }
}

// row[i] += lane by lane T[i][:] y for the first `live` rows: the sum of its lanes is (T y)[i].
inline void tile_multiply_rows(const double* T, const double* y, Lanes* row, int live = kTile) {
  for (int lane = 0; lane < kTile; lane += kLanes) {
    const Lanes factor = lanes(y + lane);
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) row[i] += lanes(T + i * kTile + lane) * factor;
  }
}

// The same for `width` panels of many rows, one after the other at `stride`, each with eight values of y: terms are
// read once, in the order in which they stand.
template <int width>
inline void tile_multiply_panels(const double* T, std::ptrdiff_t stride, const double* y, int rows,
                                 Lanes* row) {
  Lanes factor[width][kTile / kLanes];
#pragma GCC unroll 4
  for (int w = 0; w < width; ++w)
#pragma GCC unroll 4
    for (int part = 0; part < kTile / kLanes; ++part) factor[w][part] = lanes(y + w * kTile + part * kLanes);
  for (int i = 0; i < rows; ++i) {
    Lanes sum = row[i];
#pragma GCC unroll 4
    for (int w = 0; w < width; ++w)
#pragma GCC unroll 4
      for (int part = 0; part < kTile / kLanes; ++part)
        sum += lanes(T + w * stride + i * kTile + part * kLanes) * factor[w][part];
    row[i] = sum;
  }
}

// z[i] -= sum of the lanes of row[i].
inline void tile_subtract_sums(const Lanes* row, double* z) {
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) {
    Lanes sum = row[i];
#pragma GCC unroll 4
    for (int half = kLanes / 2; half > 0; half /= 2)
#pragma GCC unroll 4
      for (int l = 0; l < half; ++l) sum[l] += sum[l + half];
    z[i] -= sum[0];
  }
}

// z = T^-T z, for the first `live` rows.
inline void tile_backward_diagonal(const double* T, const double* reciprocal, double* z, int live = kTile) {
  for (int k = live - 1; k >= 0; --k) {
    for (int i = k + 1; i < live; ++i) z[k] -= T[k * kTile + i] * z[i];
    if (reciprocal) z[k] *= reciprocal[k];
  }
}

}  // namespace sage
