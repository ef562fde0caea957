// Pore pressure in solids and the water that stands on them: what the water cards say of a stage, as numbers at
// places.  docs/theory/effective_stress.md
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "sage/model/activity.hpp"

namespace sage {

// The card that holds for a group's pore pressure in a stage (0-based): the last of the deck that is about the
// group or about all and begins no later.  nullptr = dry.
const WaterCard* water_card(const Model& model, int stage, int group);

// The phreatic line from before a drawdown of the group (a card of that kind); nullptr = it had another kind of water.
const WaterCard* line_before(const Model& model, const WaterCard& drawdown, int group);

// The group is undrained in a stage (0-based): its water can't leave.
bool is_undrained(const Model& model, int stage, int group);

// Of the way from an element's first node to its second.
enum class WaterSide { left, right };
// The card that holds for the free water on a side of a group of structures: the last of the deck that is about that
// very group and that side.  nullptr = none stands there.
const WaterCard* water_card(const Model& model, int stage, int group, WaterSide side);

// u of solids, compression positive, at the end of a stage; never negative (no suction).
class PorePressure {
 public:
  // groups: a flag each, active.  unknowns: what heads are taken from (one entry a dof); nullptr = there are none
  // yet, and groups that want heads are dry.  The model must outlive it.
  PorePressure(const Model& model, int stage, const std::vector<char>& groups, const DofMap& map,
               const Eigen::VectorXd* unknowns);

  bool any() const;
  // nullptr where the group is dry, no solid or not active.
  const WaterCard* card(std::size_t group) const { return cards_[group]; }
  int stage() const { return stage_; }

  // At a place of an element, with its shape functions there.
  double at(std::size_t group, int element, const Vector2& place, std::span<const double> N) const;
  // Gradient there; dN: of the shape functions along x and y, one row a node.  Zero where u is.
  Vector2 gradient(std::size_t group, int element, const Vector2& place, std::span<const double> N,
                   const Eigen::MatrixX2d& dN) const;
  // Of the water outside, on a free edge there.
  double outside(std::size_t group, int element, const Vector2& place, std::span<const double> N) const;
  // At an integration point.
  double at_point(std::size_t group, int element, int point) const;

 private:
  // Of a drawdown: the line from before, the ground at its end, and the share of the fall that the pressure follows.
  struct Fall {
    const WaterCard* before = nullptr;
    std::shared_ptr<const class Overburden> ground;
    double share = 0.0;
  };

  Fall fall_of(const WaterCard& card, int group) const;
  double nodal(std::size_t group, int element, std::span<const double> N) const;
  double below(const WaterCard& line, const Vector2& place) const;
  double drawn_down(std::size_t group, int element, const Vector2& place) const;
  void take_nodes(const WaterCard& card, std::size_t group);
  void take_heads(std::size_t group, const DofMap& map, const Eigen::VectorXd* unknowns);
  void fill_middles(std::size_t group);

  const Model* model_;
  int stage_;
  std::vector<char> groups_;
  std::vector<const WaterCard*> cards_;
  std::vector<Fall> falls_;                 // by group
  bool beside_ = false;                     // free water stands on structures
  std::vector<std::vector<double>> nodes_;  // by group: u of every node of the mesh, of cards about nodes
  std::shared_ptr<const class Overburden> overburden_;
};

// Weight of the solids of active groups above places: vertical lines through their corners' polygons.
class Overburden {
 public:
  // As in a stage (0-based), whose phreatic lines say what is saturated.
  Overburden(const Model& model, const std::vector<char>& groups, int stage);
  struct Above {
    double stress = 0.0;  // unit weights times heights
    double top = 0.0;     // level of the uppermost solid
  };
  Above above(const Vector2& place) const;

 private:
  struct Cell {
    std::vector<Vector2> corners;
    double unit_weight = 0.0, saturation = 0.0;
    const WaterCard* line = nullptr;
  };
  std::vector<Cell> cells_;
  std::vector<std::vector<int>> bins_;  // cells by x
  double low_ = 0.0, width_ = 1.0;
};

// Level of a phreatic line at x: linear between its points, level beyond the first and the last.
double water_level(const WaterCard& card, double x);
// The same where the card puts free water on the ground; else far below.
double free_level(const WaterCard& card, double x);

// What water does to the mesh at the end of a stage, one entry a dof: its pressure in the solids (sum of B^T u),
// and on their free edges and in their joints, and on free sides of structures that have a card; or, of cards that say
// so, seepage force and buoyancy (-grad u).
// Shape functions are taken as they are, without B-bar, by a rule that is exact on straight-sided elements.
Eigen::VectorXd water_force(const Model& model, const Activity& activity, const PorePressure& water);

// An edge of an active structure, and on which sides neither an active solid nor a joint to one lies: water can stand
// there.  wet: pore pressure stands in a solid that lies on one.
struct BesideStructure {
  int group = 0, element = 0;
  bool left = true, right = true, wet = false;
};
std::vector<BesideStructure> structures_beside_water(const Model& model, int stage,
                                                     const std::vector<char>& groups);

// add(group, element, f): free water on the sides of active structures at the end of a stage, of one group or of all
// (-1); f: a force a dof.  It is spread along the element, as a pressure on its edge is.  Where wet soil lies on the
// other side, whose water acts at the nodes alone, so does the free one: equal water on both sides adds up to nothing.
using AddWater = std::function<void(int group, int element, std::span<const double> f)>;
void water_on_structures(const Model& model, int stage, const std::vector<char>& groups, int group,
                         const AddWater& add);

// Edges of active solids that no other active solid shares, by group, element and edge.
struct FreeEdge {
  int group = 0, element = 0, edge = 0;
  bool on_structure = false;  // a bar or beam lies along it
};
std::vector<FreeEdge> free_edges(const Model& model, const std::vector<char>& groups);

}  // namespace sage
