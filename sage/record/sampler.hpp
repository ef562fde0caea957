// Fields at any place of a solution.
#pragma once

#include "sage/record/field_reader.hpp"

namespace sage {

struct Sample {
  Vector2 at = Vector2::Zero();
  int element = 0;             // deck number; 0 = in no active one, and then all values are NaN
  std::vector<double> values;  // of the fields that were asked for, one behind the other
};

// What a probe finds.
Sample sample_of(const Model& model, const Probe& probe, const Solution& solution, const FieldList& fields);

class Sampler {
 public:
  // In the solids, or in the elements of flow.  Model, solution and fields must outlive the sampler.
  Sampler(const Model& model, const Solution& solution, const FieldList& fields,
          ElementKind kind = ElementKind::solid)
      : model_(&model), solution_(solution), fields_(fields), probes_(model, solution.activity->group, kind) {}

  Sample at(const Vector2& place, int group = -1) const;

 private:
  const Model* model_;
  Solution solution_;
  FieldList fields_;
  ProbeMaker probes_;
};

}  // namespace sage
