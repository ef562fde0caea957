#include "sage/analysis/convergence_criterion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

// Up to here a field with scale S counts as having nothing but rounding to balance: times the bound of its rounding.
constexpr double kNothing = 1e3;

// The residual has come no further in eight corrections.
bool falls_no_more(const std::vector<IterationRecord>& all) {
  constexpr std::ptrdiff_t kLook = 8;
  if (static_cast<std::ptrdiff_t>(all.size()) < kLook + 2) return false;
  const auto least_force = [](auto first, auto last) {
    return std::ranges::min_element(first, last, {}, &IterationRecord::force)->force;
  };
  const auto recent = all.end() - kLook;
  return least_force(recent, all.end()) > 0.5 * least_force(all.begin(), recent);
}

}  // namespace

// Every field for itself: a force and a flux have no common unit.  Residuals of several fields at rounding go up and down:
// there the field that is farthest from its end must have stopped falling (C6).
bool ConvergenceCriterion::is_met(std::span<const FieldMeasure> fields, const IterationRecord& record,
                                  const std::vector<IterationRecord>& history,
                                  const RoundingBounds& rounding) const {
  constexpr double kFirst = 1e-6;  // of the unknowns: no refinement
  if (refine_ && record.displacement > kFirst) return false;
  const int count = static_cast<int>(fields.size());
  if (count == 1) return is_met(fields[0], record, 0, count, history, rounding);
  if (stopped_falling_linear(record, history) && falls_no_more(history)) return true;
  for (int f = 0; f < count; ++f) {
    const FieldMeasure& measure = fields[f];
    if (!is_met(measure, measure.record, f, count, history, rounding) && !is_even(measure, f, rounding))
      return false;
  }
  return true;
}

// (C1) with one of (C2) to (C7).
bool ConvergenceCriterion::is_met(const FieldMeasure& measure, const IterationRecord& record, int field,
                                  int fields, const std::vector<IterationRecord>& history,
                                  const RoundingBounds& rounding) const {
  constexpr double kUnchanged = 4.0 * std::numeric_limits<double>::epsilon();
  const double tol = tolerance_;
  if (outgrown(measure, record)) return false;
  if (record.displacement <= kUnchanged && record.step_length >= 1.0 && record.force <= std::sqrt(tol))
    return true;
  if (!(record.force <= tol))
    return at_rounding(measure, record, field, fields, history, rounding) ||
           stopped_falling_linear(record, history);
  return record.energy <= tol * tol || record.force <= 1e-3 * tol ||
         (record.energy <= tol && record.displacement <= std::sqrt(tol));
}

// (C1).  Stress that balances itself is made by the motion and grows with it (mean stress near nu = 1/2): beside that of an
// iteration that runs away any load is small.
bool ConvergenceCriterion::outgrown(const FieldMeasure& measure, const IterationRecord& record) const {
  constexpr double kShare = 0.01;
  const double largest = std::max(kShare, 10.0 * tolerance_) * measure.first;
  return measure.first > 0.0 && record.force * measure.scale > largest;
}

// (C5).  With a constant tangent the second correction removes all but rounding: what does not fall any more is that of the
// internal forces themselves, near nu = 1/2 K/G times that of the displacements.  The run warns of it.
bool ConvergenceCriterion::stopped_falling_linear(const IterationRecord& record,
                                                  const std::vector<IterationRecord>& history) const {
  const std::size_t done = history.size();
  return linear_ && done >= 3 && record.force > 0.5 * history[done - 2].force &&
         record.force <= std::sqrt(tolerance_);
}

// (C4), (C6), (C7).  Forces are K times displacements: what the rounding of those makes can't be balanced (stiff joints, nu near
// 1/2).  A residual of that size ends the step once corrections are tiny, if it is small beside the forces; or if all
// forces are no more than the rounding of a prescribed motion (a loose part, moved without stress).  The sum over all
// fields is a bound from above, so that it ends a step only where corrections help no more.
bool ConvergenceCriterion::at_rounding(const FieldMeasure& measure, const IterationRecord& record, int field,
                                       int fields, const std::vector<IterationRecord>& history,
                                       const RoundingBounds& rounding) const {
  constexpr double kTiny = 1e-6;
  if (!(record.displacement <= kTiny) || record.step_length < 1.0) return false;
  if (record.force <= std::sqrt(tolerance_)) {
    if (measure.largest <= rounding.of_step(field)) return true;
    return fields > 1 && rounding.known() && falls_no_more(history) &&
           measure.largest <= rounding.of_all_steps(field);
  }
  const double prescribed = rounding.of_prescribed(field);
  return measure.largest <= prescribed && measure.scale <= kNothing * prescribed;
}

// A concentration that is the same everywhere, of whatever size, makes fluxes of no digit.  So do the fields together: a
// beam that is bent by moments alone has forces that are the rounding of its rotations, and one that is moved as a whole
// has moments that are the rounding of its displacements.  Where all displacements are prescribed, moments that are the
// rounding of the elements' forces times lengths count as none.
bool ConvergenceCriterion::is_even(const FieldMeasure& measure, int field,
                                   const RoundingBounds& rounding) const {
  if (field != 0 && measure.largest <= rounding.of_unknowns(field)) return true;
  const double moments = rounding.of_moments(field);
  if (measure.largest <= moments && measure.scale <= kNothing * moments) return true;
  if (!rounding.known()) return false;
  const double together = rounding.of_all_unknowns(field);
  return measure.largest <= together && measure.scale <= kNothing * together;
}

}  // namespace sage
