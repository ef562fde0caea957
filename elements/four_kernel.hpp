// The kernel of point_kernel.hpp for four elements of solids side by side: every product and sum is that of one
// element, in the same order.  Sums of one element wait for each other; those of four fill the registers.
#pragma once

#include <algorithm>
#include <utility>

#include "sage/core/element.hpp"

namespace sage {

// Four of large elements would leave the cache.
constexpr bool four_fit(int law_size, int dofs, int points) {
  return law_size == 4 && dofs <= 18 && points <= 9;
}

// Whether B has a term of this dof and component of strain that is not zero for certain.  pointwise: B as written
// in Solid::write_operator without its volumetric part.
constexpr bool couples(bool pointwise, int dof, int component) {
  if (!pointwise) return true;
  return dof % 2 == 0 ? component != 1 : component == 1 || component == 3;
}

// B du.  The sums of every fourth dof first, as vector registers of one element take them.
template <int Dofs>
std::array<Four, 4> strains_of_four(const double* Bt, const double* du) {
  std::array<Four, 4> strain;
#pragma GCC unroll 4
  for (std::size_t c = 0; c < 4; ++c, Bt += Dofs * kAbreast) {
    Four sum[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; ++l) {
      sum[l] = load_four(Bt + l * kAbreast) * load_four(du + l * kAbreast);
#pragma GCC unroll 4
      for (int i = l + 4; i < Dofs; i += 4)
        sum[l] = multiply_add(load_four(Bt + i * kAbreast), load_four(du + i * kAbreast), sum[l]);
    }
    strain[c] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }
  return strain;
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

// f += B^T w sigma.
template <int Dofs>
void add_forces_of_four(const double* Bt, const Four& w, const std::array<Four, 4>& sigma, Four* f) {
  const Four s[4] = {w * sigma[0], w * sigma[1], w * sigma[2], w * sigma[3]};
  for (int i = 0; i < Dofs; ++i) {
    Four sum = load_four(Bt + i * kAbreast) * s[0];
#pragma GCC unroll 4
    for (int c = 1; c < 4; ++c) sum = multiply_add(load_four(Bt + (c * Dofs + i) * kAbreast), s[c], sum);
    f[i] += sum;
  }
}

// (w D B)^T, as OperatorT.
template <int Dofs, bool pointwise>
void stress_operator_of_four(const double* Bt, const Four& w, const std::array<std::array<Four, 4>, 4>& D,
                             Four* wDBt) {
#pragma GCC unroll 4
  for (std::size_t r = 0; r < 4; ++r) {
    const Four row[4] = {w * D[r][0], w * D[r][1], w * D[r][2], w * D[r][3]};
    for (int i = 0; i < Dofs; i += 2)
#pragma GCC unroll 2
      for (int d = 0; d < 2; ++d) {
        constexpr int kFirst[2] = {0, pointwise ? 1 : 0};
        const double* const B = Bt + (i + d) * kAbreast;
        Four sum = load_four(B + kFirst[d] * Dofs * kAbreast) * row[kFirst[d]];
#pragma GCC unroll 4
        for (int c = kFirst[d] + 1; c < 4; ++c)
          if (couples(pointwise, d, c)) sum = multiply_add(load_four(B + c * Dofs * kAbreast), row[c], sum);
        wDBt[static_cast<int>(r) * Dofs + i + d] = sum;
      }
  }
}

// Up to four rows of a column, for each of four elements; where they differ from what stood there.
inline FourMask put_rows_of_four(Four a, Four b, Four c, Four d, int rows,
                                 const std::array<double*, kAbreast>& column, int offset) {
  transpose_four(a, b, c, d);
  const Four of[kAbreast] = {a, b, c, d};
  FourMask changed{};
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kAbreast; ++l) {
    double* const to = column[l] + offset;
    if (rows == 4) {
      changed |= reinterpret_cast<FourMask>(load_four(to)) ^ reinterpret_cast<FourMask>(of[l]);
      store_four(to, of[l]);
      continue;
    }
    Four old = of[l];
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i)
      one_of_four(old, i) = std::exchange(to[i], one_of_four(of[l], i));
    changed |= reinterpret_cast<FourMask>(old) ^ reinterpret_cast<FourMask>(of[l]);
  }
  return changed;
}

