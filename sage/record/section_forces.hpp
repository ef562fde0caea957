// Normal force, shear force and bending moment of the solids along a straight cut.
#pragma once

#include <vector>

#include "sage/analysis/probe.hpp"

namespace sage {

// From the total stress along the cut, of both geometries per unit of width; in axisymmetry that is per unit of
// circumference at the middle of the cut, as of shells (docs/manual/structures.md).  The axis of the structure crosses the cut
// from its left to its right, seen from the first end to the second one.  NaN where the cut meets no active solid.
//   axial           compression positive                                                                       [force]
//   shear           positive where what lies on the right of the cut pushes towards the cut's second end       [force]
//   moment          about the middle of the cut; positive with tension at its first end                        [force length]
//   hoop,           axisymmetry: of the stress around the axis, for each unit of length across the cut;
//   hoop_moment     signs as above
//   length          of the cut in solids
//   error           of axial, shear and moment: what the other stress gives less that value.  The stress is the smooth one of
//                   patches; in bodies of one row of elements that of each element by itself, and the other one is that
//                   which is not used.  An estimate, no bound; NaN where both are the same stress
struct SectionForces {
  double axial = 0.0, shear = 0.0, moment = 0.0, hoop = 0.0, hoop_moment = 0.0, length = 0.0;
  double error[3] = {0.0, 0.0, 0.0};
};

// The integrals over the cut as sums over integration points, for a set of active groups.
class SectionSum {
 public:
  SectionSum() = default;
  // `active` by group; `probes` of these groups.
  SectionSum(const Model& model, const Report& report, const std::vector<char>& active,
             const ProbeMaker& probes);

  SectionForces forces(const Model& model, const Solution& solution) const;

 private:
  // Weights of a point's stress in the integrals of 1 and of the way from the middle of the cut.
  struct Term {
    std::size_t group = 0, point = 0;
    double used[2] = {0.0, 0.0};   // over the surface of the cut
    double other[2] = {0.0, 0.0};  // the same, of the stress that is not used
    double plane[2] = {0.0, 0.0};  // over its line
  };

  std::vector<Term> terms_;
  Vector2 across_ = Vector2::Zero(), along_ = Vector2::Zero();  // the structure's axis, and the cut
  double length_ = 0.0;
  bool estimates_ = true;
};

}  // namespace sage
