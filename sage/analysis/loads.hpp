// External loads and initial stress as nodal vectors and point states.
#pragma once

#include "sage/analysis/assembly.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/model.hpp"
#include "sage/model/water.hpp"

namespace sage {

// All loads that act at the end of stage `last` (0-based): nodal loads, edge loads and body forces of the
// stages up to it.  A load acts as long as the group that carries it: not where that is not active in the load's own
// stage, nor, once it was removed, on what is activated there later.  One entry per dof, axes (x, y).
Eigen::VectorXd external_force(const Model& model, int last);

// Of a group whose loads on edges follow its motion (ElementTraits::large_strain): the sums of these loads, by element.
// stage: 0-based.
std::vector<FollowedEdge> followed_edges(const Model& model, int stage, int group);

// Weight of groups (one flag each) under gravity, in multiples of the materials' unit weight.  One entry per dof.
Eigen::VectorXd weight_of(const Model& model, const std::vector<char>& groups, const Vector2& gravity);

// Nodal and edge loads that a stage (0-based) itself adds to what is active in it.  One entry per dof.
Eigen::VectorXd stage_loads(const Model& model, int stage, const Activity& activity);

// Displacement that each prescribed dof gets over a stage.
Eigen::VectorXd prescribed_rate(const Stage& stage, const DofMap& map);
// Values of supports of the field at the start of a stage, one entry per dof: sums of those of the stages before, from the
// last one that released it.  Meant for fields whose supports have their own value (UnknownField::of_pores).
Eigen::VectorXd supported_values(const Model& model, int stage, const DofMap& map);

// Sets the committed stress and history of a group's points.  Stress that a law can't carry is reported as a
// warning in `diagnostics` with the number of points.
void apply_initial_stress(const Model& model, const InitialStress& initial, const PorePressure* water,
                          GroupData& data, Diagnostics& diagnostics);

// Sets the history that a card of InitialKind::history states.  Throws InputError where the law refuses it.
void apply_initial_history(const Model& model, const InitialStress& initial, GroupData& data);

// First values that materials state themselves, before any card (MaterialEntry::own_start).
bool has_own_start(const Model& model);
bool has_own_stress(const Model& model, const Group& group);
void apply_own_starts(const Model& model, std::vector<GroupData>& groups);

// All cards of the model or of a stage: stresses, then histories, which count from what the stresses have made.
// water: of the stage, where the model has some: the weights of geostatic cards then are total ones.
void apply_initials(const Model& model, const std::vector<InitialStress>& initials, const PorePressure* water,
                    std::vector<GroupData>& groups, Diagnostics& diagnostics);

// What the water cards of a stage (0-based) change of states: water of undrained groups is shut in, the excess of
// drained ones taken out of their pressure, so that it is let go over the stage.
bool changes_drainage(const Model& model, int stage);
void apply_drainage(const Model& model, int stage, std::vector<GroupData>& groups);

// Force of the water at the end of a stage, one entry per dof; zero without water cards.
Eigen::VectorXd water_of(const Model& model, const Activity& activity, const PorePressure* water);

// The laws that come into force in a stage (Group::choices), before its initial stress.
bool chooses_laws(const Model& model, int stage);
void apply_law_choices(const Model& model, int stage, std::vector<GroupData>& groups, Diagnostics& diagnostics);

}  // namespace sage
