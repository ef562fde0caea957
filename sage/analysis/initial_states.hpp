// Stress, history, laws and drainage that cards give to groups before a run and at the start of a stage.
#pragma once

#include "sage/analysis/assembly.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/model.hpp"
#include "sage/model/water.hpp"

namespace sage {

// Sets the committed stress and history of a group's points.  Stress that a law can't carry is reported as a
// warning in `diagnostics` with the number of points.  above: for cards of InitialKind::at_rest.
void apply_initial_stress(const Model& model, const InitialStress& initial, const PorePressure* water,
                          const Overburden* above, GroupData& data, Diagnostics& diagnostics);

// Sets the history that a card of InitialKind::history states.  Throws InputError where the law refuses it.
void apply_initial_history(const Model& model, const InitialStress& initial, GroupData& data);

// First values that materials state themselves, before any card (MaterialEntry::own_start).
bool has_own_start(const Model& model);
bool has_own_stress(const Model& model, const Group& group);
void apply_own_starts(const Model& model, std::vector<GroupData>& groups);

// All cards of the model or of a stage: stresses, then histories, which count from what the stresses have made.
// water: of the stage, where the model has some: the weights of geostatic cards then are total ones.
// ground: whose weight lies above the points of cards at rest.
struct GroundOfStage {
  int stage = 0;                    // 0-based
  const std::vector<char>& active;  // groups, a flag each
};
void apply_initials(const Model& model, const GroundOfStage& ground, const std::vector<InitialStress>& initials,
                    const PorePressure* water, std::vector<GroupData>& groups, Diagnostics& diagnostics);

// What the water cards of a stage (0-based) change of states: water of undrained groups is shut in, the excess of
// drained ones taken out of their pressure, so that it is let go over the stage.
bool changes_drainage(const Model& model, int stage);
void apply_drainage(const Model& model, int stage, std::vector<GroupData>& groups);

// The laws that come into force in a stage (Group::choices), before its initial stress.
bool chooses_laws(const Model& model, int stage);
void apply_law_choices(const Model& model, int stage, std::vector<GroupData>& groups, Diagnostics& diagnostics);

}  // namespace sage
