#include "sage/analysis/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

constexpr double kAccept = 0.8;  // of the slope at the start

// Crisfield's criterion on the slope: the full step is kept while it is below 0.8 of the start.  Without symmetry that
// slope is no energy and may start near zero: a full step that halves the residual is kept then, too.
bool keeps_full_step(const StepIteration& step, double old_norm) {
  constexpr double kHalf = 0.5;
  if (std::abs(step.work_left()) <= kAccept * std::abs(step.slope)) return true;
  return !step.assembly.scene().symmetric && step.residual_size() < kHalf * old_norm;
}

// Joints that touch without pressure may be found open by one tangent and closed by the next, for good: late iterations
// whose correction throws away what earlier ones have won.
bool chatters(const StepIteration& step, int iteration, double old_norm) {
  constexpr int kLate = 10;
  constexpr double kThrown = 5.0;
  if (iteration <= kLate || !step.settings.line_search || step.accelerated() || step.assembly.scene().symmetric)
    return false;
  return step.residual_size() > kThrown * old_norm &&
         std::ranges::any_of(step.assembly.groups(),
                             [](const GroupData& data) { return data.group->interface(); });
}

bool halve(StepIteration& step, double old_norm) {
  constexpr int kTrials = 4;
  for (int trial = 0; trial < kTrials && step.residual_size() > old_norm; ++trial) {
    step.move(-0.5 * step.step_length);
    step.step_length *= 0.5;
    if (step.assemble(step.policy.makes_K(step, IterationPolicy::Pass::line_search)) == Outcome::cut_step)
      return false;
  }
  return true;
}

}  // namespace

bool search_zero_slope(StepIteration& step, double old_norm) {
  constexpr int kTrials = 4;
  if (!step.settings.line_search || keeps_full_step(step, old_norm)) return true;
  double a = 0.0, slope_a = step.slope, length = 1.0, slope = step.work_left();
  double b = 1.0, slope_b = slope;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (std::abs(slope) <= kAccept * std::abs(step.slope)) break;
    const bool between = slope_a * slope_b < 0.0;
    const double zero = between ? a - slope_a * (b - a) / (slope_b - slope_a) : 0.5 * (a + b);
    const double next = std::clamp(zero, a + 0.1 * (b - a), b - 0.1 * (b - a));
    step.move(next - length);
    length = next;
    if (step.assemble(step.policy.makes_K(step, IterationPolicy::Pass::line_search)) == Outcome::cut_step)
      return false;
    slope = step.work_left();
    const bool beyond = between && slope_a * slope > 0.0;  // the zero lies between here and b
    (beyond ? a : b) = next;
    (beyond ? slope_a : slope_b) = slope;
  }
  step.step_length = length;
  return true;
}

bool search_line(StepIteration& step, int iteration, double old_norm) {
  if (iteration > 1 && !step.accelerated() && !search_zero_slope(step, old_norm)) return false;
  return !chatters(step, iteration, old_norm) || halve(step, old_norm);
}

}  // namespace sage
