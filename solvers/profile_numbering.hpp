// Numberings that keep the profile of the factors small: reverse Cuthill-McKee from an end or from a
// whole side. Every function returns the groups in the order of elimination; parts that are not
// connected come one by one.
#pragma once

#include <span>
#include <vector>

#include "solvers/equation_graph.hpp"

namespace sage {

// Where a numbering begins: at one end of a pseudo-diameter (Gibbs, Poole & Stockmeyer 1976), or with all
// groups that are farthest from its other end.  A rectangle is numbered line by line only from a whole side.
enum class Beginning { end, side };

// Cuthill & McKee (1969), reversed (George 1971).
std::vector<int> reverse_cuthill_mckee(const EquationGraph& graph, Beginning beginning);

// Sum over the equations of the squared height of their column: proportional to the work of a profile solver.
double profile_cost(const EquationGraph& graph, std::span<const int> order);

// The cheapest of the given numbering and the two above.
std::vector<int> best_profile_numbering(const EquationGraph& graph);

// Equations in the order of elimination, group by group.
std::vector<int> expand(const EquationGraph& graph, std::span<const int> order);

// Moves every pressure behind the last other equation that shares an element with it.  The pivots of a symmetric matrix
// [K -Q; -Q^T -C], C >= 0, are then those of K and of -(C + Q^T K^-1 Q), of any size of C (docs/theory/consolidation.md).
void delay_pressures(const EquationGraph& graph, std::vector<int>& equations);

}  // namespace sage
