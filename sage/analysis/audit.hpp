// Loads and reactions of the whole model against each other.
#pragma once

#include "sage/analysis/observer.hpp"
#include "sage/analysis/records.hpp"

namespace sage {

// Of the committed state.  force_start: internal forces at the start of the stage, every dof, because a stage may end
// without any force.
EquilibriumAudit audit_equilibrium(const Model& model, const Assembly& assembly, const Solution& now,
                                   const Eigen::VectorXd& force_start);

}  // namespace sage
