// Initial stress against what it should be in balance with.
#pragma once

#include <cmath>
#include <string>

#include "sage/model/activity.hpp"
#include "sage/model/model.hpp"

namespace sage {

// From this share of the largest force that it puts on a node an initial stress counts as unbalanced.
inline constexpr double kUnbalancedStress = 1e-3;

// Where the forces of an initial stress are farthest from balance.
struct InitialImbalance {
  int dof = -1;          // a displacement; -1: no group starts with stress in this stage
  double force = 0.0;    // what nothing balances there, along +x (r) or +y (z)
  double largest = 0.0;  // force that the initial stress puts on a node, supports included
  bool counts() const { return dof >= 0 && std::abs(force) > kUnbalancedStress * largest; }
};

// At the start of a stage (0-based), for the groups that start with stress in it.  internal: forces of
// the stress, external: loads at the stage's end, both every dof.  The weight of all groups must be
// balanced; a load that the stage itself adds may be (the stress of a cell pressure) or not (a load on
// ground at rest).  Nodes that the stage releases, takes groups away from or builds on are left out:
// their forces are let go on purpose.
InitialImbalance initial_imbalance(const Model& model, const Activity& activity, int stage,
                                   const Eigen::VectorXd& internal, const Eigen::VectorXd& external);

// The same of a model that is not run: its first stage.
InitialImbalance initial_imbalance(const Model& model);

// "the initial stress is out of balance by up to ..."; empty where it is in balance.
std::string explain_imbalance(const Model& model, int stage, const InitialImbalance& imbalance);

}  // namespace sage
