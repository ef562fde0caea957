// The skip 'contraction': in large systems Newton keeps its factors while they contract well.
#pragma once

namespace sage {

// A factorisation costs a dozen force passes and solutions there.
inline bool contraction_pays(int equations) {
  constexpr int kLarge = 20000;
  return equations > kLarge;
}

// Forces out of balance after a correction and before it.
inline bool contracts_poorly(double norm, double old_norm) {
  constexpr double kGoodContraction = 0.2;
  return norm > kGoodContraction * old_norm;
}

}  // namespace sage
