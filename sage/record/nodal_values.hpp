// Values at nodes from values at integration points, for pictures and VTU.
#pragma once

#include <vector>

#include "sage/record/field_reader.hpp"

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

// What is carried (carry()) of fields that live at points, one field behind the other.  entries x numbers:
// extrapolated from the points (Element::point_to_node), then the plain mean over the elements that share the
// entry.
std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  const FieldList& fields);

// Values of fields that live at points, one field behind the other.  elements x numbers of a group: the plain
// mean over an element's points; of a field of_mean, the value of the mean of what is carried.
std::vector<double> element_average(const Mesh& mesh, const GroupData& data, const FieldList& fields);

// Numbers of all these fields together.
std::size_t size_of(const FieldList& fields);
std::size_t carried_size_of(const FieldList& fields);

}  // namespace sage
