// Which solver a run takes when the user leaves it open.
#pragma once

namespace sage {

// Catalogue code for a system.  Measured (docs/theory/solvers.md): own solvers only, so that a run never waits
// for the libraries to load; profile below kProfileEquations, multifrontal above.
int choose_solver(int equations, bool symmetric);

inline constexpr int kProfileEquations = 3000;

}  // namespace sage
