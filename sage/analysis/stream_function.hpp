// Stream function of steady flow: what flows between two places, and with the heads a flow net.
#pragma once

#include <span>

#include "sage/analysis/group_data.hpp"

namespace sage {

// v_x = d(psi)/dy, v_y = -d(psi)/dx in plane strain; of rings v_r = -d(psi)/dz / 2 pi r, v_z = d(psi)/dr / 2 pi r but
// for the sign (Stokes): the difference of two places is what flows between them, per unit length or through the full
// circle; it grows towards the left of the flow.
struct StreamFunction {
  Eigen::VectorXd
      at_node;  // all of the mesh; NaN where no water flows.  0 at the least of each part  [length^3/time]
  double largest = 0.0;
  // Largest amount that a closed way round a node inside the flow brings in, over `largest`: wells, drains and held
  // heads inside.  Then psi has more than one value, and jumps along some line.
  double sources = 0.0;
};

// Exact for the discrete flow: half-way between two neighbouring nodes of an element's outline psi has a value, and
// from one to the next it falls by what the element takes in at the node between them.  These sums close around
// each element, and around each node that nothing is put in at.  A node has the mean of what lies around it; at the
// edge of the flow, of what lies on the edge.
// active: a flag a group.
StreamFunction stream_function(const Model& model, const std::vector<char>& active,
                               std::span<const GroupData> groups);

}  // namespace sage
