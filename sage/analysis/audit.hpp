// Loads and reactions of the whole model against each other.
#pragma once

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/records.hpp"

namespace sage {

// Of the committed state.  external: loads now; force_start: internal forces at the start of the stage, because
// a stage may end without any force; u: unknowns.  All have one entry per dof.
EquilibriumAudit audit_equilibrium(const Model& model, const Assembly& assembly,
                                   const Eigen::VectorXd& external, const Eigen::VectorXd& force_start,
                                   const Eigen::VectorXd& u);

}  // namespace sage
