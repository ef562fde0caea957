// What takes part in a stage: groups that are placed and not yet removed, dofs that are held.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct Activity {
  explicit Activity(const Model& model);
  // Births, deaths and fixities of a stage, on top of those before it.
  void enter(const Stage& stage);

  std::vector<char> group;  // active now
  std::vector<char> held;   // a dof: prescribed (2 node + component)
};

// A flag for every node: some element of an active group has it.
std::vector<char> active_nodes(const Model& model, const Activity& activity);

// For every node the number of its connected part (by elements of active groups), -1 = in no active element.
std::vector<int> connected_parts(const Model& model, const Activity& activity);

}  // namespace sage
