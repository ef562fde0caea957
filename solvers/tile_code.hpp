// The code of TileKernels, for a set of registers R:
//   kLanes, Lanes            one register of doubles
//   kBlockRows, kBlockParts  rows, and registers of a row of a tile, whose terms stay in registers while sums over k run
//   kWidth                   tiles side by side that share what is loaded
//   kSums, Sums              the register of the sums whose lanes are added up in the end
// Each source that includes this has an R of its own in an unnamed namespace, so that all functions here are its own
// too and the linker cannot give one processor's to another.  For the same reason nothing of a library is used.
//
// Sums run over k in the same order with every R, term by term, and a product is added with one rounding wherever
// the processor can: all processors with fused multiplication and addition find the same bits.
#pragma once

#include "solvers/tile_kernels.hpp"

namespace sage {

template <class R>
inline const typename R::Lanes& lanes(const double* p) {
  return *reinterpret_cast<const typename R::Lanes*>(p);
}
template <class R>
inline typename R::Lanes& lanes(double* p) {
  return *reinterpret_cast<typename R::Lanes*>(p);
}

// C[i][:] -= sum over k of A[k][i] B[k][:] for `rows` rows i and some lanes, from where the pointers stand: what fits
// the registers.  k runs over `count` rows of A and B; `width` tiles C side by side have their own B.
template <class R, int width, int rows>
inline void tile_subtract_block(double* C, std::ptrdiff_t c_stride, const double* A, const double* B,
                                std::ptrdiff_t b_stride, int count) {
  using Lanes = typename R::Lanes;
  constexpr int parts = R::kBlockParts, columns = width * parts;
  Lanes c[columns][rows];
#pragma GCC unroll 4
  for (int v = 0; v < columns; ++v) {
    const double* from = C + v / parts * c_stride + v % parts * R::kLanes;
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) c[v][i] = lanes<R>(from + i * kTile);
  }
  for (const double* const end = A + std::ptrdiff_t{count} * kTile; A != end; A += kTile, B += kTile) {
    Lanes b[columns];
#pragma GCC unroll 4
    for (int v = 0; v < columns; ++v) b[v] = lanes<R>(B + v / parts * b_stride + v % parts * R::kLanes);
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i)
#pragma GCC unroll 4
      for (int v = 0; v < columns; ++v) c[v][i] -= A[i] * b[v];
  }
#pragma GCC unroll 4
  for (int v = 0; v < columns; ++v) {
    double* to = C + v / parts * c_stride + v % parts * R::kLanes;
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) lanes<R>(to + i * kTile) = c[v][i];
  }
}

// C[i][:] -= sum over k of A[k][i] B[k][:], k over `count` rows of A and B, i over the first `live` rows, for
// `width` tiles C side by side with their own B; strides are from one such tile to the next.
template <class R, int width>
inline void tile_subtract_products(double* C, std::ptrdiff_t c_stride, const double* A, const double* B,
                                   std::ptrdiff_t b_stride, int count, int live = kTile) {
  if (count == 0) return;
  for (int lane = 0; lane < kTile; lane += R::kBlockParts * R::kLanes) {
    double* c = C + lane;
    const double* const b = B + lane;
    int row = 0;
    for (; row + R::kBlockRows <= live; row += R::kBlockRows, c += R::kBlockRows * kTile)
      tile_subtract_block<R, width, R::kBlockRows>(c, c_stride, A + row, b, b_stride, count);
    for (; row + 2 <= live; row += 2, c += 2 * kTile)
      tile_subtract_block<R, width, 2>(c, c_stride, A + row, b, b_stride, count);
    if (row < live) tile_subtract_block<R, width, 1>(c, c_stride, A + row, b, b_stride, count);
  }
}

// The same for one tile and k over whole tiles.
template <class R>
inline void tile_subtract_product(double* C, const double* A, const double* B, int tiles) {
  tile_subtract_products<R, 1>(C, 0, A, B, 0, tiles * kTile);
}

template <class R>
inline void tile_raise_maximum(typename R::Lanes& maximum, const typename R::Lanes& x) {
  using Lanes = typename R::Lanes;
  using Bits = typename R::Bits;
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  const Lanes positive = reinterpret_cast<Lanes>(reinterpret_cast<Bits>(x) & (Bits{} + kAllButSign));
  maximum = positive > maximum ? positive : maximum;
}

