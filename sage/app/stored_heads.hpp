// Heads of an earlier run, from its result file, at the nodes of another mesh or the same one.
#pragma once

#include "sage/builder/build_model.hpp"

namespace sage::app {

// For BuildOptions::heads.  The catalogue must outlive it; the run must be one of its pieces.
// A node at the place of one node of the earlier mesh has its head to the last bit; elsewhere it is that of the
// element of flow that holds the place (docs/manual/water.md).
HeadReader stored_heads(const Catalogue& catalogue);

}  // namespace sage::app
