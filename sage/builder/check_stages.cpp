// Cards of stages that contradict each other, or that can't act where they are.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"

namespace sage::builder {

namespace {

std::string node_name(const Builder& b, int node) {
  return "node " + std::to_string(b.model.mesh.number[node]);
}

// A card's word on one unknown of one node.
struct Support {
  int node, unknown;  // 0 and 1: displacement in x and y; then the other fields
  FixityCode code;
  double value;
  int line;
};

std::vector<Support> supports_of(const Stage& stage) {
  std::vector<Support> list;
  for (const Fixity& f : stage.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      list.push_back({f.node, static_cast<int>(c), f.code[c], f.value[c], f.line});
  for (const FieldFixity& f : stage.field_fixities)
    list.push_back({f.node, 1 + f.field, f.code, f.value, f.line});
  return list;
}

// Of several cards for a dof the last stands; where they differ, one of them is a mistake.
void warn_contradictions(Builder& b, const Stage& stage) {
  std::map<std::pair<int, int>, Support> seen;
  std::set<std::pair<int, int>> reported;  // lines
  for (const Support& f : supports_of(stage)) {
    if (f.node >= b.model.mesh.deck_nodes || f.code == FixityCode::unchanged) continue;  // made nodes inherit
    const auto [it, is_new] = seen.try_emplace({f.node, f.unknown}, f);
    const Support before = std::exchange(it->second, f);
    if (is_new || (before.code == f.code && before.value == f.value)) continue;
    if (!reported.insert({before.line, f.line}).second) continue;
    const bool moved = f.unknown < 2;
    const std::string field = moved ? "" : b.model.unknowns[static_cast<std::size_t>(f.unknown) - 1].name;
    const std::string direction = moved ? (f.unknown == 0 ? " in x" : " in y") : " in " + field;
    const std::string other = "line " + std::to_string(before.line);
    const std::string name = "stage " + std::to_string(stage.number) + ": " + node_name(b, f.node);
    if (before.code == f.code)
      b.warning("S320", b.at_line(f.line),
                name + " is given two " + (moved ? "displacements" : "values") + direction + ": " +
                    rounded_text(before.value) + " by " + other + ", " + rounded_text(f.value) +
                    " here; the last card stands");
    else
      b.warning("S320", b.at_line(f.line),
                name + " is " + (f.code == FixityCode::released ? "released" : "held") + direction +
                    " here but " + (f.code == FixityCode::released ? "held" : "released") + " by " + other +
                    " of the same stage; the last card stands");
  }
}

// Directions that are held together may not have values that no displacement has.
void check_turned(Builder& b, const Stage& stage, const Activity& activity) {
  constexpr double kSame = 1e-6;
  for (const TurnedNode& node : activity.turned) {
    Vector2 by_xy = Vector2::Zero();
    double largest = 0.0, contradiction = 0.0;
    int line = 0;
    const auto take = [&](const Fixity& f, Vector2* to) {
      if (f.node != node.node) return;
      line = std::max(line, f.line);
      for (std::size_t c = 0; c < 2; ++c) {
        if (f.code[c] != FixityCode::fixed) continue;
        largest = std::max(largest, std::abs(f.value[c]));
        if (to != nullptr) (*to)[static_cast<Eigen::Index>(c)] = f.value[c];
      }
    };
    for (const Fixity& f : stage.fixities) take(f, &by_xy);
    for (const TurnedFixity& f : stage.turned_fixities) take(f, nullptr);
    if (largest == 0.0) continue;
    held_motion(stage, node, by_xy, &contradiction);
    if (contradiction > kSame * largest)
      b.error("S368", b.at_line(line),
              "stage " + std::to_string(stage.number) + ": " + node_name(b, node.node) +
                  " is held in more than two directions, and no displacement has all of their values");
  }
}

void check_ties(Builder& b, const Activity& activity) {
  int last_line = 0;  // one message a card
  for (const Tie& tie : b.model.ties)
    for (const int node : {tie.node, tie.to})
      if (tie.line != last_line && activity.turned_at(node) != nullptr) {
        last_line = tie.line;
        b.error("S370", b.at_line(tie.line), node_name(b, node) + " is tied and has a support at an angle");
      }
}

// Supports of one tie that move differently in a stage.
void check_tied_values(Builder& b, const Stage& stage, const Activity& activity) {
  struct Moved {
    double value = 0.0;
    const TimeTable* history = nullptr;
    int line = 0;
  };
  std::map<int, Moved> moved;  // by dof; those that stand still have no entry
  for (const Fixity& f : stage.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed && f.value[c] != 0.0)
        moved[DofMap::displacement(f.node, static_cast<int>(c))] = {f.value[c], &f.history, f.line};
  for (const std::vector<TiedDof>& set : activity.tied) {
    std::vector<std::pair<int, Moved>> supports;
    for (const TiedDof& one : set)
      if (one.supported) supports.emplace_back(one.dof, moved.contains(one.dof) ? moved.at(one.dof) : Moved());
    const auto differs = [&](const std::pair<int, Moved>& one) {
      const Moved &a = supports.front().second, &z = one.second;
      return a.value != z.value || (a.value != 0.0 && *a.history != *z.history);
    };
    const auto other = std::ranges::find_if(supports, differs);
    if (other == supports.end()) continue;
    b.error("S370", b.at_line(std::max(supports.front().second.line, other->second.line)),
            "stage " + std::to_string(stage.number) + ": " + node_name(b, supports.front().first / 2) +
                " and " + node_name(b, other->first / 2) +
                " are tied, but their supports move them differently");
  }
}

void check_combined_dofs(Builder& b) {
  Activity activity(b.model);
  check_ties(b, activity);
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    check_turned(b, stage, activity);
    check_tied_values(b, stage, activity);
  }
}

// Where r = 0, u_r = 0 and a circle has no length.
class Axis {
 public:
  explicit Axis(const Builder& b)
      : mesh_(b.model.mesh), reach_(1e-12 * b.model.mesh.x.row(0).cwiseAbs().maxCoeff()) {}
  bool holds(int node) const { return std::abs(mesh_.x(0, node)) <= reach_; }
  bool holds(const Group& group, const EdgeLoad& load) const {
    const std::vector<int>& edge = group.element->edges()[load.edge];
    const int* nodes = group.nodes_of(load.element);
    return holds(nodes[edge[0]]) && holds(nodes[edge[1]]);
  }

