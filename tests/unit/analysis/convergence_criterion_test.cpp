// The rules (C1) to (C8) of docs/theory/analysis.md, each on both sides of its limit.
#include "sage/analysis/convergence_criterion.hpp"

#include <gtest/gtest.h>

namespace sage::test {
namespace {

constexpr double kTolerance = 1e-6;

struct NoRounding : RoundingBounds {
  bool is_known = true;
  double step = 0.0, steps = 0.0, prescribed = 0.0, unknowns = 0.0, all_unknowns = 0.0, moments = -1.0;

  bool known() const override { return is_known; }
  double of_step(int) const override { return step; }
  double of_all_steps(int) const override { return steps; }
  double of_prescribed(int) const override { return prescribed; }
  double of_unknowns(int) const override { return unknowns; }
  double of_all_unknowns(int) const override { return all_unknowns; }
  double of_moments(int) const override { return moments; }
};

// One field whose forces and start are 1, so that max |R_i| is R.
FieldMeasure measure_of(double force, double displacement, double energy, double step_length = 1.0) {
  return {{force, displacement, energy, step_length}, 1.0, 1.0, force};
}

bool ends(const FieldMeasure& field, const NoRounding& rounding = {},
          const std::vector<IterationRecord>& history = {}, bool linear = false, bool refine = false) {
  const ConvergenceCriterion criterion(kTolerance, refine, linear);
  return criterion.is_met({&field, 1}, field.record, history, rounding);
}

bool both_end(const FieldMeasure& first, const FieldMeasure& second, const NoRounding& rounding = {},
              const std::vector<IterationRecord>& history = {}) {
  const FieldMeasure fields[] = {first, second};
  IterationRecord record = first.record;
  record.force = std::max(record.force, second.record.force);
  return ConvergenceCriterion(kTolerance, false, false).is_met(fields, record, history, rounding);
}

TEST(ConvergenceCriterion, ForceEnergyAndDisplacementMustBeSmall) {
  EXPECT_TRUE(ends(measure_of(0.9e-6, 0.9e-3, 0.9e-6)));
  EXPECT_FALSE(ends(measure_of(1.1e-6, 0.9e-3, 0.9e-6)));
  EXPECT_FALSE(ends(measure_of(0.9e-6, 1.1e-3, 0.9e-6)));
  EXPECT_FALSE(ends(measure_of(0.9e-6, 0.9e-3, 1.1e-6)));
}

TEST(ConvergenceCriterion, AVerySmallEnergyOrForceIsEnough) {
  EXPECT_TRUE(ends(measure_of(0.9e-6, 1.0, 0.9e-12)));
  EXPECT_FALSE(ends(measure_of(0.9e-6, 1.0, 1.1e-12)));
  EXPECT_TRUE(ends(measure_of(0.9e-9, 1.0, 1.0)));
  EXPECT_FALSE(ends(measure_of(1.1e-9, 1.0, 1.0)));
}

TEST(ConvergenceCriterion, ACorrectionThatChangesNothingEndsTheStep) {
  EXPECT_TRUE(ends(measure_of(0.9e-3, 0.8e-15, 1.0)));
  EXPECT_FALSE(ends(measure_of(1.1e-3, 0.8e-15, 1.0)));
  EXPECT_FALSE(ends(measure_of(0.9e-3, 1.0e-15, 1.0)));
  EXPECT_FALSE(ends(measure_of(0.9e-3, 0.8e-15, 1.0, 0.5))) << "shortened by the line search";
}

TEST(ConvergenceCriterion, AResidualIsSmallBesideWhatTheStepBalancesToo) {
  FieldMeasure field = measure_of(0.9e-6, 0.0, 0.0);
  field.scale = 1.0;
  field.first = 0.91e-4;  // a hundredth of it is 0.91e-6
  EXPECT_TRUE(ends(field));
  field.first = 0.89e-4;
  EXPECT_FALSE(ends(field));
  field.first = 0.0;
  EXPECT_TRUE(ends(field)) << "nothing to balance";
}

TEST(ConvergenceCriterion, TheRoundingOfTheStepEndsItOnceCorrectionsAreTiny) {
  NoRounding rounding;
  rounding.step = 1e-4;
  EXPECT_TRUE(ends(measure_of(0.9e-4, 0.9e-6, 1.0), rounding));
  EXPECT_FALSE(ends(measure_of(1.1e-4, 0.9e-6, 1.0), rounding));
  EXPECT_FALSE(ends(measure_of(0.9e-4, 1.1e-6, 1.0), rounding));
  EXPECT_FALSE(ends(measure_of(0.9e-4, 0.9e-6, 1.0, 0.5), rounding));
  rounding.step = 1.0;
  EXPECT_FALSE(ends(measure_of(1.1e-3, 0.9e-6, 1.0), rounding)) << "above the root of the tolerance";
}

TEST(ConvergenceCriterion, ForcesThatAreTheRoundingOfAPrescribedMotionAreNone) {
  NoRounding rounding;
  rounding.prescribed = 1e-2;
  FieldMeasure field = measure_of(0.9e-2, 0.9e-6, 1.0);
  EXPECT_TRUE(ends(field, rounding));
  field.scale = 11.0;  // a thousand times 1e-2 is 10
  field.first = 0.0;
  EXPECT_FALSE(ends(field, rounding));
}

// The last of so many iterations, behind others that left `before`.
bool third_ends(double before, double force, bool linear, std::size_t iterations = 3) {
  std::vector<IterationRecord> history(iterations, {before, 1.0, 1.0, 1.0});
  const FieldMeasure field = measure_of(force, 1.0, 1.0);
  history.back() = field.record;
  return ends(field, {}, history, linear);
}

TEST(ConvergenceCriterion, ALinearSceneEndsWhereItsResidualNoLongerFalls) {
  EXPECT_TRUE(third_ends(1e-4, 0.6e-4, true));
  EXPECT_FALSE(third_ends(1e-4, 0.4e-4, true)) << "it halves";
  EXPECT_FALSE(third_ends(1e-4, 0.6e-4, false)) << "K can change";
  EXPECT_FALSE(third_ends(1e-4, 0.6e-4, true, 2)) << "after the second correction";
  EXPECT_FALSE(third_ends(2e-3, 1.1e-3, true)) << "above the root of the tolerance";
}

TEST(ConvergenceCriterion, AFirstCorrectionAloneEndsNothingWhereItIsRefined) {
  EXPECT_FALSE(ends(measure_of(0.0, 1.1e-6, 0.0), {}, {}, true, true));
  EXPECT_TRUE(ends(measure_of(0.0, 0.9e-6, 0.0), {}, {}, true, true));
}

TEST(ConvergenceCriterion, EveryFieldMustEnd) {
  const FieldMeasure good = measure_of(0.0, 0.0, 0.0), bad = measure_of(1e-2, 1.0, 1.0);
  EXPECT_TRUE(both_end(good, good));
  EXPECT_FALSE(both_end(good, bad));
  EXPECT_FALSE(both_end(bad, good));
}

// Heads that are the same everywhere, moments that are the rounding of forces times lengths, and fields that round together.
TEST(ConvergenceCriterion, AFieldWithNothingToBalanceButRoundingEnds) {
  const FieldMeasure good = measure_of(0.0, 0.0, 0.0);
  FieldMeasure even = measure_of(1e-2, 1.0, 1.0);
  NoRounding rounding;
  rounding.unknowns = 1.1e-2;
  EXPECT_TRUE(both_end(good, even, rounding));
  EXPECT_FALSE(both_end(even, good, rounding)) << "not the displacements";
  rounding.unknowns = 0.9e-2;
  EXPECT_FALSE(both_end(good, even, rounding));

  rounding.moments = 1.1e-2;
  even.first = 0.0;
  even.scale = 10.0;
  EXPECT_TRUE(both_end(good, even, rounding));
  even.scale = 12.0;
  EXPECT_FALSE(both_end(good, even, rounding)) << "a thousand times as much is something";

  rounding.moments = -1.0;
  rounding.all_unknowns = 1.3e-2;
  EXPECT_TRUE(both_end(good, even, rounding));
  rounding.is_known = false;
  EXPECT_FALSE(both_end(good, even, rounding));
}

TEST(ConvergenceCriterion, CoupledFieldsEndAtTheRoundingOfAllWhereTheyFallNoMore) {
  const FieldMeasure good = measure_of(0.0, 0.0, 0.0), left = measure_of(1e-4, 0.9e-6, 1.0);
  NoRounding rounding;
  rounding.steps = 1.1e-4;
  std::vector<IterationRecord> done(10, {1e-4, 1.0, 1.0, 1.0});
  EXPECT_TRUE(both_end(good, left, rounding, done));
  done.back().force = 0.4e-4;
  EXPECT_FALSE(both_end(good, left, rounding, done)) << "it still falls";
  done.back().force = 1e-4;
  rounding.steps = 0.9e-4;
  EXPECT_FALSE(both_end(good, left, rounding, done));
}

}  // namespace
}  // namespace sage::test
