// The ground of a model at one of its stages, for limit analysis.
#pragma once

#include <string>
#include <vector>

#include "sage/bounds/domain.hpp"
#include "sage/model/model.hpp"

namespace sage::bounds {

struct Ground {
  Domain domain;
  double stated_factor = 1.0;                // by which the stage divides the strengths of the deck already
  bool has_live = false;                     // there are live weights, loads or movements of supports
  std::vector<std::string> soils;            // "1 clay (mohr_coulomb): c 10, phi 30"
  std::vector<std::string> notes;            // what the bounds take otherwise than the deck: psi = phi, joints
  std::vector<std::array<int, 2>> elements;  // group and element (indices) by Triangle::origin
};

// The ground at the end of a stage (from 0).  What the stages from first_live on add to weights, loads and movements is
// live, what earlier ones add is fixed.  The model must outlive the result.
// unknowns: of a run at the start of the stage (one entry a dof), which the pore pressures of water cards that take heads
// of flow elements come from; nullptr = not known, and such cards are rejected.
// room: triangles up to which the mesh will be refined.  A quadrilateral becomes four, or two where four leave no room;
// 0 = always four.
// Throws InputError for what has no bounds: axisymmetry, structures, laws, loads and water that limit analysis lacks.
Ground make_ground(const Model& model, int first_live, int stage, const Eigen::VectorXd* unknowns = nullptr,
                   int room = 0);
// Some soil that is active in the stage takes its pore pressure from heads of flow elements.
bool wants_heads(const Model& model, int stage);

}  // namespace sage::bounds
