// What takes part in a stage: groups that are born and not yet removed, dofs that are held.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sage/model/dof_map.hpp"

namespace sage {

struct Activity {
  explicit Activity(const Model& model);
  // Births, deaths and fixities of a stage, on top of those before it.
  void enter(const Stage& stage);

  // Of a displacement.
  bool holds(int node, int component) const { return held[DofMap::displacement(node, component)] != 0; }

  DofMap dof_map;
  std::vector<char> group;  // active now
  std::vector<char> held;   // a dof: prescribed
  // Excess pressures of pore water, one entry each: whether supports hold it, while the stage may keep or free them all.
  std::vector<std::pair<int, char>> pores;  // dof and flag
};

// A flag for every node: some element of an active group has it.
std::vector<char> active_nodes(const Model& model, const Activity& activity);

// For every node the number of its connected part (by elements of active groups that are displaced), -1 = in none.
std::vector<int> connected_parts(const Model& model, const Activity& activity);
// By those elements alone that carry something: of group number `group`, counted from 0.
using Carries = std::function<bool(std::size_t group, int element)>;
std::vector<int> connected_parts(const Model& model, const Carries& carries);

// A connected part that its supports leave free to move as a rigid body.
struct LoosePart {
  int part = 0;
  std::string motion;  // "a rigid translation in y"
};
// From the rank of the held dofs' rows in the rigid modes.  `part`: from connected_parts.
std::vector<LoosePart> loose_parts(const Model& model, const Activity& activity, const std::vector<int>& part);
// "part that contains node 5 (4 nodes: 5, 6, 7, 8)"
std::string part_name(const Model& model, const std::vector<int>& part, int p);

}  // namespace sage
