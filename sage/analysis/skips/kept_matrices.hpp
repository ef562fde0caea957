// The skip 'factors': matrices of elements that can change are kept, so that K is assembled and factorised
// again only where one has.
#pragma once

#include "sage/analysis/step_time.hpp"

namespace sage {

// Room for the matrices of a group, unless they would be the bulk of the memory.
void keep_matrices(GroupData& data);

// True where a matrix differs from the one that is kept, which it replaces.
bool replace_matrix(GroupData& data, int element, const double* K);

// Whether the matrices that such a group keeps are those of this step, where each step size has its own (has_matrix_of_step).
bool matrices_stand(const GroupData& data, const StepTime& now);

}  // namespace sage
