// A group's points and what is kept of its elements between passes.
#pragma once

#include <vector>

#include "sage/analysis/element_dofs.hpp"
#include "sage/core/four_at_a_time.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/state_store.hpp"
#include "sage/model/model.hpp"

namespace sage {

// Sections of beams that may yield see the loads along their elements.
inline bool sees_spread_loads(const Group& group, const LawRef& law) {
  return group.structure() && size_of_law(law) > 1 &&
         !std::visit([](const auto* held) { return held->traits().linear; }, law);
}

// A load on an edge under large strain: its sums up to both ends of the stage.
struct FollowedEdge {
  int element = 0;
  EdgeTraction start, end;
};

struct GroupData {
  explicit GroupData(const Group& its_group)
      : group(&its_group), dofs_(static_cast<std::size_t>(its_group.element->traits().dofs)) {}

  const Group* group;
  LawRef law, second_law;  // second_law: holds nullptr where the element has one law
  bool active = false;
  bool wants_context = false;  // its law does
  bool constant = false;       // of a linear law, and matrices and forces are kept: iterations call no law
  // Where its elements are evaluated four at a time: what its element and its law offer for that; else nullptr.  The law
  // alone where elements take their own points by four.
  const FourElements* four_elements = nullptr;
  const FourPointLaw<4>* four_law = nullptr;
  StateStore state;
  // Pore pressure at the points of a solid at the committed state, without the excess; empty = the model has none.
  std::vector<double> pore;
  // Elements with unknowns of their own: the dofs of all of them, and the field of each dof of one.  Empty: the
  // displacements of the nodes.
  std::vector<int> dof_list, field_of_dof;
  std::vector<double> geometry;  // w and B of all elements; empty = made anew in each pass
  // four_abreast(): in place of it, of each four in turn, their values side by side; the last four are filled up with the
  // last element.
  std::vector<double> geometry_four_abreast;
  std::vector<char>
      constant_four_abreast;  // of each four: FourElementsOut::constant of the matrices that are kept
  // Of ElementTraits::linear_in_step: ElementIn::dt, flow_dt and theta of the matrices that are kept; the first 0 = unknown.
  std::array<double, 3> step_of_matrices{};
  std::vector<char> moved;  // of each element: the stage prescribes to some dof a displacement that is not zero
  int first_element = 0;    // in the solver's element order, while it is part of the system
  std::vector<double> K;    // kept element matrices, column-major
  std::vector<double>
      shift;  // constant: forces of a unit displacement of the whole element along x, one a matrix
  std::vector<int> matrix;  // of each element: its place in K, counted in matrices; empty = none are kept
  // Constant: internal force of each element at the committed state, and tried; empty = zero.
  std::vector<double> force, trial_force;
  // Structures whose law is not linear: loads spread along the elements at both ends of the stage, a force a dof, element
  // after element; empty = none.
  bool sees_spread = false;
  std::vector<double> spread_start, spread_end;
  std::vector<FollowedEdge> followed;  // of large strain, by element

  bool four_abreast() const { return four_elements != nullptr; }
  bool keeps_matrices() const { return !matrix.empty(); }
  std::size_t matrix_size() const { return dofs() * dofs(); }
  std::size_t dofs() const { return dofs_; }  // of an element
  ElementDofs dofs_of(int element) const {
    if (!dof_list.empty())
      return ElementDofs::listed({dof_list.data() + static_cast<std::size_t>(element) * dofs(), dofs()});
    return ElementDofs({group->nodes_of(element), group->node_count()});
  }
  const double* matrix_of(int element) const {
    return K.data() + static_cast<std::size_t>(matrix[element]) * dofs() * dofs();
  }
  const double* shift_of(int element) const {
    return shift.data() + static_cast<std::size_t>(matrix[element]) * dofs();
  }

 private:
  std::size_t dofs_;
};

// The equations of all elements of a group, behind those that are listed.  equation_of: by dof; -1 = none.
inline void append_equations(const GroupData& data, const std::vector<int>& equation_of,
                             ElementEquations& list) {
  for (int e = 0; e < data.group->elements(); ++e) {
    const ElementDofs dofs = data.dofs_of(e);
    for (std::size_t i = 0; i < dofs.size(); ++i) list.equations.push_back(equation_of[dofs[i]]);
    list.offset.push_back(static_cast<std::int64_t>(list.equations.size()));
  }
}

}  // namespace sage
