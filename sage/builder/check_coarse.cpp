// Ground with a strength that is pushed over part of a side, a footing: whether the mesh can tell its collapse load.  From
// the spacing of nodes under the pushed part, as measured on strips of known collapse load (docs/theory/accuracy.md).
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"

namespace sage::builder {

namespace {

// NodeSpacing of nodes over half the width of the pushed part, from which on the collapse load is 5 to 20 % too large: at the
// end of what is moved, where the stress is singular, and on average under a pressure, where it is not.
constexpr double kCoarseAtEnd = 0.02, kCoarseOnAverage = 0.3;
// What a finer mesh does for four-node elements that lock, whatever nu is, once the ground flows without volume change.
constexpr double kLocking = 50.0;
constexpr double kStraight = 30.0;  // degrees that a straight side may turn at a node

enum class Push { none, moved, pressed };

// A side of the active solids, counter-clockwise: the body is to the left.
struct GroundSide {
  int from = 0, to = 0;
  int group = 0, local = 0;
  Push push = Push::none;
  int line = 0;  // of the card that pushes
};

bool can_fail(const Material& material) {
  if (std::visit([](const auto* law) { return law->traits().linear; }, material.law_ref())) return false;
  // Of a user material nobody knows which of its properties is a strength.
  return material.parameter(ParameterRole::strength) || material.parameter(ParameterRole::friction_angle) ||
         (material.entry != nullptr && material.entry->open_ended);
}

// A part of the outline that is pushed in one way, from end to end.
struct Footing {
  std::vector<const GroundSide*> sides;
  bool ends_before = false, ends_behind = false;  // the side goes on straight and free there
};

class GroundOutline {
 public:
  GroundOutline(Builder& b, const Stage& stage, const Activity& activity);
  std::vector<Footing> footings() const;
  bool pushed() const { return pushed_; }

 private:
  void gather(Builder& b);
  void push(const Stage& stage);
  const GroundSide* before(const GroundSide& side) const { return only(arriving_, side.from); }
  const GroundSide* behind(const GroundSide& side) const { return only(leaving_, side.to); }
  // Two bodies may touch at a node: then nothing goes on there.
  const GroundSide* only(const std::multimap<int, std::size_t>& by_node, int node) const {
    const auto [first, last] = by_node.equal_range(node);
    return first != last && std::next(first) == last ? &sides_[first->second] : nullptr;
  }
  bool goes_on_free(const GroundSide& side, const GroundSide* next) const;
  Vector2 along(const GroundSide& side) const {
    return model_.mesh.x.col(side.to) - model_.mesh.x.col(side.from);
  }

