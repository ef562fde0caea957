// Values at nodes from values at integration points, for pictures and VTU.
#pragma once

#include <functional>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// A node that two materials share has two values: an entry is a (node, material) pair in use by an active
// group. Interfaces have materials of their own, so they stay apart from solids.
struct NodalLayout {
  std::vector<int> node;  // of each entry
  std::vector<std::vector<int>>
      of_group;  // by Model::groups: entry of each item of Group::nodes; empty = not active
  int entries() const { return static_cast<int>(node.size()); }
};

NodalLayout nodal_layout(const Model& model, const Activity& activity);

// Fills `values` (components) for one point of the committed state.
using PointValue = std::function<void(const GroupData& data, std::size_t point, double* values)>;

// entries x components: extrapolated from the points (Element::point_to_node), then the plain mean over the
// elements that share the entry.
std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  int components, const PointValue& value);

// elements x components of a group: the plain mean over an element's points.
std::vector<double> element_average(const GroupData& data, int components, const PointValue& value);

}  // namespace sage
