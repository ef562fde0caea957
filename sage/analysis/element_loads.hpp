// Loads that elements see: spread along structures whose sections may yield, and on edges that follow a motion.
#pragma once

#include <vector>

#include "sage/analysis/group_data.hpp"

namespace sage {

// Those of a stage (0-based), at its start and at its end.
void begin_element_loads(const Model& model, int stage, std::vector<GroupData>& groups);
// Those at the end of the stage in hand have changed: they grow there from what acts at this load factor, below 1.
void change_element_loads(const Model& model, int stage, double load_factor, std::vector<GroupData>& groups);

}  // namespace sage