 private:
  const Mesh& mesh_;
  double reach_;
};

void check_axis(Builder& b, const Stage& stage) {
  const Axis axis(b);
  int last_line = 0;  // one message a card
  for (const Fixity& f : stage.fixities) {
    const bool moved = f.code[0] == FixityCode::fixed && f.value[0] != 0.0;
    const bool released = f.code[0] == FixityCode::released;
    if (f.line == last_line || !(moved || released) || !axis.holds(f.node)) continue;
    last_line = f.line;
    b.error("S244", b.at_line(f.line),
            node_name(b, f.node) + " lies on the axis r = 0, where u_r = 0 by symmetry: it can't be " +
                (moved ? "displaced radially" : "released radially"));
  }
  for (const NodalLoad& load : stage.loads) {
    if (load.line == last_line || load.force.x() == 0.0 || !axis.holds(load.node)) continue;
    last_line = load.line;
    b.warning("S321", b.at_line(load.line),
              "the radial force on " + node_name(b, load.node) +
                  " has no effect: it acts on the axis r = 0, where u_r = 0");
  }
  for (const EdgeLoad& load : stage.pressures) {
    const Group& group = b.model.groups[load.group];
    if (load.line == last_line || !axis.holds(group, load)) continue;
    last_line = load.line;
    b.warning("S321", b.at_line(load.line),
              "the pressure has no effect: its edge lies on the axis r = 0 and has no area");
  }
}

bool any_element(const Model& model, const Activity& activity) {
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (activity.group[g] && model.groups[g].elements() > 0) return true;
  return false;
}

void check_left(Builder& b) {
  Activity activity(b.model);
  for (const Stage& stage : b.model.stages) {
    activity.enter(stage);
    if (any_element(b.model, activity)) continue;
    b.error("S322", stage.where,
            "stage " + std::to_string(stage.number) +
                ": no element takes part: every group is removed or not yet born");
    return;
  }
}

}  // namespace

void check_stages(Builder& b) {
  if (b.model.combines_dofs()) check_combined_dofs(b);
  for (const Stage& stage : b.model.stages) {
    warn_contradictions(b, stage);
    if (b.model.geometry == Geometry::axisymmetric) check_axis(b, stage);
  }
  if (b.problems.errors() == 0) check_left(b);
}

}  // namespace sage::builder
