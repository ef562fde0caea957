// What flows through a line, of a state whose points are up to date.
#pragma once

#include <span>

#include "sage/analysis/group_data.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/flow_line.hpp"

namespace sage {

struct FlowThrough {
  // From the left of the line to its right: the sum of what the elements on its left take in at its nodes, turned
  // about.  No gradient is involved: it balances to the last digits with what comes in elsewhere.
  // [length^3/time, full circle or unit thickness]
  double discharge = 0.0;
  // Largest fall of the head across the line at its nodes, from the points of the elements on its left; NaN where the
  // line has a node at which the velocity has no bound.
  double gradient = 0.0;
  double head = 0.0;  // mean of the line's nodes
  // What the water presses with from the left of the line on what lies to its right: integral of gamma_w (h - y) n
  // along the line, suction included.  Along +x and +y; NaN where the deck gives no gamma_w.
  //                                                                  [force, full circle or unit thickness]
  Vector2 force = Vector2::Zero();
};

// What an element takes in at its nodes: sum w B^T sigma.  [length^3/time]
Eigen::VectorXd taken_in(const Model& model, const GroupData& data, int element);

// Corners of the flow where the velocity has no bound, among these nodes: an impervious edge meets one with given heads
// at more than a right angle, or two edges of one kind meet at more than 180 degrees (10 degrees more in both cases, from
// which on the growth can be told).
std::vector<int> unbounded_corners(const Model& model, const Activity& activity, const std::vector<int>& nodes);

// nodes: of the line.  u: all unknowns.
FlowThrough flow_through(const Model& model, const FlowLine& line, const std::vector<int>& nodes,
                         std::span<const GroupData> groups, const Activity& activity, const Eigen::VectorXd& u);

}  // namespace sage
