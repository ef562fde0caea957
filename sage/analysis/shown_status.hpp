// The status that is shown for a point: its law's, but for openings that are rounding.
#pragma once

#include "sage/analysis/group_data.hpp"
#include "sage/model/model.hpp"

namespace sage {

// Committed status of a point.  An interface that carries nothing opens and closes by the sign of a difference
// of displacements, 1e-16 of them: a gap of less than 1e-12 of the element's length counts as contact, elastic.
PointStatus shown_status(const Mesh& mesh, const GroupData& data, std::size_t point);

}  // namespace sage