  const Model& model_;
  const Activity& activity_;
  std::vector<GroundSide> sides_;
  std::multimap<int, std::size_t> leaving_, arriving_;
  bool pushed_ = false;
};

GroundOutline::GroundOutline(Builder& b, const Stage& stage, const Activity& activity)
    : model_(b.model), activity_(activity) {
  gather(b);
  push(stage);
}

// Edges that one active solid has alone.
void GroundOutline::gather(Builder& b) {
  const SolidEdges& solids = b.solid_edges();
  for (int node = 0; node < model_.mesh.nodes(); ++node) {
    const auto edges = solids.at(node);
    for (std::size_t i = 0; i < edges.size();) {
      std::size_t end = i;
      int active = 0;
      const SolidEdge* own = nullptr;
      for (; end < edges.size() && edges[end].other == edges[i].other; ++end)
        if (activity_.group[edges[end].group]) ++active, own = &edges[end];
      if (active == 1)
        sides_.push_back({own->reversed ? own->other : node, own->reversed ? node : own->other, own->group,
                          own->local, Push::none, 0});
      i = end;
    }
  }
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    leaving_.emplace(sides_[i].from, i);
    arriving_.emplace(sides_[i].to, i);
  }
}

void GroundOutline::push(const Stage& stage) {
  std::map<int, const Fixity*> moved;
  for (const Fixity& f : stage.fixities)
    if (f.value[0] != 0.0 || f.value[1] != 0.0) moved[f.node] = &f;
  std::map<std::pair<int, int>, const EdgeLoad*> pressed;
  for (const EdgeLoad& load : stage.pressures) {
    if (load.normal.sum() <= 0.0) continue;
    const Group& group = model_.groups[load.group];
    const std::vector<int>& edge = group.element->edges()[load.edge];
    const int* nodes = group.nodes_of(load.element);
    pressed[{nodes[edge[0]], nodes[edge[1]]}] = &load;
  }
  for (GroundSide& side : sides_) {
    const Group& group = model_.groups[side.group];
    if (!can_fail(model_.material_of(group))) continue;
    const auto from = moved.find(side.from), to = moved.find(side.to);
    if (from != moved.end() && to != moved.end()) {
      const Vector2 outward(along(side).y(), -along(side).x());
      const Vector2 motion(from->second->value[0] + to->second->value[0],
                           from->second->value[1] + to->second->value[1]);
      if (outward.dot(motion) < 0.0) side.push = Push::moved, side.line = from->second->line;
    } else if (const auto load = pressed.find({side.from, side.to}); load != pressed.end()) {
      side.push = Push::pressed;
      side.line = load->second->line;
    }
    pushed_ = pushed_ || side.push != Push::none;
  }
}

// Where next, the side beside the end of a pushed one, is free ground in line with it.
bool GroundOutline::goes_on_free(const GroundSide& side, const GroundSide* next) const {
  if (next == nullptr || next->push != Push::none) return false;
  const Vector2 a = along(side), z = along(*next);
  if (a.dot(z) < std::cos(kStraight * kRadiansPerDegree) * a.norm() * z.norm()) return false;
  const int far = next->from == side.to ? next->to : next->from;
  return !activity_.holds(far, std::abs(a.x()) >= std::abs(a.y()) ? 1 : 0);  // across the side
}

std::vector<Footing> GroundOutline::footings() const {
  std::vector<Footing> found;
  for (const GroundSide& first : sides_) {
    if (first.push == Push::none) continue;
    const GroundSide* previous = before(first);
    if (previous != nullptr && previous->push == first.push) continue;  // not the first of its footing
    Footing footing;
    footing.ends_before = goes_on_free(first, previous);
    const GroundSide* side = &first;
    while (side != nullptr && side->push == first.push && footing.sides.size() <= sides_.size()) {
      footing.sides.push_back(side);
      side = behind(*side);
    }
    footing.ends_behind = goes_on_free(*footing.sides.back(), side);
    if (footing.ends_before || footing.ends_behind) found.push_back(footing);
  }
  return found;
}

struct NodeSpacing {
  double over_half_width = 0.0;
  bool locks = false;
  int node = 0;  // at the end
  int line = 0;
};

// Length of a side divided by the degree of its element.
double spacing_of(const Model& model, const GroundSide& side) {
  const Group& group = model.groups[side.group];
  const double length = (model.mesh.x.col(side.to) - model.mesh.x.col(side.from)).norm();
  return length / static_cast<double>(group.element->edges()[side.local].size() - 1);
}

NodeSpacing spacing_of(const Model& model, const Footing& footing) {
  double length = 0.0, mean = 0.0;
  bool locks = false;
  for (const GroundSide* side : footing.sides) {
    const Group& group = model.groups[side->group];
    length += (model.mesh.x.col(side->to) - model.mesh.x.col(side->from)).norm();
    mean += spacing_of(model, *side) / static_cast<double>(footing.sides.size());
    const bool linear = group.element->edges()[side->local].size() == 2;
    locks = locks || (linear && group.element->traits().locks);
  }
  const double half = length / (footing.ends_before && footing.ends_behind ? 2.0 : 1.0);
  const GroundSide *first = footing.sides.front(), *last = footing.sides.back();
  const double before = footing.ends_before ? spacing_of(model, *first) : 0.0;
  const double behind = footing.ends_behind ? spacing_of(model, *last) : 0.0;
  const bool moved = first->push == Push::moved;
  return {(moved ? std::max(before, behind) : mean) / half, locks, behind >= before ? last->to : first->from,
          behind >= before ? last->line : first->line};
}

void warn_coarse(Builder& b, const Stage& stage, bool moved, const NodeSpacing& spacing) {
  const std::string node = std::to_string(b.model.mesh.number[spacing.node]);
  std::string message = "stage " + std::to_string(stage.number) +
                        ": the mesh is too coarse for a collapse load. Under the part of the side that is " +
                        (moved ? "moved" : "loaded") + " and ends at node " + node + ", nodes are " +
                        rounded_text(spacing.over_half_width, 2) + " of its half width apart" +
                        (moved ? " at the end" : "");
  if (spacing.locks)
    message +=
        ", and the elements lock where the ground flows: loads are 10 % and more too large; quad4 "
        "enhanced or 8-node quadrilaterals (reduced) do not";
  else
    message += moved ? ": loads are 5 to 20 % too large; 0.005 leaves about 2 %"
                     : ": loads are 10 % and more too large";
  b.warning("S334", b.at_line(spacing.line),
            message + (moved ? "; smaller elements towards that node, or --refine, and docs/manual/accuracy.md"
                             : "; --refine, and docs/manual/accuracy.md"));
}

bool pushes_ground(const Stage& stage) {
  for (const EdgeLoad& load : stage.pressures)
    if (load.normal.sum() > 0.0) return true;
  for (const Fixity& f : stage.fixities)
    if (f.value[0] != 0.0 || f.value[1] != 0.0) return true;
  return false;
}

}  // namespace

void check_coarse(Builder& b) {
  bool any = false;
  for (const Group& group : b.model.groups)
    any = any || (group.solid() && can_fail(b.model.material_of(group)));
  if (!any) return;
  Activity activity(b.model);
  std::set<int> named;  // end nodes: later stages may push on
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    if (!pushes_ground(stage)) continue;
    const GroundOutline outline(b, stage, activity);
    if (!outline.pushed()) continue;
    for (const Footing& footing : outline.footings()) {
      const bool moved = footing.sides.front()->push == Push::moved;
      const NodeSpacing spacing = spacing_of(b.model, footing);
      const double counts = spacing.over_half_width * (spacing.locks ? kLocking : 1.0);
      if (counts > (moved ? kCoarseAtEnd : kCoarseOnAverage) && named.insert(spacing.node).second)
        warn_coarse(b, stage, moved, spacing);
    }
  }
}

}  // namespace sage::builder
