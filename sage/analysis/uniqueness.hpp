// Points whose tangent has lost uniqueness: a band of shear may form there at no cost.
#pragma once

#include <vector>

#include "sage/analysis/assembly.hpp"

namespace sage {

// det of the acoustic tensor n D n for a direction in the plane, over that of the elastic tangent; the smallest
// over all directions (a fan of 5 degrees).
double smallest_acoustic_ratio(const Matrix4& D, const Matrix4& elastic);

struct UniquenessCount {
  long lost = 0, plastic = 0;   // points with a negative ratio, of those that yield
  long softening = 0;           // of those that lost it: the tangent itself has a negative determinant
  std::vector<int> elements{};  // numbers of those that have points which lost it
};

// Which step: the last one that was committed (right after it the trial states hold the state before), or the
// attempt that the trial states hold.
enum class StepKind { committed, attempted };

// Laws with a symmetric tangent are left out, and so are interfaces.               [Rudnicki & Rice 1975]
UniquenessCount count_loss_of_uniqueness(const Assembly& assembly, StepKind step = StepKind::committed);

// Points of a group (numbered through it) whose tangent in the last committed step has next to no stiffness in any
// direction, in increasing order.  Right after the commit, as above; none where the law is linear.
std::vector<std::size_t> points_without_stiffness(const Assembly& assembly, const GroupData& data);

}  // namespace sage
