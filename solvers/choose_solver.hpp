// Which solver a run takes when the user leaves it open.
#pragma once

#include "sage/core/linear_solver.hpp"

namespace sage {

// Catalogue code for a system.  Measured (docs/theory/solvers.md): own solvers only, so that
// a run never waits for the libraries to load; profile below profile_equations, multifrontal from there on.
int choose_solver(const SystemSize& system);

// Pressures stand behind the displacements around them, which widens the profile.
inline int profile_equations(const SystemSize& system) {
  return system.pores ? 400 : 3000;
}

}  // namespace sage
