// Which solver fits a matrix.
#pragma once

namespace sage {

// A catalogue code from size and symmetry, by the measured rule of docs/theory/solvers.md.
inline int choose_solver(int equations, bool symmetric) {
  constexpr int kOwnProfileLimit = 4000;
  if (equations < kOwnProfileLimit) return symmetric ? 2 : 1;
  return symmetric ? 3 : 4;
}

}  // namespace sage
