// The page that a person gets when a step fails: where, what, and what to try.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/newton.hpp"
#include "sage/analysis/observer.hpp"

namespace sage {

// A step whose matrix is singular: which node and dof, what kind of motion is free, and what to try.
std::string explain_singular(const Model& model, const Activity& activity, const Assembly& assembly,
                             const StepReport& report, const NewtonStep& step);

// A part that hangs on interfaces which are open at all their points in the committed state, and that nothing
// else holds; empty = there is none.
std::string explain_loose_part(const Model& model, const Activity& activity, const Assembly& assembly);

// A step that did not converge even after all cuts.
std::string explain_failure(const Model& model, const Assembly& assembly, const StepReport& report,
                            const NewtonStep& step);

// easing: how many times wider the fall of the permeability was taken in vain; from: where there were heads, 0 = never.
std::string lost_free_surface(const Stage& stage, double easing, double from);

// Exits of water that are switched to and fro.  switched: their nodes, last.
std::string chattering_exits(const Model& model, const Stage& stage, const std::vector<int>& switched,
                             int rounds);

// "0.001234", four digits.
std::string short_number(double value);

// "node 12, direction y" (r, z when axisymmetric)
std::string unknown_name(const Model& model, const DofMap::Unknown& unknown);

}  // namespace sage
