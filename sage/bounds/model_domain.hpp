// The ground of a model at one of its stages, for limit analysis.
#pragma once

#include <string>
#include <vector>

#include "sage/bounds/domain.hpp"
#include "sage/model/model.hpp"

namespace sage::bounds {

struct Ground {
  Domain domain;
  bool has_live = false;                     // there are live weights, loads or movements of supports
  std::vector<std::string> soils;            // "1 clay (mohr_coulomb): c 10, phi 30"
  std::vector<std::string> notes;            // what the bounds take otherwise than the deck: psi = phi, joints
  std::vector<std::array<int, 2>> elements;  // group and element (indices) by Triangle::origin
};

// The ground at the end of a stage (from 0).  What the stages from first_live on add to weights, loads and movements is
// live, what earlier ones add is fixed.  The model must outlive the result.
// Throws InputError for what has no bounds: axisymmetry, structures, laws, loads and water that limit analysis lacks.
Ground make_ground(const Model& model, int first_live, int stage);

}  // namespace sage::bounds
