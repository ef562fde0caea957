// Loads and displacements for nodes that no active element has in their stage: they do nothing there.  Reports
// of such nodes say nothing.
#include <algorithm>
#include <map>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/model/active_dofs.hpp"

namespace sage::builder {

namespace {

// Nodes or elements of one card.
struct Idle {
  int first = 0, count = 0;
};
using IdleCards = std::map<int, Idle>;  // by line

void add(IdleCards& idle, int line, int number) {
  ++idle.try_emplace(line, Idle{number, 0}).first->second.count;
}

// One message a card: the first, and how many more.
void tell(Builder& b, const IdleCards& idle, const Stage& stage, const std::string& what,
          const std::string& why) {
  for (const auto& [line, card] : idle) {
    std::string text = what + " " + std::to_string(card.first);
    if (card.count > 1) text += " (and " + std::to_string(card.count - 1) + " more)";
    b.warning("S332", b.at_line(line),
              text + " of stage " + std::to_string(stage.number) + " does nothing: " + why);
  }
}

// Values and loads of an unknown that no active element solves for at the node.
void check_unknowns(Builder& b, const Stage& stage, const Activity& activity) {
  if (stage.field_fixities.empty() && stage.field_loads.empty()) return;
  const std::vector<char> active = active_dofs(b.model, activity);
  for (std::size_t field = 1; field < b.model.unknowns.size(); ++field) {
    const auto idle = [&](const auto& card) {
      const int dof = activity.dof_map.of(card.node, card.field);
      return card.field == static_cast<int>(field) && card.value != 0.0 && dof >= 0 && active[dof] == 0;
    };
    const auto number_of = [&](int node) { return b.model.mesh.number[node]; };
    IdleCards values, loads;
    for (const FieldFixity& f : stage.field_fixities)
      if (idle(f) && f.code == FixityCode::fixed) add(values, f.line, number_of(f.node));
    for (const FieldLoad& load : stage.field_loads)
      if (idle(load)) add(loads, load.line, number_of(load.node));
    const UnknownField& unknown = b.model.unknowns[field];
    const std::string why = "no element that is active then solves for the " + unknown.name + " there";
    tell(b, values, stage, "the " + unknown.name + " of node", why);
    tell(b, loads, stage, "the " + unknown.load + " of node", why);
  }
}

}  // namespace

void check_inactive(Builder& b) {
  const Model& model = b.model;
  Activity activity(model);
  std::set<std::size_t> reported;  // reports
  for (const Stage& stage : model.stages) {
    activity.enter(stage);
    const std::vector<char> active = active_nodes(model, activity);
    const auto number_of = [&](int node) { return model.mesh.number[node]; };
    const auto idle_node = [&](int node) { return active[node] == 0; };
    IdleCards loads, displacements, pressures;
    for (const NodalLoad& load : stage.loads)
      if (idle_node(load.node) && !load.force.isZero(0.0)) add(loads, load.line, number_of(load.node));
    std::vector<Fixity> fixities = stage.fixities;
    fixities.insert(fixities.end(), stage.turned_fixities.begin(), stage.turned_fixities.end());
    for (const Fixity& f : fixities) {
      const auto moves = [&](std::size_t c) { return f.code[c] == FixityCode::fixed && f.value[c] != 0.0; };
      if (idle_node(f.node) && (moves(0) || moves(1))) add(displacements, f.line, number_of(f.node));
    }
    for (const EdgeLoad& load : stage.pressures) {
      const auto group = static_cast<std::size_t>(load.group);
      if (!activity.group[group]) add(pressures, load.line, model.groups[group].element_numbers[load.element]);
    }
    for (std::size_t i = 0; i < model.reports.size(); ++i) {
      const Report& report = model.reports[i];
      if (report.kind == ReportKind::point || report.kind == ReportKind::section ||
          stage.number <= report.stage || !std::all_of(report.nodes.begin(), report.nodes.end(), idle_node) ||
          !reported.insert(i).second)
        continue;
      b.warning("S332", report.where,
                "stage " + std::to_string(stage.number) +
                    ": no element that is active then has a node "
                    "of this report: it shows the displacements of before and no force");
    }
    check_unknowns(b, stage, activity);
    tell(b, loads, stage, "the load of node", "no element that is active then has the node");
    tell(b, displacements, stage, "the displacement of node", "no element that is active then has the node");
    tell(b, pressures, stage, "the pressure on element", "its group is not active then");
  }
}

}  // namespace sage::builder
