// What only decks with flow of water can have wrong.
#include <algorithm>

#include "sage/build/builder.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/flow_line.hpp"

namespace sage::build {

namespace {

// In the stage that the report starts with: later ones may take the flow away.
void check_discharges(Builder& b) {
  const Model& model = b.model;
  Activity activity(model);
  for (const Stage& stage : model.stages) {
    activity.enter(stage);
    for (const Report& report : model.reports) {
      if (report.kind != ReportKind::discharge || report.stage + 1 != stage.number) continue;
      const FlowLine line = flow_line(model, activity.group, report.nodes);
      if (!line.fault.empty())
        b.error("S242", report.where, "there is no discharge through this line: " + line.fault);
    }
  }
}

// Nothing but the deck's own weight can hold an element that has no stiffness; a card that gives one is lost.
void note_weights(Builder& b) {
  const bool gravity =
      std::ranges::any_of(b.model.stages, [](const Stage& stage) { return !stage.gravity.isZero(0.0); });
  if (!gravity) return;
  for (const Group& group : b.model.groups)
    if (group.flow() && b.model.material_of(group).unit_weight != 0.0)
      b.warning("S332", group.where,
                "group " + std::to_string(group.number) + " (" + group.element_name +
                    "): the unit weight of its material does nothing: what water flows through has its weight "
                    "from the solids there");
}

// A flag a node: something there moves.
std::vector<bool> moving_nodes(const Model& model) {
  std::vector<bool> moves(static_cast<std::size_t>(model.mesh.nodes()), false);
  for (const Group& group : model.groups)
    if (!group.flow())
      for (const int node : group.nodes) moves[static_cast<std::size_t>(node)] = true;
  return moves;
}

// A support card whose name of the unknown is blank holds displacements, which water does not have.
void warn_of_displacements(Builder& b, const std::vector<bool>& moves, const std::vector<Fixity>& fixities) {
  const int head = find_unknown(b.model.unknowns, "head");
  for (const Fixity& fixity : fixities)
    if (b.dof_map.of(fixity.node, head) >= 0 && !moves[static_cast<std::size_t>(fixity.node)])
      b.warning("S332", {b.model.file, fixity.line, 0, 0},
                "node " + std::to_string(b.model.mesh.number[static_cast<std::size_t>(fixity.node)]) +
                    " has a head and no displacement that the card could hold; a card for heads names them "
                    "(head)");
}

}  // namespace

void check_water(Builder& b) {
  if (find_unknown(b.model.unknowns, "head") >= 0) {
    const std::vector<bool> moves = moving_nodes(b.model);
    warn_of_displacements(b, moves, b.model.fixities);
    for (const Stage& stage : b.model.stages) warn_of_displacements(b, moves, stage.fixities);
  }
  check_discharges(b);
  note_weights(b);
}

}  // namespace sage::build
