// Numberings that keep the profile of the factors small: reverse Cuthill-McKee and Sloan.
// Every function returns the groups in the order of elimination; parts that are not connected come one by one.
#pragma once

#include <span>
#include <vector>

#include "solvers/equation_graph.hpp"

namespace sage {

// Cuthill & McKee (1969), reversed (George 1971), from a pseudo-peripheral group (Gibbs, Poole & Stockmeyer
// 1976).
std::vector<int> reverse_cuthill_mckee(const EquationGraph& graph);

// Sloan (1989), "A FORTRAN program for profile and wavefront reduction", Int. J. Num. Meth. Engng 28.
std::vector<int> sloan(const EquationGraph& graph);

// Sum over the equations of the squared height of their column: proportional to the work of a profile solver.
double profile_cost(const EquationGraph& graph, std::span<const int> order);

// Terms within the profile, both triangles and diagonal: what a profile solver stores.
double profile_terms(const EquationGraph& graph, std::span<const int> order);

// The cheapest of the given numbering, reverse Cuthill-McKee and Sloan.
std::vector<int> best_profile_numbering(const EquationGraph& graph);

// Equations in the order of elimination, group by group.
std::vector<int> expand(const EquationGraph& graph, std::span<const int> order);

// Groups at every distance from the roots, as far as they are connected: levels of a breadth-first search.
IndexLists levels_from(const EquationGraph& graph, std::span<const int> roots, std::vector<int>& distance);

}  // namespace sage
