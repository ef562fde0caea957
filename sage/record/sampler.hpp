// Displacement and stress at any place of a solution, as people read them.
#pragma once

#include "sage/analysis/probe.hpp"

namespace sage {

struct Sample {
  Vector2 at = Vector2::Zero();
  int element = 0;                    // deck number; 0 = in no active solid, and then all below is NaN
  Vector2 u = Vector2::Zero();        // along +x (+r) and +y (+z)
  Vector4 strain = Vector4::Zero();   // compression positive [xx yy zz xy], engineering shear
  Vector4 stress = Vector4::Zero();   // compression positive [xx yy zz xy]
  double mean = 0.0, deviator = 0.0;  // p (compression positive) and q = sqrt(3 J2) of that stress
};

// What a probe finds.
Sample sample_of(const Model& model, const Probe& probe, const Solution& solution);

class Sampler {
 public:
  // Model and solution must outlive the sampler.
  Sampler(const Model& model, const Solution& solution)
      : model_(&model), solution_(solution), probes_(model, solution.activity->group) {}

  Sample at(const Vector2& place, int group = -1) const;

 private:
  const Model* model_;
  Solution solution_;
  ProbeMaker probes_;
};

}  // namespace sage
