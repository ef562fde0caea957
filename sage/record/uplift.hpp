// Safety of ground against the water below it: uplift and hydraulic heave on a line of nodes.
#pragma once

#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// Of what lies above a line, per unit thickness or the full circle, at the end of a stage.
//   weight       W: total weight of soil, structures on the ground with their loads, and free water     [force]
//   water        U: pore pressure on the line times its width, the larger one of both sides             [force]
//   uplift       W / U
//   heave        (W - U0) / (U - U0), U0 being the pressure of water at rest below the surface of ground or free water: the
//                buoyant weight over the seepage force (Terzaghi); NaN where U does not exceed U0
struct Uplift {
  double weight = 0.0, water = 0.0, uplift = 0.0, heave = 0.0;
};

// nodes: of the line, at least two at different x.  NaN where no water presses on it.
Uplift uplift_on(const Model& model, int stage, const std::vector<int>& nodes, const Activity& activity,
                 const Eigen::VectorXd& unknowns);

}  // namespace sage
