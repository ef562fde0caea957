// What takes part in a stage: groups that are born and not yet removed, dofs that are held.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sage/model/dof_map.hpp"

namespace sage {

// A node with turned supports (TurnedFixity), and what holds it now.
struct TurnedNode {
  struct Axis {
    double angle = 0.0;
    std::size_t component = 0;
    std::array<double, 2> direction{};  // its unit vector
    bool held = false;
    bool operator==(const Axis&) const = default;
  };

  int node = 0;
  std::array<char, 2> by_xy{};  // held by supports along x and y
  std::vector<Axis> axes;       // of all its turned supports, of any stage
  bool slides = false;          // held in one turned direction alone: it moves along `slide`
  std::array<double, 2> slide{};

  // Unit vectors of all directions that are held now.
  std::vector<Vector2> held_directions() const;
  bool operator==(const TurnedNode&) const = default;
};

// A displacement that ties join to others.
struct TiedDof {
  int dof = 0;
  std::vector<int> groups;  // with its node
  bool held = false;        // by its supports alone
  bool supported = false;   // held so, and an active group has the node
};

struct Activity {
  explicit Activity(const Model& model);
  // Births, deaths and fixities of a stage, on top of those before it.
  void enter(const Stage& stage);

  // Of a displacement.
  bool holds(int node, int component) const { return held[DofMap::displacement(node, component)] != 0; }
  // The node, where it has turned supports; else nullptr.
  const TurnedNode* turned_at(int node) const;
  // A support acts on the dof: it is held, or its node slides along a line.
  bool has_reaction(int dof) const;
  // ... or a tie does.
  bool is_constrained(int dof) const { return has_reaction(dof) || (!in_tie_.empty() && in_tie_[dof] != 0); }

  DofMap dof_map;
  std::vector<char> group;  // active now
  std::vector<char> held;   // a dof: prescribed; not those of nodes that slide
  // Excess pressures of pore water, one entry each: whether supports hold it, while the stage may keep or free them all.
  std::vector<std::pair<int, char>> pores;  // dof and flag
  std::vector<TurnedNode> turned;           // by rising node
  std::vector<std::vector<TiedDof>> tied;   // sets of equal displacements, each by rising dof

 private:
  void collect_turned(const Model& model);
  void collect_tied(const Model& model);
  void apply_turned(const std::vector<TurnedFixity>& fixities);
  void settle_turned();
  void settle_tied();

  std::vector<char> in_tie_;  // of each dof; empty = there are no ties
};

// What the supports of a node with turned ones add to its displacement over a stage.  by_xy: what those along x and y add.
// contradiction: rises to the largest difference from the value of a card, where not all directions can have theirs.
Vector2 held_motion(const Stage& stage, const TurnedNode& node, const Vector2& by_xy,
                    double* contradiction = nullptr);

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