// K = sum B^T w D B over the points, in blocks that the registers hold: four rows of two columns.
template <int Dofs, int Points, bool pointwise>
bool stiffness_of_four(const double* geometry, const Four* wDBt, const std::array<double*, kAbreast>& K) {
  constexpr int kStride = (1 + 4 * Dofs) * kAbreast;
  FourMask changed{};
  for (int i = 0; i < Dofs; i += 4) {
    constexpr int kLast = Dofs % 4;
    const int rows = std::min(4, Dofs - i);
    for (int j = 0; j < Dofs; j += 2) {
      Four sum[2][4] = {};
      for (int p = 0; p < Points; ++p) {
        const double* Bt = geometry + p * kStride + (1 + i) * kAbreast;
        const Four* right = wDBt + p * 4 * Dofs + j;
#pragma GCC unroll 4
        for (int c = 0; c < 4; ++c, Bt += Dofs * kAbreast, right += Dofs) {
#pragma GCC unroll 4
          for (int r = 0; r < 4; ++r) {
            if (!couples(pointwise, r, c) || (kLast != 0 && r >= rows)) continue;
            const Four left = load_four(Bt + r * kAbreast);
            sum[0][r] = multiply_add(left, right[0], sum[0][r]);
            sum[1][r] = multiply_add(left, right[1], sum[1][r]);
          }
        }
      }
#pragma GCC unroll 2
      for (int m = 0; m < 2; ++m)
        changed |= put_rows_of_four(sum[m][0], sum[m][1], sum[m][2], sum[m][3], rows, K, (j + m) * Dofs + i);
    }
  }
  return any_of_four(changed);
}

template <int Dofs, int Points, bool pointwise>
Outcome evaluate_points_of_four(const FourElementsIn& in, FourElementsOut& out) {
  const SolidLaw& law = *std::get<const SolidLaw*>(in.law);
  const std::size_t history = law.history().size();
  Four wDBt[Points * 4 * Dofs];
  FourPointsIn<4> point;
  FourPointsOut<4> result;
  Four f[(Dofs + 3) / 4 * 4] = {};
  for (std::size_t p = 0; p < Points; ++p) {
    const double* const geometry = in.geometry + p * (1 + 4 * Dofs) * kAbreast;
    const double* const Bt = geometry + kAbreast;
    const Four w = load_four(geometry);
    point.sigma0 = gather_four(in.sigma0, 4 * p);
    point.eps0 = gather_four(in.eps0, 4 * p);
    point.deps = strains_of_four<Dofs>(Bt, in.du);
    for (std::size_t l = 0; l < kAbreast; ++l) {
      point.h0[l] = in.h0[l] + p * history;
      result.h1[l] = out.h1[l] + p * history;
    }
    if (law.update_four(point, result) != Outcome::ok) return Outcome::cut_step;

    for (std::size_t c = 0; c < 4; ++c) point.eps0[c] += point.deps[c];
    scatter_four(point.eps0, out.eps1, 4 * p);
    scatter_four(result.sigma, out.sigma1, 4 * p);
    for (std::size_t l = 0; l < kAbreast; ++l) out.status[l][p] = result.status[l];
    add_forces_of_four<Dofs>(Bt, w, result.sigma, f);
    if (out.K[0] != nullptr) stress_operator_of_four<Dofs, pointwise>(Bt, w, result.D, wDBt + p * 4 * Dofs);
  }
  for (int i = 0; i < Dofs; i += 4)
    put_rows_of_four(f[i], f[i + 1], f[i + 2], f[i + 3], std::min(4, Dofs - i), out.f, i);
  out.changed = out.K[0] != nullptr && stiffness_of_four<Dofs, Points, pointwise>(in.geometry, wDBt, out.K);
  return Outcome::ok;
}

}  // namespace sage
