// Four doubles side by side, one of each of four points or elements: what loops do with them, vector registers do
// at once (AVX: one register; SSE2: two).  The operators of C++ work on all four; a comparison gives a mask, and
// mask ? a : b chooses place by place.
#pragma once

#include <cstdint>

#include "sage/core/types.hpp"

// Functions below are inlined: how others would pass such values is of no account.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace sage {

inline constexpr int kAbreast = 4;
using Four = double __attribute__((vector_size(kAbreast * sizeof(double))));
using FourMask = std::int64_t __attribute__((vector_size(kAbreast * sizeof(double))));

inline Four all_four(double x) {
  return Four{x, x, x, x};
}

// Four doubles in a row, anywhere.
using FourInARow = double __attribute__((vector_size(kAbreast * sizeof(double)), aligned(8), may_alias));
inline Four load_four(const double* p) {
  return *reinterpret_cast<const FourInARow*>(p);
}
inline void store_four(double* p, const Four& x) {
  *reinterpret_cast<FourInARow*>(p) = x;
}

// The place l, through memory: GCC 12.2 checks the bounds of a subscript that varies wrongly, and takes another place
// (-fsanitize=bounds, without AVX).
inline double one_of_four(const Four& x, std::size_t l) {
  return reinterpret_cast<const double*>(&x)[l];
}
inline double& one_of_four(Four& x, std::size_t l) {
  return reinterpret_cast<double*>(&x)[l];
}

// Of a comparison, in which a place holds all bits or none: a bit of each place where it holds, the first place lowest.
inline int bits_of_four(const FourMask& mask) {
#ifdef __AVX__
  return __builtin_ia32_movmskpd256(reinterpret_cast<Four>(mask));
#else
  return static_cast<int>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}
inline constexpr int kAllOfFour = (1 << kAbreast) - 1;

inline bool any_of_four(const FourMask& mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

inline Four sqrt_of_four(const Four& x) {
  using Array = Eigen::Array<double, kAbreast, 1>;
  Four root;
  Eigen::Map<Array, Eigen::Aligned32>(reinterpret_cast<double*>(&root)) =
      Eigen::Map<const Array, Eigen::Aligned32>(reinterpret_cast<const double*>(&x)).sqrt();
  return root;
}
inline Four abs_of_four(const Four& x) {
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  return reinterpret_cast<Four>(reinterpret_cast<FourMask>(x) &
                                FourMask{kAllButSign, kAllButSign, kAllButSign, kAllButSign});
}

// a b + c, rounded once where the machine can.  Compilers make that of sums and products as they like: for sums
// that must not depend on their taste.
inline Four multiply_add(const Four& a, const Four& b, const Four& c) {
#ifdef __FMA__
  return __builtin_ia32_vfmaddpd256(a, b, c);
#else
  return a * b + c;
#endif
}

inline double multiply_add(double a, double b, double c) {
#ifdef __FMA__
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

// Rows become columns.
inline void transpose_four(Four& a, Four& b, Four& c, Four& d) {
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6),
             ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6),
             cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

// Two doubles in a row, anywhere.
using TwoInARow = double __attribute__((vector_size(2 * sizeof(double)), aligned(8), may_alias));
inline const TwoInARow& two_in_a_row(const double* p) {
  return *reinterpret_cast<const TwoInARow*>(p);
}
inline TwoInARow& two_in_a_row(double* p) {
  return *reinterpret_cast<TwoInARow*>(p);
}

inline TwoInARow first_half_of_four(const Four& x) {
  return __builtin_shufflevector(x, x, 0, 1);
}
inline TwoInARow second_half_of_four(const Four& x) {
#ifdef __AVX__
  return __builtin_ia32_vextractf128_pd256(x, 1);  // GCC 12 makes two instructions of the other form
#else
  return __builtin_shufflevector(x, x, 2, 3);
#endif
}

// Four pairs (x, y) from four places: first = the x, second = the y.
inline void load_pairs_of_four(const double* a, const double* b, const double* c, const double* d, Four& first,
                               Four& second) {
  const Four ac = __builtin_shufflevector(two_in_a_row(a), two_in_a_row(c), 0, 1, 2, 3),
             bd = __builtin_shufflevector(two_in_a_row(b), two_in_a_row(d), 0, 1, 2, 3);
  first = __builtin_shufflevector(ac, bd, 0, 4, 2, 6);
  second = __builtin_shufflevector(ac, bd, 1, 5, 3, 7);
}
inline void store_pairs_of_four(const Four& first, const Four& second, double* a, double* b, double* c,
                                double* d) {
  const Four ac = __builtin_shufflevector(first, second, 0, 4, 2, 6),
             bd = __builtin_shufflevector(first, second, 1, 5, 3, 7);
  two_in_a_row(a) = first_half_of_four(ac);
  two_in_a_row(b) = first_half_of_four(bd);
  two_in_a_row(c) = second_half_of_four(ac);
  two_in_a_row(d) = second_half_of_four(bd);
}

}  // namespace sage
