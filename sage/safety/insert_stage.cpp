#include "sage/safety/insert_stage.hpp"

#include <algorithm>
#include <utility>

namespace sage::safety {

namespace {

// Laws of later stages stay theirs; bars whose force was held up to here go on with their law in the new stage.
void move_law_choices(Model& model, int inserted) {
  const auto index = static_cast<std::size_t>(inserted);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const auto states_law = [&](const InitialStress& initial) {
      return initial.group == static_cast<int>(g) &&
             (is_about_law(initial.kind) || initial.kind == InitialKind::lock_off);
    };
    const bool own =
        index < model.stages.size() && std::ranges::any_of(model.stages[index].initials, states_law);
    for (LawChoice& choice : model.groups[g].choices)
      if (choice.stage > inserted || (choice.stage == inserted && own)) ++choice.stage;
  }
}

}  // namespace

int chosen_stage(const Model& model, int stage) {
  if (stage >= 0) return stage;
  // Stages with factors of the deck's own are analyses of their own: the first is as good as any.
  return model.stages[0].strength_factor > 0.0 ? 0 : static_cast<int>(model.stages.size()) - 1;
}

int insert_behind(Model& model, int last, Stage stage) {
  const int inserted = last + 1;
  move_law_choices(model, inserted);
  model.stages.insert(model.stages.begin() + inserted, std::move(stage));
  for (WaterCard& card : model.water)
    if (card.stage >= inserted) ++card.stage;
  return inserted;
}

}  // namespace sage::safety
