// The status that is shown for a point: its law's, but for openings that are rounding.
#pragma once

#include "sage/analysis/group_data.hpp"
#include "sage/model/model.hpp"

namespace sage {

// Of a point that its law calls open.
PointStatus shown_opening(const Mesh& mesh, const GroupData& data, std::size_t point);

// Committed status of a point.  An interface that carries nothing opens and closes by the sign of a difference
// of displacements, 1e-16 of them: a gap of less than 1e-12 of the element's length counts as contact, elastic.
inline PointStatus shown_status(const Mesh& mesh, const GroupData& data, std::size_t point) {
  const PointStatus status = data.state.committed.status[point];
  return status == PointStatus::open ? shown_opening(mesh, data, point) : status;
}

}  // namespace sage
