// Elements of large strain that turn inside out.
#pragma once

#include <string>

#include "sage/analysis/assembly.hpp"

namespace sage {

// Lines of a page about a step that failed: which element folds, at which corner, and what helps.  u: unknowns of the last
// equilibrium; du: what the failed attempt added.  Empty where no element is near to that.
std::string fold_lines(const Model& model, const Assembly& assembly, const Eigen::VectorXd& u,
                       const Eigen::VectorXd& du);

}  // namespace sage
