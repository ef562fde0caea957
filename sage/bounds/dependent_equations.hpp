#pragma once

#include <vector>

#include "sage/bounds/cone_program.hpp"

namespace sage::bounds {

// Equations that follow from others of the same node, as where four edges meet on two lines.
// node_of: by equation, the node whose stresses alone it holds; -1 = it holds others as well.
std::vector<int> dependent_equations(const ConeProgram& program, const std::vector<int>& node_of);

}  // namespace sage::bounds
