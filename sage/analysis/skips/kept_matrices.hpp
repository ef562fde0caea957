// The skip 'factors': matrices of elements that can change are kept, so that K is assembled and factorised
// again only where one has.
#pragma once

#include "sage/analysis/group_data.hpp"

namespace sage {

// Room for the matrices of a group, unless they would be the bulk of the memory.
void keep_matrices(GroupData& data);

// True where a matrix differs from the one that is kept, which it replaces.
bool replace_matrix(GroupData& data, int element, const double* K);

}  // namespace sage
