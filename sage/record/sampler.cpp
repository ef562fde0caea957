#include "sage/record/sampler.hpp"

#include <limits>

#include "sage/record/values.hpp"

namespace sage {

Sample sample_of(const Model& model, const Probe& probe, const Solution& solution) {
  Sample sample;
  if (!probe.active()) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    sample.u.setConstant(kUnknown);
    sample.strain.setConstant(kUnknown);
    sample.stress.setConstant(kUnknown);
    sample.mean = sample.deviator = kUnknown;
    return sample;
  }
  const ProbeValue value = read_probe(probe, solution);
  sample.element = model.groups[static_cast<std::size_t>(probe.group)]
                       .element_numbers[static_cast<std::size_t>(probe.element)];
  sample.u = value.u;
  for (int i = 0; i < 4; ++i) {
    sample.strain[i] = outward(value.strain[i]);
    sample.stress[i] = outward(value.stress[i]);
  }
  sample.mean = mean_stress(value.stress.data());
  sample.deviator = deviator_stress(value.stress.data());
  return sample;
}

Sample Sampler::at(const Vector2& place, int group) const {
  Sample sample = sample_of(*model_, probes_.at(place, group), solution_);
  sample.at = place;
  return sample;
}

}  // namespace sage
