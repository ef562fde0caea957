// Steps of a condensed region that its border takes alone (Condensation): what is filled in later, or where somebody
// looks, is what it would have been.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sage/app/commands.hpp"
#include "sage/record/report.hpp"
#include "tests/support/run_text.hpp"
#include "tests/support/same_increments.hpp"

namespace sage::test {
namespace {

std::string pressed_specimen(int increments, int max_iterations = 0) {
  SpecimenDeck deck;
  deck.columns = 8;
  deck.rows = 16;
  deck.increments = increments;
  deck.max_iterations = max_iterations;
  return deck.text();
}

// A heavy block on a rough joint, pushed sideways: it slips at 10 tan 30 = 5.77 of the pressure, more or less as the
// joint is pressed unevenly.
std::string pushed_block(double pressure, bool report_of_top = true, double stiff = 5000.0,
                         double residual = -1.0) {
  DeckWriter deck(1);
  Block block{12, 6, Cell::quad4, 1, 1, rectangle(0.0, 2.0, 0.0, 1.0)};
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3}, 10.0);
  deck.material(2, 22, {0.0, 30.0, 0.0, 0.0, stiff, 0.5, 1e5, 1e5, residual < 0.0 ? stiff : residual, 1.0});
  deck.group(1, 1, 0, 1);
  deck.group(2, 11, 0, 2);
  block.write_elements(deck, 1);
  const std::vector<int> base = copy_row(deck, block, block.bottom(), 1001);
  join(deck, 1001, 2, base, block.bottom(), 1);
  for (int n : base) deck.fix(n, 1, 1);
  if (report_of_top)
    deck.triaxial_report(1, block.top().front(), block.top().back(), 1, 1.0);
  else
    deck.triaxial_report(1, base.front(), base.back(), 1, 1.0);
  deck.stage(10).gravity_y = -1.0;
  StageCards& push = deck.stage(20);
  for (int j = 0; j < block.rows; ++j) push.pressure(block.element(0, j), 4, pressure, pressure);
  return deck.text();
}

RunSettings never_condensed() {
  RunSettings settings;
  settings.skips.condensation = false;
  settings.skips.prediction = false;
  return settings;
}

double far_apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

// Every increment, of as many as both have.  tolerance: 1e-8 of forces, times what that is of displacements.
void expect_same_way(const WholeRun& a, const WholeRun& b, double tolerance) {
  ASSERT_EQ(a.increments.size(), b.increments.size());
  for (std::size_t i = 0; i < a.increments.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_DOUBLE_EQ(a.increments[i].load_factor, b.increments[i].load_factor);
    EXPECT_EQ(a.increments[i].cuts, b.increments[i].cuts);
  }
  expect_same_increments(a, b, tolerance);
}

TEST(BorderSteps, AreTakenWhereLoadsGrowEvenly) {
  EXPECT_EQ(run_text(pressed_specimen(40)).result.work.border_steps, 34);  // not 1, 2, 5, 11, 23 and 40
  const WholeRun pushed = run_text(pushed_block(3.0));
  EXPECT_GT(pushed.result.work.condensed, 100);
  EXPECT_EQ(pushed.result.work.border_steps, 6 + 15);
  RunSettings up_to_date;
  up_to_date.skips.states = false;
  EXPECT_EQ(run_text(pushed_block(3.0), {}, up_to_date).result.work.border_steps, 0);
}

TEST(BorderSteps, LeadWhereTheWholeSystemDoes) {
  for (const std::string& deck : {pressed_specimen(40), pushed_block(3.0)})
    expect_same_way(run_text(deck), run_text(deck, {}, never_condensed()), 1e-9);
}

// Where the region is filled in it has moved in several steps, and corrections count beside the motion of the last one.
TEST(BorderSteps, EndAStageAsNearToEquilibriumAsTheWholeSystem) {
  const std::string deck = pushed_block(3.0, true, 1e5);
  RunSettings up_to_date;
  up_to_date.skips.states = false;
  const WholeRun waits = run_text(deck), filled_in = run_text(deck, {}, up_to_date);
  EXPECT_GT(waits.result.work.border_steps, 10);
  ASSERT_EQ(waits.increments.size(), 30u);
  for (const std::size_t end : {9u, 29u})
    EXPECT_GE(waits.increments[end].iterations, filled_in.increments[end].iterations) << end;
  expect_same_way(waits, run_text(deck, {}, never_condensed()), 1e-8);
}

// Steps that are cut begin at a state that was filled in for them.
TEST(BorderSteps, AreCutAsTheWholeSystemIs) {
  const WholeRun cut = run_text(pressed_specimen(40, 2));
  ASSERT_TRUE(cut.completed());
  int cuts = 0;
  for (const auto& increment : cut.increments) cuts += increment.cuts;
  EXPECT_GT(cuts, 0);
  EXPECT_GT(cut.result.work.border_steps, 10);
  expect_same_way(cut, run_text(pressed_specimen(40, 2), {}, never_condensed()), 1e-7);
}

// The last state in equilibrium of a block that slips away, on a joint without stiffness after slip, is there to the last
// node.
TEST(BorderSteps, AreFilledInAfterAFailure) {
  const WholeRun slipped = run_text(pushed_block(12.0, true, 5000.0, 0.0));
  const WholeRun reference = run_text(pushed_block(12.0, true, 5000.0, 0.0), {}, never_condensed());
  EXPECT_FALSE(slipped.completed());
  EXPECT_GT(slipped.result.work.border_steps, 0);
  EXPECT_EQ(slipped.result.status, reference.result.status);
  expect_same_way(slipped, reference, 1e-6);
}

