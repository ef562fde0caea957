#include "sage/analysis/step_time.hpp"

#include <cmath>

namespace sage {

namespace {

// Of the polygon of the corners, which come first; of one without an area the distance of the first two.
double size_of(const Group& group, const Eigen::Matrix2Xd& x) {
  const int corners = group.entry != nullptr ? group.entry->corners : static_cast<int>(x.cols());
  double twice_area = 0.0;
  for (int i = 0, j = corners - 1; (group.solid() || group.flow()) && i < corners; j = i++)
    twice_area += x(0, j) * x(1, i) - x(0, i) * x(1, j);
  return twice_area > 0.0 ? std::sqrt(0.5 * twice_area) : (x.col(1) - x.col(0)).norm();
}

}  // namespace

StepTime step_time_at(const Model& model, int stage, int increment, double load_factor, double share,
                      double easing) {
  double before = 0.0;
  for (int s = 0; s < stage; ++s) before += model.stages[s].duration;
  const Stage& now = model.stages[stage];
  // Of equal steps with one matrix the time is the same to the last bit, wherever a run is resumed.
  const bool whole = now.pores == PoreWater::flows && std::abs(share * now.increments - 1.0) < 1e-9;
  const double dt = (whole ? 1.0 / now.increments : share) * now.duration;
  return {.stage = stage + 1,
          .increment = increment,
          .time = before + load_factor * now.duration,
          .dt = dt,
          .stage_start = before,
          .easing = easing,
          .load_factor = load_factor,
          .share = share,
          .flow_dt = now.pores == PoreWater::flows ? dt : 0.0,
          .theta = now.theta};
}

PointContext context_of(const GroupData& data, int element, const Eigen::Matrix2Xd& x, int point,
                        const StepTime& step_time) {
  return {.element = data.group->element_numbers[element],
          .point = point,
          .place = data.group->element->position(x, point),
          .stage = step_time.stage,
          .increment = step_time.increment,
          .time = step_time.time,
          .dt = step_time.dt,
          .stage_start = step_time.stage_start,
          .size = size_of(*data.group, x),
          .easing = step_time.easing};
}

}  // namespace sage
