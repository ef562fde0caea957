// Checks on the chapter's sentences: their measures on fields that are known, and that every one of them can fail.
#include <gtest/gtest.h>

#include <set>

#include "sage/app/commands.hpp"
#include "tests/studies/figures/verdict.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::figures {
namespace {

constexpr std::size_t at(Quantity quantity) {
  return static_cast<std::size_t>(quantity) - static_cast<std::size_t>(Quantity::sigma_r);
}

// 4 x 4 elements of pinned1 (R = H, cell pressure 0), whose conf is 30 z / H psi at 10 percent of strain.
SpecimenRun sloped() {
  SpecimenRun run;
  run.scene = &scene_named("pinned1");
  run.columns = run.rows = 4;
  State state;
  state.strain = 10.0;
  state.at_elements.assign(6, std::vector<double>(16, 0.0));
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      run.cells.push_back({(i + 0.5) / 4, (j + 0.5) / 4, 1.0 / 16, i >= 2 && j >= 2});
      state.at_elements[at(Quantity::conf)][4 * j + i] = 30.0 * (j + 0.5) / 4;
      state.level.push_back(j < 2 && i < 2 ? 1.0 : 0.5);
    }
  run.states.push_back(state);
  for (int i = 1; i <= 10; ++i) {
    run.strain.push_back(i);
    run.measured.push_back(run.scene->correct(i) * (1.0 + 0.01 * i));
    run.yielded.push_back(0.0);
    run.joint_most.push_back(0.0);
  }
  return run;
}

double number(Measure measure, Quantity quantity, Place place = Place::everywhere, double p = 0.0,
              Place target = Place::everywhere, bool away = false) {
  const SpecimenRun run = sloped();
  const Check check{.measure = measure,
                    .a = {"pinned1", quantity, 10},
                    .b = {"pinned1", quantity, 10},
                    .place = place,
                    .target = target,
                    .p = p};
  return number_of(check, run, &run, away, {});
}

TEST(Measures, OfASlopedField) {  // values 3.75, 11.25, 18.75, 26.25 psi by row, q = 300 psi, c = 0
  const Quantity conf = Quantity::conf;
  EXPECT_NEAR(number(Measure::change_most, conf), 26.25 / 300, 1e-12);
  EXPECT_NEAR(number(Measure::change_mean, conf), 15.0 / 300, 1e-12);
  EXPECT_NEAR(number(Measure::change_mean, conf, Place::near_ends), 26.25 / 300, 1e-12);
  EXPECT_NEAR(number(Measure::excess_least, conf), 3.75 / 300, 1e-12);
  EXPECT_NEAR(number(Measure::nearness, conf), 26.25 / 300, 1e-12);
  EXPECT_NEAR(number(Measure::share_close, conf, Place::everywhere, 0.05), 0.5, 1e-12);  // 11.25 <= 15 < 18.75
  EXPECT_NEAR(number(Measure::share_below, conf, Place::everywhere, 20.0), 0.75, 1e-12);
  EXPECT_NEAR(number(Measure::share_above, conf, Place::everywhere, 20.0), 0.25, 1e-12);
  EXPECT_NEAR(number(Measure::row_range, conf), 0.0, 1e-12);
  EXPECT_NEAR(number(Measure::mean_gap, conf, Place::near_ends), 26.25 - 11.25, 1e-12);
  EXPECT_NEAR(number(Measure::correlation, conf), 1.0, 1e-12);
  EXPECT_NEAR(number(Measure::range, conf), 22.5, 1e-12);
  // Without the 2 x 2 elements of the corner the mean is that of the other twelve.
  EXPECT_NEAR(number(Measure::change_mean, conf, Place::everywhere, 0.0, Place::everywhere, true),
              (4 * 3.75 + 4 * 11.25 + 2 * 18.75 + 2 * 26.25) / 12 / 300, 1e-12);
}

TEST(Measures, OfPlaces) {
  // The first element of the last row: r = .125 R is at the axis; z = .875 H is .025 R from the last .15 R ... and in.
  EXPECT_NEAR(number(Measure::distance_most, Quantity::conf, Place::everywhere, 0.0, Place::at_end_axis), 0.0,
              1e-12);
  EXPECT_NEAR(number(Measure::distance_most, Quantity::conf, Place::everywhere, 0.0, Place::at_end_rim), 0.725,
              1e-12);
  EXPECT_NEAR(number(Measure::distance_least, Quantity::conf, Place::everywhere, 0.0, Place::at_end_axis),
              0.725, 1e-12);
  EXPECT_NEAR(distance(Place::at_end_axis, 0.5, 0.5, 2.0), 0.85, 1e-12);  // H = 2 R: along z 1 - .15
  EXPECT_TRUE(contains(Place::below_ends, 1.0, 0.7, 2.0));
  EXPECT_FALSE(contains(Place::below_ends, 1.0, 0.71, 2.0));
}

