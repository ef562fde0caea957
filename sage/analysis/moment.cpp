#include "sage/analysis/moment.hpp"

namespace sage {

Moment moment_at(const Model& model, int stage, int increment, double load_factor, double share) {
  double before = 0.0;
  for (int s = 0; s < stage; ++s) before += model.stages[static_cast<std::size_t>(s)].duration;
  const double duration = model.stages[static_cast<std::size_t>(stage)].duration;
  return {stage + 1, increment, before + load_factor * duration, share * duration};
}

PointContext context_of(const GroupData& data, int element, const Eigen::Matrix2Xd& x, int point,
                        const Moment& moment) {
  return {.element = data.group->element_numbers[static_cast<std::size_t>(element)],
          .point = point,
          .place = data.group->element->position(x, point),
          .stage = moment.stage,
          .increment = moment.increment,
          .time = moment.time,
          .dt = moment.dt};
}

}  // namespace sage
