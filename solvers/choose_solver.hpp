<<<<<<< HEAD
// Which solver fits a matrix.
=======
// Which solver a run takes when the user leaves it open.
>>>>>>> w-solvers
#pragma once

namespace sage {

<<<<<<< HEAD
// A catalogue code from size and symmetry, by the measured rule of docs/theory/solvers.md.
inline int choose_solver(int equations, bool symmetric) {
  constexpr int kOwnProfileLimit = 4000;
  if (equations < kOwnProfileLimit) return symmetric ? 2 : 1;
  return symmetric ? 3 : 4;
}
=======
// Catalogue code for a system.  Measured (docs/theory/solvers.md): own solvers only, so that a run never waits
// for the libraries to load; profile below kProfileEquations, multifrontal above.
int choose_solver(int equations, bool symmetric);

inline constexpr int kProfileEquations = 6000;
>>>>>>> w-solvers

}  // namespace sage