// C = T^-1 C for the first `live` rows, with T lower triangular as in TileTriangle.  maximum takes the largest
// |term| before it is divided by the diagonal: a term of the reduced matrix.
template <class R, bool unit, int live = kTile>
inline void tile_solve(double* C, const double* T, const double* reciprocal, typename R::Lanes& maximum) {
#pragma GCC unroll 4
  for (int lane = 0; lane < kTile; lane += R::kLanes) {
    typename R::Lanes c[live];
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) c[i] = lanes<R>(C + i * kTile + lane);
#pragma GCC unroll 8
    for (int k = 0; k < live; ++k) {
      tile_raise_maximum<R>(maximum, c[k]);
      if constexpr (!unit) c[k] *= reciprocal[k];
#pragma GCC unroll 8
      for (int i = k + 1; i < live; ++i) c[i] -= T[k * kTile + i] * c[k];
    }
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) lanes<R>(C + i * kTile + lane) = c[i];
  }
}

// The same with a number of rows that is known only at run time.
template <class R, bool unit>
inline void tile_solve_rows(int live, double* C, const double* T, const double* reciprocal,
                            typename R::Lanes& maximum) {
  switch (live) {
    case 1:
      return tile_solve<R, unit, 1>(C, T, reciprocal, maximum);
    case 2:
      return tile_solve<R, unit, 2>(C, T, reciprocal, maximum);
    case 3:
      return tile_solve<R, unit, 3>(C, T, reciprocal, maximum);
    case 4:
      return tile_solve<R, unit, 4>(C, T, reciprocal, maximum);
    case 5:
      return tile_solve<R, unit, 5>(C, T, reciprocal, maximum);
    case 6:
      return tile_solve<R, unit, 6>(C, T, reciprocal, maximum);
    case 7:
      return tile_solve<R, unit, 7>(C, T, reciprocal, maximum);
    default:
      return tile_solve<R, unit, 8>(C, T, reciprocal, maximum);
  }
}

// target[k][:] = factor[k] source[k][:] for the first `live` rows.
template <class R>
inline void tile_scale_rows(double* target, const double* source, const double* factor, int live = kTile) {
  for (int k = 0; k < live; ++k)
    for (int lane = 0; lane < kTile; lane += R::kLanes)
      lanes<R>(target + k * kTile + lane) = factor[k] * lanes<R>(source + k * kTile + lane);
}

