// Values at nodes from values at integration points, for pictures and VTU.
#pragma once

#include <vector>

#include "sage/platform/thread_pool.hpp"
#include "sage/record/field_reader.hpp"

namespace sage {

// A node that two bodies share has two values: an entry is a node with the elements of one material that hang together
// there, of active groups.  Elements of an area hang together by an edge without a structure along it, those of an
// interface by a pair of nodes: so the two sides of a wall, and of a wall's two interfaces, are apart.
struct NodalLayout {
  std::vector<int> node;  // of each entry
  std::vector<std::vector<int>>
      of_group;  // by Model::groups: entry of each item of Group::nodes; empty = not active
  int entries() const { return static_cast<int>(node.size()); }
};

NodalLayout nodal_layout(const Model& model, const Activity& activity);

// How an element's points give values at its nodes: extrapolated (Element::point_to_node), or their plain mean at
// all of them, as the source chapter's figures are drawn.  Extrapolation shows what varies within an element; where
// the points of neighbours disagree, as in nearly incompressible 4-node elements, it makes more of that.
enum class NodalRule { extrapolated, element_means };

// What is carried (carry()) of fields that live at points, one field behind the other.  entries x numbers: the
// plain mean over the elements that share the entry of what each gives there.  pool: threads that share the work, if
// there are; values do not depend on them, to the last bit.
std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  const FieldList& fields, NodalRule rule = NodalRule::extrapolated,
                                  ThreadPool* pool = nullptr);

// Values of fields that live at points, one field behind the other.  elements x numbers of a group: the plain
// mean over an element's points; of a field of_mean, the value of the mean of what is carried.  pool: as above.
std::vector<double> element_average(const Mesh& mesh, const GroupData& data, const FieldList& fields,
                                    ThreadPool* pool = nullptr);

// Numbers of all these fields together.
std::size_t size_of(const FieldList& fields);
std::size_t carried_size_of(const FieldList& fields);

}  // namespace sage