TEST(Measures, OfYieldedElements) {  // level 1 in the lower half, from the axis on half of each row
  const Quantity level = Quantity::level;
  EXPECT_NEAR(number(Measure::yielded, level), 0.25, 1e-12);
  EXPECT_NEAR(number(Measure::unyielded, level), 0.75, 1e-12);
  EXPECT_NEAR(number(Measure::yielded_r, level), 0.25, 1e-12);
  EXPECT_NEAR(number(Measure::yielded_z, level), 0.25, 1e-12);
  EXPECT_NEAR(number(Measure::yielded_edge, level), 0.375, 1e-6);
  EXPECT_NEAR(number(Measure::yielded_ratio, level), 1.0, 1e-12);
}

TEST(Measures, OfCurves) {  // excess .01 a percent of strain
  const Quantity none = Quantity::none;
  EXPECT_NEAR(number(Measure::ratio, none), 1.1, 1e-12);
  EXPECT_NEAR(number(Measure::excess_most, none), 0.1, 1e-12);
  EXPECT_NEAR(number(Measure::excess_spread, none), 0.9, 1e-12);
  EXPECT_NEAR(number(Measure::ratio_spread, none), 0.09, 1e-12);
  EXPECT_NEAR(number(Measure::first_above, none, Place::everywhere, 1.055), 6.0, 1e-12);
  EXPECT_TRUE(std::isnan(number(Measure::first_above, none, Place::everywhere, 1.2)));
  EXPECT_NEAR(number(Measure::measured, none), 330.0, 1e-12);
}

TEST(Alterations, DoWhatTheyAreCalled) {
  const SpecimenRun run = sloped();
  const auto conf = [](const SpecimenRun& one) { return one.states[0].values(Quantity::conf); };
  EXPECT_NEAR(conf(altered(run, Alteration::mirrored))[0], 26.25, 1e-12);
  EXPECT_NEAR(conf(altered(run, Alteration::sign))[0], -3.75, 1e-12);
  EXPECT_NEAR(conf(altered(run, Alteration::lifted))[0], 3.75 + 30.0, 1e-12);
  std::vector<double> mixed = conf(altered(run, Alteration::shuffled)), plain = conf(run);
  EXPECT_NE(mixed, plain);
  std::ranges::sort(mixed);
  std::ranges::sort(plain);
  EXPECT_EQ(mixed, plain);
  EXPECT_NEAR(altered(run, Alteration::sign).ratio(10), 0.9, 1e-12);
  EXPECT_NEAR(altered(run, Alteration::mirrored).ratio(1), 1.1, 1e-12);
}

Outcome outcome(bool full, bool full_away, bool b_bar, bool b_bar_away) {
  Outcome one;
  one.pass = {{{full, full_away}, {b_bar, b_bar_away}}};
  return one;
}

TEST(Verdicts, FollowFromTheNumbers) {
  EXPECT_EQ(verdict_of(outcome(true, true, true, true)), Verdict::holds);
  EXPECT_EQ(verdict_of(outcome(true, false, true, false)), Verdict::holds);
  EXPECT_EQ(verdict_of(outcome(false, true, false, true)), Verdict::away_from_corner);
  EXPECT_EQ(verdict_of(outcome(true, true, false, true)), Verdict::away_from_corner);
  EXPECT_EQ(verdict_of(outcome(true, true, false, false)), Verdict::artefact);
  EXPECT_EQ(verdict_of(outcome(false, true, false, false)), Verdict::artefact);
  EXPECT_EQ(verdict_of(outcome(false, false, true, true)), Verdict::does_not_hold);
  const Outcome yes = outcome(true, true, true, true), no = outcome(false, false, false, false);
  EXPECT_EQ(verdict_of(std::vector{yes, yes, yes}), Verdict::holds);
  EXPECT_EQ(verdict_of(std::vector{no, yes, yes}), Verdict::depends_on_k_j);
  EXPECT_EQ(verdict_of(std::vector{no, no, no}), Verdict::does_not_hold);
}

// Within 5 percent of a limit on either side; a share that can't pass 1 has less room above .99 than that.
TEST(Verdicts, SayWhatIsNearALimit) {
  const Check third{.measure = Measure::excess_ratio, .a = {}, .high = 1.0 / 3.0},
      half{.measure = Measure::change_ratio, .a = {}, .low = 0.4, .high = 0.6},
      all{.measure = Measure::yielded, .a = {}, .low = 0.99},
      count{.measure = Measure::elements, .a = {}, .low = 392, .high = 392},
      none{.measure = Measure::yielded, .a = {}, .high = 0.0};
  EXPECT_TRUE(is_near_limit(third, 0.3407));  // Figure 7.13
  EXPECT_TRUE(is_near_limit(third, 0.32));
  EXPECT_FALSE(is_near_limit(third, 0.36));
  EXPECT_FALSE(is_near_limit(third, 0.3));
  EXPECT_TRUE(is_near_limit(half, 0.59));
  EXPECT_TRUE(is_near_limit(half, 0.385));
  EXPECT_FALSE(is_near_limit(half, 0.5));
  EXPECT_FALSE(is_near_limit(all, 1.0));
  EXPECT_TRUE(is_near_limit(all, 0.985));
  EXPECT_FALSE(is_near_limit(all, 0.9));
  EXPECT_FALSE(is_near_limit(count, 392.0));
  EXPECT_FALSE(is_near_limit(none, 0.0));
  EXPECT_FALSE(is_near_limit(third, std::nan("")));
  // What decides: of full elements and B-bar alike, one number near the limit is enough.
  Outcome one = outcome(true, true, true, true);
  one.number = {{{0.2, 0.2}, {0.33, 0.33}}};
  EXPECT_TRUE(near_limit(third, {one}));
  one.number = {{{0.2, 0.2}, {0.2, 0.33}}};  // everywhere it holds clearly
  EXPECT_FALSE(near_limit(third, {one}));
}