// Elimination within the first `live` rows of a diagonal tile A = L U without pivoting.  On return A holds U
// and `unit` the unit-diagonal L, transposed.
template <class R>
inline void tile_factorise(double* A, double* unit, double* reciprocal, typename R::Lanes& maximum,
                           int live = kTile) {
  for (int k = 0; k < live; ++k) {
    const double* row = A + k * kTile;
    for (int lane = 0; lane < kTile; lane += R::kLanes) tile_raise_maximum<R>(maximum, lanes<R>(row + lane));
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
// read.  On return L, transposed, stands above A's diagonal, and D on it.
template <class R>
inline void tile_factorise_symmetric(double* A, double* reciprocal, typename R::Lanes& maximum) {
  using Lanes = typename R::Lanes;
  for (int k = 0; k < kTile; ++k) {
    double* row = A + k * kTile;
    tile_raise_maximum<R>(maximum, Lanes{} + row[k]);
    reciprocal[k] = 1.0 / row[k];
    for (int i = k + 1; i < kTile; ++i) {
      const double factor = row[i] * reciprocal[k];
      for (int j = i; j < kTile; ++j) A[i * kTile + j] -= factor * row[j];
    }
    for (int i = k + 1; i < kTile; ++i) row[i] *= reciprocal[k];
  }
}

// Copies the upper triangle of a diagonal tile to the lower, in the first `live` rows.
template <class R>
inline void tile_mirror(double* A, int live) {
  for (int i = 1; i < live; ++i)
    for (int j = 0; j < i; ++j) A[i * kTile + j] = A[j * kTile + i];
}

// z -= sum over k of terms [k][:] y[k], k over `count` consecutive rows.
template <class R>
inline void tile_forward_rows(const double* tile, const double* y, int count, double* z) {
  using Lanes = typename R::Lanes;
  for (int lane = 0; lane < kTile; lane += R::kLanes) {
    Lanes sum[4] = {lanes<R>(z + lane), Lanes{}, Lanes{}, Lanes{}};
    int k = 0;
    for (; k + 4 <= count; k += 4)
#pragma GCC unroll 4
      for (int m = 0; m < 4; ++m) sum[m] -= y[k + m] * lanes<R>(tile + (k + m) * kTile + lane);
    for (; k < count; ++k) sum[0] -= y[k] * lanes<R>(tile + k * kTile + lane);
    lanes<R>(z + lane) = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

// z = T^-1 z with the first `live` rows of the lower triangular diagonal tile T; reciprocal = nullptr for a
// unit diagonal.
template <class R>
inline void tile_forward_diagonal(const double* T, const double* reciprocal, double* z, int live = kTile) {
  for (int k = 0; k < live; ++k) {
    if (reciprocal) z[k] *= reciprocal[k];
    for (int i = k + 1; i < live; ++i) z[i] -= T[k * kTile + i] * z[k];
  }
}

template <class R>
inline const typename R::Sums& sum_lanes(const double* p) {
  return *reinterpret_cast<const typename R::Sums*>(p);
}

// row[i] += lane by lane T[i][:] y for the first `live` rows: the sum of its lanes is (T y)[i].
template <class R>
inline void tile_multiply_rows(const double* T, const double* y, typename R::Sums* row, int live = kTile) {
  for (int lane = 0; lane < kTile; lane += R::kSums) {
    const typename R::Sums factor = sum_lanes<R>(y + lane);
#pragma GCC unroll 8
    for (int i = 0; i < live; ++i) row[i] += sum_lanes<R>(T + i * kTile + lane) * factor;
  }
}

// The same for `width` panels of many rows, one after the other at `stride`, each with eight values of y: terms are
// read once, in the order in which they stand.
template <class R, int width>
inline void tile_multiply_panels(const double* T, std::ptrdiff_t stride, const double* y, int rows,
                                 typename R::Sums* row) {
  using Sums = typename R::Sums;
  constexpr int parts = kTile / R::kSums;
  Sums factor[width][parts];
#pragma GCC unroll 4
  for (int w = 0; w < width; ++w)
#pragma GCC unroll 4
    for (int part = 0; part < parts; ++part) factor[w][part] = sum_lanes<R>(y + w * kTile + part * R::kSums);
  for (int i = 0; i < rows; ++i) {
    Sums sum = row[i];
#pragma GCC unroll 4
    for (int w = 0; w < width; ++w)
#pragma GCC unroll 4
      for (int part = 0; part < parts; ++part)
        sum += sum_lanes<R>(T + w * stride + i * kTile + part * R::kSums) * factor[w][part];
    row[i] = sum;
  }
}

// z[i] -= sum of the lanes of row[i].
template <class R>
inline void tile_subtract_sums(const typename R::Sums* row, double* z) {
#pragma GCC unroll 8
  for (int i = 0; i < kTile; ++i) {
    typename R::Sums sum = row[i];
#pragma GCC unroll 4
    for (int half = R::kSums / 2; half > 0; half /= 2)
#pragma GCC unroll 4
      for (int l = 0; l < half; ++l) sum[l] += sum[l + half];
    z[i] -= sum[0];
  }
}

// z = T^-T z, for the first `live` rows.
template <class R>
inline void tile_backward_diagonal(const double* T, const double* reciprocal, double* z, int live = kTile) {
  for (int k = live - 1; k >= 0; --k) {
    for (int i = k + 1; i < live; ++i) z[k] -= T[k * kTile + i] * z[i];
    if (reciprocal) z[k] *= reciprocal[k];
  }
}

// Profile: one tile of column J above its diagonal.  upper: column J of U.
template <class R, bool symmetric>
inline void reduce_tile(const ProfileFactors& f, int K, int J, double* upper, typename R::Lanes& maximum) {
  const ProfileShape& shape = f.shape;
  const int top = shape.top[J], first = shape.top[K] > top ? shape.top[K] : top;
  const std::int64_t mk = shape.tile(first, K);
  const double* const reciprocal = f.reciprocal + K * kTile;
  double* const U = upper + (K - top) * kTileTerms;
  double* const L = f.lower + shape.tile(K, J);
  tile_subtract_product<R>(U, f.lower + mk, upper + (first - top) * kTileTerms, K - first);
  if constexpr (!symmetric)
    tile_subtract_product<R>(L, f.upper + mk, f.lower + shape.tile(first, J), K - first);
  tile_solve<R, true>(U, f.unit + K * kTileTerms, nullptr, maximum);
  if constexpr (symmetric)
    tile_scale_rows<R>(L, U, reciprocal);
  else
    tile_solve<R, false>(L, f.diagonal + K * kTileTerms, reciprocal, maximum);
}

// All of a column in one function: else pointers into tiles go through memory (4 % of a plastic run of 800
// equations).
template <class R, bool symmetric>
[[gnu::flatten]] void reduce_profile_column_of(const ProfileFactors& f, int J, double* largest) {
  typename R::Lanes maximum = lanes<R>(largest);
  double* const upper = symmetric ? f.column : f.upper + f.shape.offset[J];
  for (int K = f.shape.top[J]; K < J; ++K) reduce_tile<R, symmetric>(f, K, J, upper, maximum);
  double* const A = f.diagonal + J * kTileTerms;
  double* const reciprocal = f.reciprocal + J * kTile;
  tile_subtract_product<R>(A, f.lower + f.shape.offset[J], upper, f.shape.height(J));
  if constexpr (symmetric)
    tile_factorise_symmetric<R>(A, reciprocal, maximum);
  else
    tile_factorise<R>(A, f.unit + J * kTileTerms, reciprocal, maximum);
  lanes<R>(largest) = maximum;
}

template <class R>
void reduce_profile_column(const ProfileFactors& f, int J, double* largest) {
  return f.symmetric ? reduce_profile_column_of<R, true>(f, J, largest)
                     : reduce_profile_column_of<R, false>(f, J, largest);
}

template <class R>
void profile_forward(const ProfileShape& shape, const TileTriangle& T, double* x) {
  for (int J = 0; J < shape.tiles; ++J) {
    double* z = x + J * kTile;
    tile_forward_rows<R>(T.tiles + shape.offset[J], x + shape.top[J] * kTile, shape.height(J) * kTile, z);
    tile_forward_diagonal<R>(T.diagonal + J * kTileTerms, T.reciprocal ? T.reciprocal + J * kTile : nullptr, z);
  }
}

template <class R>
void profile_backward(const ProfileShape& shape, const TileTriangle& T, double* x) {
  for (int K = shape.tiles - 1; K >= 0; --K) {
    typename R::Sums row[kTile] = {};
    for (int r = shape.right_start[K]; r < shape.right_start[K + 1]; ++r) {
      const int J = shape.right[r];
      tile_multiply_rows<R>(T.tiles + shape.tile(K, J), x + J * kTile, row);
    }
    double* z = x + K * kTile;
    tile_subtract_sums<R>(row, z);
    tile_backward_diagonal<R>(T.diagonal + K * kTileTerms, T.reciprocal ? T.reciprocal + K * kTile : nullptr,
                              z);
  }
}

// Tile rows 0 .. rows - 1 of U in `width` tile columns beginning at J, and the same of L.
template <class R, int width>
inline void reduce_columns(const Arms& a, int rows, int J, typename R::Lanes& maximum) {
  const bool symmetric = a.front.symmetric;
  const std::ptrdiff_t stride = a.front.stride();
  for (int K = 0; K < rows; ++K) {
    const int live = a.front.live(K);
    tile_subtract_products<R, width>(a.u(K, J), stride, a.l(0, K), a.u(0, J), stride, K * kTile, live);
    if (!symmetric)
      tile_subtract_products<R, width>(a.l(K, J), stride, a.u(0, K), a.l(0, J), stride, K * kTile, live);
    const double* reciprocal = a.reciprocal + K * kTile;
    for (int w = J; w < J + width; ++w) {
      tile_solve_rows<R, true>(live, a.u(K, w), a.l(K, K), nullptr, maximum);
      if (!symmetric)
        tile_solve_rows<R, false>(live, a.l(K, w), a.u(K, K), reciprocal, maximum);
      else
        tile_scale_rows<R>(a.l(K, w), a.u(K, w), reciprocal, live);
    }
  }
}

template <class R>
void reduce_pivot_column(const Arms& a, int J, double* largest) {
  typename R::Lanes maximum = lanes<R>(largest);
  reduce_columns<R, 1>(a, J, J, maximum);
  double* A = a.u(J, J);
  const int live = a.front.live(J);
  if (a.front.symmetric) tile_mirror<R>(A, live);
  tile_subtract_products<R, 1>(A, 0, a.l(0, J), a.u(0, J), 0, J * kTile, live);
  tile_factorise<R>(A, a.l(J, J), a.reciprocal + J * kTile, maximum, live);
  lanes<R>(largest) = maximum;
}

template <class R>
void reduce_border_columns(const Arms& a, int begin, int end, double* largest) {
  typename R::Lanes maximum = lanes<R>(largest);
  const int P = a.front.pivot_tiles;
  int J = begin;
  for (; J + R::kWidth <= end; J += R::kWidth) reduce_columns<R, R::kWidth>(a, P, P + J, maximum);
  for (; J < end; ++J) reduce_columns<R, 1>(a, P, P + J, maximum);
  lanes<R>(largest) = maximum;
}

// Border columns J .. J + width - 1 take the product of `count` pivots from tile K on.
template <class R, int width>
inline void update_columns(const Arms& a, double* border_matrix, int K, int count, int J) {
  const int P = a.front.pivot_tiles;
  const int rows = a.front.symmetric ? J + width : a.front.border_tiles;
  const std::ptrdiff_t stride = std::ptrdiff_t{a.front.border_rows(J)} * kTileTerms;
  double* const panel = border_matrix + a.front.border_panel(J);
  for (int I = 0; I < rows; ++I)
    tile_subtract_products<R, width>(panel + I * kTileTerms, stride, a.l(K, P + I), a.u(K, P + J),
                                     a.front.stride(), count);
}

template <class R>
void update_border(const Arms& a, double* border_matrix, int K, int count, int begin, int end) {
  int J = begin;
  for (; J + R::kWidth <= end; J += R::kWidth) update_columns<R, R::kWidth>(a, border_matrix, K, count, J);
  for (; J < end; ++J) update_columns<R, 1>(a, border_matrix, K, count, J);
}

template <class R>
void forward_front(const Front& front, const double* arm, const double* reciprocal, double* y) {
  const int P = front.pivot_tiles;
  for (int J = 0; J < P + front.border_tiles; ++J) {
    const double* panel = arm + front.panel(J);
    const int above = J < P ? J * kTile : front.pivots;
    tile_forward_rows<R>(panel, y, above, y + J * kTile);
    if (J < P)
      tile_forward_diagonal<R>(panel + J * kTileTerms, reciprocal ? reciprocal + J * kTile : nullptr,
                               y + J * kTile, front.live(J));
  }
}

// Column by column, so that the arm is read as it lies in memory.
template <class R>
void backward_front(const Front& front, const double* arm, const double* reciprocal, double* y,
                    double* sums_of_rows) {
  using Sums = typename R::Sums;
  const int P = front.pivot_tiles, all = P + front.border_tiles;
  Sums* const sums = reinterpret_cast<Sums*>(sums_of_rows);
  for (int i = 0; i < P * kTile; ++i) sums[i] = Sums{};
  constexpr int kTogether = 4;
  int J = P;
  for (; J + kTogether <= all; J += kTogether)
    tile_multiply_panels<R, kTogether>(arm + front.panel(J), front.stride(), y + J * kTile, front.pivots, sums);
  for (; J < all; ++J) tile_multiply_panels<R, 1>(arm + front.panel(J), 0, y + J * kTile, front.pivots, sums);
  for (J = P - 1; J >= 0; --J) {
    const double* const panel = arm + front.panel(J);
    tile_subtract_sums<R>(sums + J * kTile, y + J * kTile);
    tile_backward_diagonal<R>(panel + J * kTileTerms, reciprocal ? reciprocal + J * kTile : nullptr,
                              y + J * kTile, front.live(J));
    tile_multiply_panels<R, 1>(panel, 0, y + J * kTile, J * kTile, sums);
  }
}

template <class R>
constexpr TileKernels kernels_of(const char* name) {
  return {name,
          R::kWidth,
          reduce_profile_column<R>,
          profile_forward<R>,
          profile_backward<R>,
          reduce_pivot_column<R>,
          reduce_border_columns<R>,
          update_border<R>,
          forward_front<R>,
          backward_front<R>};
}

}  // namespace sage
