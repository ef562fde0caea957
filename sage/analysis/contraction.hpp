// The skip 'contraction': in large systems Newton keeps its factors while they contract well.
#pragma once

namespace sage {

// Residuals after a correction and before it.
inline bool contracts_poorly(double norm, double old_norm) {
  constexpr double kGoodContraction = 0.2;
  return norm > kGoodContraction * old_norm;
}

}  // namespace sage
