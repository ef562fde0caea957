// Steps of stages with water that leaves into air or has a free surface: the places where it leaves, and where the soil
// falls dry, are part of the answer.
#pragma once

#include <vector>

#include "sage/analysis/stepper.hpp"

namespace sage {

class FreeSurfaceSearch {
 public:
  // Both must outlive it.
  FreeSurfaceSearch(const RunParts& run, Stepper& stepper)
      : run_(run), stepper_(stepper), flow_alone_(is_flow_alone(run.model)) {}

  // As Stepper::attempt from the committed state; without such water it is that.
  // Throws AnalysisError where the places, or in seepage alone the surface, are not found.
  NewtonStep attempt(double from, double to);

 private:
  NewtonStep settle_exits(double from, double to, bool from_here);
  NewtonStep settle_surface(double from, double to);

  const RunParts& run_;
  Stepper& stepper_;
  bool flow_alone_;
};

}  // namespace sage
