// The conic programs of both bounds.  Lower: stresses linear in every triangle, free to jump between them as far as
// equilibrium allows.  Upper: velocities quadratic in every triangle.  docs/theory/bounds.md
#pragma once

#include "sage/bounds/cone_program.hpp"
#include "sage/bounds/domain.hpp"

namespace sage::bounds {

// What tau is.
enum class Quantity {
  load,      // multiplier of the live loads, or the power of the forces at the edges that move
  strength,  // what can be taken off s0 of every yield condition while all loads act
};

// Program and domain differ by these units.
struct Units {
  double length = 1.0, stress = 1.0;
  double tau = 1.0;  // of the domain's tau
};

struct BoundProgram {
  ConeProgram program;  // points: the corners of triangle 0, 1, ..., then those of joints
  Units units;
  std::vector<int> velocity;  // upper: equation of node (corners, then middles of edges) and axis; -1 = held
  std::vector<double> share;  // upper: what its value is of that equation's unknown
  std::vector<char> stress_free;  // lower: corners where only zero stress is possible, by point
};

BoundProgram lower_program(const Domain& domain, const Edges& edges, Quantity quantity);
BoundProgram upper_program(const Domain& domain, const Edges& edges, Quantity quantity);

}  // namespace sage::bounds
