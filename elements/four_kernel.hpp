// The kernel of point_kernel.hpp for four elements of solids side by side: every product and sum is that of one
// element, in the same order.  Sums of one element wait for each other; those of four fill the registers.
#pragma once

#include <algorithm>
#include <array>

#include "sage/core/four_at_a_time.hpp"

namespace sage {

// Four of large elements would leave the cache.
constexpr bool four_fit(int law_size, int dofs, int points) {
  return law_size == 4 && dofs <= kMostDofsOfFour && points <= static_cast<int>(kMostFours);
}

// B^T of one point for four elements side by side.  pointwise: B as Solid::write_operator makes it without its
// volumetric part, of which three terms a node are kept, N,x N,y N/r; otherwise B^T in full (decision 2).
template <int Dofs, bool pointwise>
struct OperatorOfFour {
  static constexpr int kTerms = pointwise ? Dofs / 2 * 3 : 4 * Dofs;
  static constexpr int kStride = (1 + kTerms) * kAbreast;  // doubles from one point's w to the next one's

  // Whether B has a term of this dof and component of strain that is not zero for certain.
  static constexpr bool couples(int dof, int component) {
    if (!pointwise) return true;
    return dof % 2 == 0 ? component != 1 : component == 1 || component == 3;
  }
  // The place of that term: B = [N,x 0; 0 N,y; N/r 0; N,y N,x].
  static constexpr int place(int dof, int component) {
    if (!pointwise) return component * Dofs + dof;
    constexpr int kOfNode[2][4] = {{0, -1, 2, 1}, {-1, 1, -1, 0}};
    return dof / 2 * 3 + kOfNode[dof % 2][component];
  }
  static Four term(const double* B, int dof, int component) {
    return load_four(B + place(dof, component) * kAbreast);
  }
};

// w and B of one element, from Element::geometry, into its place among four.
template <int Dofs, int Points, bool pointwise>
void place_geometry_among_four(const double* geometry, double* among_four) {
  using B = OperatorOfFour<Dofs, pointwise>;
  for (int p = 0; p < Points; ++p, geometry += 1 + 4 * Dofs, among_four += B::kStride) {
    *among_four = *geometry;
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < Dofs; ++i)
        if (B::couples(i, c)) among_four[(1 + B::place(i, c)) * kAbreast] = geometry[1 + c * Dofs + i];
  }
}

// B du.  The sums of every fourth dof first, as vector registers of one element take them.
template <int Dofs, bool pointwise>
void strains_of_four(const double* B, const double* du, std::array<Four, 4>& strain) {
  using Operator = OperatorOfFour<Dofs, pointwise>;
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
    Four sum[4] = {};
#pragma GCC unroll 18
    for (int i = 0; i < Dofs; ++i) {
      if (!Operator::couples(i, c)) continue;
      const Four term = Operator::term(B, i, c), u = load_four(du + i * kAbreast);
      sum[i % 4] = i < 4 ? term * u : multiply_add(term, u, sum[i % 4]);
    }
    strain[c] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }
}

// Tensors of four elements, at the same offset in each.
inline std::array<Four, 4> gather_four(const std::array<const double*, kAbreast>& from, std::size_t offset) {
  std::array<Four, 4> t{load_four(from[0] + offset), load_four(from[1] + offset), load_four(from[2] + offset),
                        load_four(from[3] + offset)};
  transpose_four(t[0], t[1], t[2], t[3]);
  return t;
}
inline void scatter_four(std::array<Four, 4> t, const std::array<double*, kAbreast>& to, std::size_t offset) {
  transpose_four(t[0], t[1], t[2], t[3]);
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kAbreast; ++l) store_four(to[l] + offset, t[l]);
}

// f = sum B^T w sigma over the points.
template <int Dofs, int Points, bool pointwise>
void forces_of_four(const double* geometry, const std::array<std::array<Four, 4>, Points>& w_sigma,
                    const std::array<double*, kAbreast>& f) {
  using Operator = OperatorOfFour<Dofs, pointwise>;
#pragma GCC unroll 9
  for (int i = 0; i < Dofs; i += 2) {
    Four sum[2] = {};
#pragma GCC unroll 4
    for (std::size_t p = 0; p < Points; ++p) {
      const double* B = geometry + p * Operator::kStride + kAbreast;
#pragma GCC unroll 2
      for (int r = 0; r < 2; ++r) {
        Four of_point{};
#pragma GCC unroll 4
        for (int c = 0; c < 4; ++c)
          if (Operator::couples(r, c))
            of_point = multiply_add(Operator::term(B, i + r, c), w_sigma[p][c], of_point);
        sum[r] += of_point;
      }
    }
    store_pairs_of_four(sum[0], sum[1], f[0] + i, f[1] + i, f[2] + i, f[3] + i);
  }
}

// (w D B)^T, as OperatorT.
template <int Dofs, bool pointwise>
void stress_operator_of_four(const double* B, const Four& w, const std::array<std::array<Four, 4>, 4>& D,
                             Four* wDBt) {
  using Operator = OperatorOfFour<Dofs, pointwise>;
#pragma GCC unroll 4
  for (std::size_t r = 0; r < 4; ++r) {
    const Four row[4] = {w * D[r][0], w * D[r][1], w * D[r][2], w * D[r][3]};
#pragma GCC unroll 18
    for (int i = 0; i < Dofs; ++i) {
      Four sum{};
#pragma GCC unroll 4
      for (int c = 0; c < 4; ++c)
        if (Operator::couples(i, c)) sum = multiply_add(Operator::term(B, i, c), row[c], sum);
      wDBt[static_cast<int>(r) * Dofs + i] = sum;
    }
  }
}

