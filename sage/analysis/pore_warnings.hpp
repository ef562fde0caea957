// What a reader should know about excess pressures of pore water.
#pragma once

#include <vector>

#include "sage/analysis/assembly.hpp"

namespace sage {

// Parts of the model that water flows in, and where none may leave.
// exits: nodes where it may under conditions.
std::vector<Diagnostic> closed_part_warnings(const Model& model, const Stage& stage, const Activity& activity,
                                             const std::vector<int>& exits);

// Elements beside supports that take their pressure at the start of a stage, in which a step of that length lies below
// h^2 / (6 theta c).  jump: of the supports' pressures, one entry per dof.
std::vector<Diagnostic> short_step_warnings(const Model& model, const Stage& stage, const Assembly& assembly,
                                            const Eigen::VectorXd& jump, double dt);

// Neighbouring corners of which one has a larger pressure than all around it, the other a smaller one.
std::vector<Diagnostic> oscillation_warnings(const Model& model, const Stage& stage, int increment,
                                             const Assembly& assembly, const Eigen::VectorXd& u);

}  // namespace sage
