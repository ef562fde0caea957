// Which unknowns the active elements have.
#pragma once

#include "sage/model/activity.hpp"

namespace sage {

// A flag for every dof: some element of an active group has it.
std::vector<char> active_dofs(const Model& model, const Activity& activity);

}  // namespace sage