// Whether two rows of a column differ in some of four elements from what stands there.
inline FourMask rows_of_four_differ(const Four& first, const Four& second,
                                    const std::array<double*, kAbreast>& column) {
  Four old_first, old_second;
  load_pairs_of_four(column[0], column[1], column[2], column[3], old_first, old_second);
  return (reinterpret_cast<FourMask>(first) ^ reinterpret_cast<FourMask>(old_first)) |
         (reinterpret_cast<FourMask>(second) ^ reinterpret_cast<FourMask>(old_second));
}

// K = sum B^T w D B over the points, in blocks that the registers hold: the rows of a node, and some columns.
template <int Dofs, int Points, bool pointwise, int Columns>
void stiffness_block_of_four(const double* geometry, const Four* wDBt, int i, int j,
                             const std::array<double*, kAbreast>& K, bool& changed) {
  using Operator = OperatorOfFour<Dofs, pointwise>;
  Four sum[Columns][2] = {};
  const double* B = geometry + (1 + Operator::place(i, 0)) * kAbreast;
  const Four* right = wDBt + j;
#pragma GCC unroll 9
  for (int p = 0; p < Points; ++p, B += Operator::kStride, right += 4 * Dofs)
#pragma GCC unroll 4
    for (int c = 0; c < 4; ++c)
#pragma GCC unroll 4
      for (int m = 0; m < Columns; ++m)
#pragma GCC unroll 2
        for (int r = 0; r < 2; ++r)
          if (Operator::couples(r, c))
            sum[m][r] = multiply_add(Operator::term(B, r, c), right[c * Dofs + m], sum[m][r]);
  const std::ptrdiff_t first = j * Dofs + i;
  const std::array<double*, kAbreast> at{K[0] + first, K[1] + first, K[2] + first, K[3] + first};
  if (!changed) {
    FourMask differ{};
#pragma GCC unroll 4
    for (int m = 0; m < Columns; ++m)
      differ |= rows_of_four_differ(sum[m][0], sum[m][1],
                                    {at[0] + m * Dofs, at[1] + m * Dofs, at[2] + m * Dofs, at[3] + m * Dofs});
    changed = any_of_four(differ);
  }
#pragma GCC unroll 4
  for (int m = 0; m < Columns; ++m)
    store_pairs_of_four(sum[m][0], sum[m][1], at[0] + m * Dofs, at[1] + m * Dofs, at[2] + m * Dofs,
                        at[3] + m * Dofs);
}

template <int Dofs, int Points, bool pointwise>
void stiffness_of_four(const double* geometry, const Four* wDBt, const std::array<double*, kAbreast>& K,
                       bool& changed) {
  for (int i = 0; i < Dofs; i += 2) {
    for (int j = 0; j + 4 <= Dofs; j += 4)
      stiffness_block_of_four<Dofs, Points, pointwise, 4>(geometry, wDBt, i, j, K, changed);
    if constexpr (Dofs % 4 != 0)
      stiffness_block_of_four<Dofs, Points, pointwise, 2>(geometry, wDBt, i, Dofs - 2, K, changed);
  }
}

// The law at all points at once: one point's answer is a long chain of operations, several fill the registers.
template <int Dofs, int Points, bool pointwise>
Outcome evaluate_points_of_four(const FourElementsIn& in, FourElementsOut& out) {
  using Operator = OperatorOfFour<Dofs, pointwise>;
  const std::size_t history = in.history;
  std::array<FourPointsIn<4>, Points> point;
  std::array<FourPointsOut<4>, Points> result;
  for (std::size_t p = 0; p < Points; ++p) {
    strains_of_four<Dofs, pointwise>(in.geometry + p * Operator::kStride + kAbreast, in.du, point[p].deps);
    point[p].sigma0 = gather_four(in.sigma0, 4 * p);
    point[p].eps0 = gather_four(in.eps0, 4 * p);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < kAbreast; ++l) {
      point[p].h0[l] = in.h0[l] + p * history;
      result[p].h1[l] = out.h1[l] + p * history;
    }
  }
  if (in.law->update_four(point, result) != Outcome::ok) return Outcome::cut_step;

  std::array<std::array<Four, 4>, Points> w_sigma;
  for (std::size_t p = 0; p < Points; ++p) {
    const Four w = load_four(in.geometry + p * Operator::kStride);
#pragma GCC unroll 4
    for (std::size_t c = 0; c < 4; ++c) {
      point[p].eps0[c] += point[p].deps[c];
      w_sigma[p][c] = w * result[p].sigma[c];
    }
    scatter_four(point[p].eps0, out.eps1, 4 * p);
    scatter_four(result[p].sigma, out.sigma1, 4 * p);
#pragma GCC unroll 4
    for (std::size_t l = 0; l < kAbreast; ++l) out.status[l][p] = result[p].status[l];
  }
  forces_of_four<Dofs, Points, pointwise>(in.geometry, w_sigma, out.f);
  if (out.K[0] == nullptr) return Outcome::ok;
  const bool stands = out.constant;
  out.constant = std::ranges::all_of(result, [](const FourPointsOut<4>& at) { return at.constant_D; });
  if (out.constant && stands) return Outcome::ok;

  Four wDBt[Points * 4 * Dofs];
  for (std::size_t p = 0; p < Points; ++p) {
    const double* const geometry = in.geometry + p * Operator::kStride;
    stress_operator_of_four<Dofs, pointwise>(geometry + kAbreast, load_four(geometry), result[p].D,
                                             wDBt + p * 4 * Dofs);
  }
  stiffness_of_four<Dofs, Points, pointwise>(in.geometry, wDBt, out.K, out.changed);
  return Outcome::ok;
}

}  // namespace sage
