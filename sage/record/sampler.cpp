#include "sage/record/sampler.hpp"

namespace sage {

Sample sample_of(const Model& model, const Probe& probe, const Solution& solution, const FieldList& fields) {
  Sample sample;
  for (const FieldEntry* field : fields) {
    const std::vector<double> value = field_at(*field, model, probe, solution);
    sample.values.insert(sample.values.end(), value.begin(), value.end());
  }
  if (probe.active()) sample.element = model.groups[probe.group].element_numbers[probe.element];
  return sample;
}

Sample Sampler::at(const Vector2& place, int group) const {
  Sample sample = sample_of(*model_, probes_.at(place, group), solution_, fields_);
  sample.at = place;
  return sample;
}

}  // namespace sage
