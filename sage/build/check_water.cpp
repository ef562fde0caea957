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

}  // namespace

void check_water(Builder& b) {
  check_discharges(b);
  note_weights(b);
}

}  // namespace sage::build