// Looks at every third increment, if at any but the last.
class Passer final : public Observer {
 public:
  explicit Passer(bool looks) : looks_(looks) {}
  bool wants_states(const Model&, const StepReport& report) const override {
    return looks_ && report.increment % 3 == 0;
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char> behind) const override {
    inner_nodes = static_cast<int>(std::ranges::count(behind, char{1}));
    return wants_states(model, report);
  }
  void on_increment(const Model&, const StepReport& report, const Solution& now) override {
    iterations.push_back(report.total_iterations);
    known_motion.push_back(!std::isnan(report.motion));
    u = *now.u;
    internal = *now.internal;
  }

  std::vector<int> iterations;
  std::vector<bool> known_motion;
  Eigen::VectorXd u, internal;
  mutable int inner_nodes = 0;

 private:
  bool looks_;
};

TEST(BorderSteps, WhoeverLooksChangesNoBit) {
  const Catalogue all = app::full_catalogue();
  const WholeRun kept = run_text(pressed_specimen(20));
  Passer passers[] = {Passer(false), Passer(true)};
  for (Passer& passer : passers) {
    Observer* observers[] = {&passer};
    RunSettings settings;
    settings.solver = 1;
    const RunResult result = run(*kept.model, all, settings, observers);
    ASSERT_EQ(result.status, RunStatus::completed);
    EXPECT_EQ(result.work.border_steps, 15);
  }
  EXPECT_TRUE(passers[0].u == passers[1].u);
  EXPECT_TRUE(passers[0].internal == passers[1].internal);
  EXPECT_EQ(passers[0].iterations, passers[1].iterations);
  EXPECT_EQ(passers[0].known_motion, passers[1].known_motion);
  EXPECT_EQ(std::ranges::count(passers[0].known_motion, false), 15);
  EXPECT_LT(far_apart(passers[0].u, kept.last().u), 1e-10);
  EXPECT_EQ(passers[0].inner_nodes, 9 * 17 - 8);  // the pair on the axis moves down alone
}

// Reads displacements and forces after every increment and needs no stresses, as a host program may.
class Follower final : public Observer {
 public:
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  void on_increment(const Model&, const StepReport&, const Solution& now) override {
    u.push_back(*now.u);
    internal.push_back(*now.internal);
  }

  std::vector<Eigen::VectorXd> u, internal;
};

TEST(BorderSteps, AnObserverWithoutStressesReadsThisIncrement) {
  const WholeRun kept = run_text(pressed_specimen(20));  // its observer reads stresses after every increment
  Follower follower;
  Observer* observers[] = {&follower};
  RunSettings settings;
  settings.solver = 1;
  const RunResult result = run(*kept.model, app::full_catalogue(), settings, observers);
  ASSERT_EQ(result.status, RunStatus::completed);
  EXPECT_EQ(result.work.border_steps, 15);
  ASSERT_EQ(follower.u.size(), kept.increments.size());
  for (std::size_t i = 0; i < follower.u.size(); ++i) {
    EXPECT_LT(far_apart(follower.u[i], kept.increments[i].u), 1e-10) << i;
    EXPECT_LT(far_apart(follower.internal[i], kept.increments[i].internal), 1e-10) << i;
  }
}

// Sums over inner nodes in every row; those over the joint's other side need nothing filled in.
TEST(BorderSteps, ReportsAreUpToDate) {
  const Catalogue all = app::full_catalogue();
  for (const bool inner : {true, false}) {
    const WholeRun kept = run_text(pushed_block(3.0, inner));
    long products[2] = {0, 0};
    std::vector<std::vector<double>> rows[2];
    for (const bool waits : {true, false}) {
      Reports reports(testing::TempDir(), inner ? "border_steps_inner" : "border_steps_base");
      Observer* observers[] = {&reports};
      RunSettings settings;
      settings.solver = 1;
      settings.skips.states = waits;
      const RunResult result = run(*kept.model, all, settings, observers);
      ASSERT_EQ(result.status, RunStatus::completed);
      products[waits] = result.work.linear_products;
      for (std::size_t row = 0; row < reports.rows(0); ++row) rows[waits].push_back(reports.values(0, row));
    }
    EXPECT_EQ(products[true] > products[false] / 2, inner);
    ASSERT_EQ(rows[true].size(), 30u);
    ASSERT_EQ(rows[false].size(), 30u);
    const std::vector<double>& last = rows[false].back();
    for (std::size_t row = 0; row < 30; ++row)
      for (std::size_t i = 0; i < last.size(); ++i) {
        const double now = rows[true][row][i], expected = rows[false][row][i];
        ASSERT_EQ(std::isnan(now), std::isnan(expected)) << row << ", " << i;
        if (std::isnan(now)) continue;
        // Beside the last, or a thousandth of the block's weight: forces of the top are rounding.
        EXPECT_NEAR(now, expected, 1e-9 * std::max(0.02, std::abs(last[i]))) << row << ", " << i;
      }
  }
}

}  // namespace
}  // namespace sage::test
