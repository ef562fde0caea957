// External loads, prescribed displacements and forces of water as nodal vectors.
#pragma once

#include "sage/model/activity.hpp"
#include "sage/model/model.hpp"
#include "sage/model/water.hpp"

namespace sage {

// All loads that act at the end of stage `last` (0-based): nodal loads, edge loads and body forces of the
// stages up to it.  A load acts as long as the group that carries it: not where that is not active in the load's own
// stage, nor, once it was removed, on what is activated there later.  One entry per dof, axes (x, y).
Eigen::VectorXd external_force(const Model& model, int last);

// Weight of groups (one flag each) under gravity, in multiples of the materials' unit weight; stage (0-based): whose phreatic
// lines say what is saturated.  One entry per dof.
Eigen::VectorXd weight_of(const Model& model, const std::vector<char>& groups, const Vector2& gravity,
                          int stage);

// Nodal and edge loads that a stage (0-based) itself adds to what is active in it.  One entry per dof.
Eigen::VectorXd stage_loads(const Model& model, int stage, const Activity& activity);

// What loads on nodes and edges with a table of time differ at a load factor from loads that grow in proportion to it.
Eigen::VectorXd table_loads(const Model& model, int stage, const Activity& activity, double load_factor);

// Displacement that each prescribed dof gets over a stage.
Eigen::VectorXd prescribed_rate(const Stage& stage, const DofMap& map);
// The same of nodes with turned supports and of dofs that are tied to moved ones, in place of what `rate` has there.
// activity: of the stage.
void add_turned_rate(const Stage& stage, const Activity& activity, Eigen::VectorXd& rate);
// Values of supports of the field at the start of a stage, one entry per dof: sums of those of the stages before, from the
// last one that released it.  Meant for fields whose supports have their own value (UnknownField::of_pores).
Eigen::VectorXd supported_values(const Model& model, int stage, const DofMap& map);

// Force of the water at the end of a stage, one entry per dof; zero without water cards.
Eigen::VectorXd water_of(const Model& model, const Activity& activity, const PorePressure* water);

}  // namespace sage
