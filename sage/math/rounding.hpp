// Limits below which a number counts as rounding, as shares of the size that each place names.
#pragma once

#include <limits>

namespace sage::rounding {

inline constexpr double kUnit = std::numeric_limits<double>::epsilon();

// A sum of a few products: a force of one dof, a coordinate that is interpolated.  n products make up to n units (Higham 2002,
// section 3.1); eight is the number of terms that count in a row of a plane element.
inline constexpr double kFewProducts = 8.0 * kUnit;
// Forces of elements that meet at a node, each of which is such a sum, with signs that add up.
inline constexpr double kSumAtNode = 16.0 * kUnit;
// One solution of a linear system that is well conditioned: some fifty units.
inline constexpr double kSolution = 1e-14;
// A stress beside the strength of a joint or the pivots of a 3 x 3 block: a few hundred units.
inline constexpr double kStrength = 1e-13;
// A stress after a return to a yield surface, a parent coordinate after the inverse map, a number of a result beside the largest of
// its table: some thousand units, what a handful of Newton's iterations leaves.
inline constexpr double kResult = 1e-12;
// Results of two runs or of a picture that have gone through a solver.
inline constexpr double kRun = 1e-10;
// Coordinates and times that come from text, with ten digits or more, or from a program that writes them so.
inline constexpr double kText = 1e-9;

}  // namespace sage::rounding
