// Forces and moments at both ends of structures' elements, from the forces of their nodes: what the neighbours,
// supports and loads of a node have to balance.  docs/theory/structures.md
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sage/record/field_reader.hpp"

namespace sage {

// Quantities that ends have; rows of the same names stand in the table of fields.
inline constexpr std::array<std::string_view, 6> kEndQuantities{"axial_force", "shear_force", "bending_moment",
                                                                "hoop_force",  "hoop_moment", "force_each"};
inline constexpr std::size_t kAxialForce = 0, kShearForce = 1, kBendingMoment = 2, kHoopForce = 3,
                             kHoopMoment = 4, kForceEach = 5;

// Place in kEndQuantities; -1 = it is none of them.
int end_quantity(std::string_view field);
// Row of the table that a quantity is described by.
const FieldEntry& end_field(std::size_t quantity);

struct ElementEnd {
  int element = 0;                                            // index within the group
  int end = 1;                                                // 1 or 2; of a ring 1 alone
  int node = 0;                                               // index
  Vector2 place = Vector2::Zero(), along = Vector2::UnitX();  // along: on the way from node 1 to node 2
  // As people read them: for each unit of width or circumference, axial and hoop force compression positive;
  // force_each of one bar.  NaN where the element has none.
  std::array<double, kEndQuantities.size()> value{};
};

// Both ends of every element of a group, in order.  Loads spread along the elements are taken off the forces of
// the nodes, so that ends are exact where nodes are.  Empty: it is no structure, or not active.
std::vector<ElementEnd> element_ends(const Model& model, const Solution& solution, std::size_t group);
// Whether elements of a law have a quantity.
bool has_quantity(const Model& model, const Group& group, std::size_t quantity);
// Those that some structure of the model has.
std::vector<std::size_t> end_quantities(const Model& model);

// The least and the largest of all stages so far, at an end.
struct EnvelopeEnd {
  std::int64_t group = 0, element = 0, end = 1,
               node = 0;  // places in Model::groups and in the group; node: index
  std::array<double, kEndQuantities.size()> low{}, high{};                    // NaN where it has none
  std::array<std::int64_t, kEndQuantities.size()> low_stage{}, high_stage{};  // from 0
};

// Gathers the ends of stages.
class Envelope {
 public:
  void add(const Model& model, int stage, const Solution& solution);
  // By group and element.
  std::vector<EnvelopeEnd> rows() const;
  void exchange(Archive& archive) { archive(rows_); }

 private:
  std::vector<EnvelopeEnd> rows_;  // groups in the order of their births
};

}  // namespace sage