TEST(Checks, NameWordsScenesAndLimits) {
  std::set<std::string> known{""};
  for (const Word& word : words()) known.insert(word.words);
  std::set<int> figures;
  for (const Check& check : checks()) {
    EXPECT_TRUE(known.contains(check.word)) << check.word;
    EXPECT_TRUE(std::isfinite(check.low) || std::isfinite(check.high)) << check.quote;
    EXPECT_NO_THROW(scene_named(check.a.scene)) << check.quote;
    figures.insert(check.figure);
  }
  EXPECT_EQ(figures.size(), 40u);
  EXPECT_EQ(captions().size(), 40u);
}

// What the program finds about the chapter, from one evaluation of all checks.
struct Findings {
  std::vector<Result> results;
  double fitted = 0.0;

  const Result& find(int figure, const std::string& words) const {
    for (const Result& result : results)
      if (result.check->figure == figure && std::string(result.check->quote).find(words) != std::string::npos)
        return result;
    throw std::out_of_range("no check of 7." + std::to_string(figure) + " has the words " + words);
  }
};

Findings findings() {
  const scenes::Workbench bench = app::make_workbench();
  Runs runs(bench);
  Findings found;
  found.fitted = fitted_k_j(bench);
  found.results = evaluate(runs, checks(), {{"120", 120.0}, {"5", 5.0}, {"fitted", found.fitted}});
  return found;
}

// A check that passes must fail on a swapped scene or an altered field: else it says nothing.
void expect_that_all_can_fail(const Findings& found) {
  for (const Result& result : found.results)
    EXPECT_NE(result.shown_to_fail, "") << "7." << result.check->figure << ": " << result.check->quote;
}

// From converged references (Table 7.3's pinned columns lock; the rim of the end is singular) and exact properties.
void expect_known_verdicts(const Findings& found) {
  const auto verdict = [&](int figure, const char* words) { return found.find(figure, words).verdict; };
  EXPECT_EQ(verdict(2, "identical"), Verdict::holds);
  EXPECT_EQ(verdict(3, "25 percent greater than the correct stress (nu = .495"), Verdict::artefact);
  EXPECT_EQ(verdict(8, "12 percent greater than the correct stress (nu = .495"), Verdict::artefact);
  EXPECT_EQ(verdict(8, "approximately half"), Verdict::holds);
  EXPECT_EQ(verdict(11, "maximum value of confining stress"), Verdict::away_from_corner);
  EXPECT_EQ(verdict(18, "3 percent"), Verdict::depends_on_k_j);
  EXPECT_EQ(verdict(23, "12 percent"), Verdict::does_not_hold);
  EXPECT_EQ(verdict(32, "none of the interface elements"), Verdict::holds);
  EXPECT_EQ(verdict(24, "decreases near the specimen ends"), Verdict::holds);
  EXPECT_EQ(verdict(24, "increases significantly near the ends"), Verdict::holds);
}

// Decided in the third digit.
void expect_verdicts_near_their_limits(const Findings& found) {
  EXPECT_TRUE(found.find(13, "much less significant").near_limit);
  EXPECT_TRUE(found.find(37, "at yielding (dev)").near_limit);
  EXPECT_FALSE(found.find(3, "25 percent greater than the correct stress (nu = .495").near_limit);
}

// The K_j of 3 percent meets 7.18 with full elements by construction; 120 and 5 do not.
void expect_fitted_stiffness(const Findings& found) {
  EXPECT_GT(found.fitted, 5.0);
  EXPECT_LT(found.fitted, 120.0);
  const Result& conf = found.find(20, "3 percent at an axial strain level of 10 percent (conf)");
  ASSERT_EQ(conf.outcomes.size(), 3u);
  EXPECT_NEAR(conf.outcomes[2].number[0][1], 0.03, 1e-4);  // 200 increments instead of 40: 0.2 percent
  EXPECT_GT(conf.outcomes[0].number[0][1], 0.033);
  EXPECT_LT(conf.outcomes[1].number[0][1], 0.027);
}

TEST(Chapter, VerdictsOfAllChecks) {
  const Findings found = findings();
  expect_that_all_can_fail(found);
  std::set<Verdict> seen;
  for (const Result& result : found.results) seen.insert(result.verdict);
  EXPECT_EQ(seen.size(), 5u);
  expect_known_verdicts(found);
  expect_verdicts_near_their_limits(found);
  expect_fitted_stiffness(found);
}

}  // namespace
}  // namespace sage::figures
