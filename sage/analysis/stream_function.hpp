// Stream function of steady flow: what flows between two places, and with the heads a flow net.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sage/analysis/group_data.hpp"

namespace sage {

struct Solution;

inline constexpr std::string_view kStreamFunction = "stream_function";  // the field

// Its difference between two places is what flows between them [length^3/time]: per unit length in plane strain,
// through the full circle in axisymmetry.  It grows towards the left of the flow:
//   plane strain  v_x = d(psi)/dy,           v_y = -d(psi)/dx
//   axisymmetry   v_r = d(psi)/dz / (2 pi r), v_z = -d(psi)/dr / (2 pi r), which is -2 pi times Stokes' function
// 0 is its least value at a node, in each part of the flow by itself.
struct StreamFunction {
  Eigen::VectorXd at_node;  // all nodes of the mesh; NaN where no water flows
  // A flag a node: psi has one value there.  Not in parts of the flow where a closed way lets something in: around a
  // well or a held head inside, or around a hole that takes water.  What stands in at_node then jumps along some line.
  std::vector<char> unique;
  double largest = 0.0;  // at a node
  double jump = 0.0;     // the largest over `largest`; what is below kLeastJump is rounding
  std::string reason;    // why there are nodes without a value; empty = there are none

  static constexpr double kLeastJump = 1e-6;
  double value(int node) const;  // NaN where psi has no single value
};

// Exact for the discrete flow: half-way between two neighbouring nodes of an element's outline psi has a value, and
// from one to the next it falls by what the element takes in at the node between them.  These sums close around
// each element, and around each node that nothing is put in at.  A node has what lies around it, the nearer the more;
// at the edge of the flow, what lies on the edge, and where part of that lets nothing through, what lies there: ends of
// walls have the value of the wall, and between two walls psi differs by the discharge to rounding.
// active: a flag a group.
StreamFunction stream_function(const Model& model, const std::vector<char>& active,
                               std::span<const GroupData> groups);

// Of a solution, which keeps it: made when somebody first asks.
const StreamFunction& stream_function(const Model& model, const Solution& solution);

}  // namespace sage
