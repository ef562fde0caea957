// An analysis that a host program takes from increment to increment.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "sage/analysis/analysis.hpp"
#include "sage/app/commands.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

const Workbench& workbench() {
  static const Workbench bench = app::make_workbench();
  return bench;
}

// What a host reads.
struct Reading {
  Eigen::VectorXd u, internal;
};

class Host {
 public:
  explicit Host(Model& model)
      : analysis_(model, workbench().catalogue(), workbench().settings()), is_open_(analysis_.open()) {}

  bool advance() {
    if (!is_open_ || !analysis_.advance()) return false;
    const Solution now = analysis_.state();
    readings_.push_back({*now.u, *now.internal});
    return true;
  }
  Analysis& analysis() { return analysis_; }
  const std::vector<Reading>& readings() const { return readings_; }

 private:
  Analysis analysis_;
  bool is_open_;
  std::vector<Reading> readings_;
};

std::string stepped_specimen(bool plastic, int increments) {
  SpecimenDeck deck;
  deck.columns = plastic ? 3 : 8;
  deck.rows = plastic ? 5 : 16;
  deck.increments = increments;
  deck.axial_strain = plastic ? 0.03 : 0.01;
  deck.drucker_prager = plastic;
  return deck.text();
}

void expect_the_run(const std::string& deck, const Host& host) {
  const WholeRun whole = run_text(deck);
  ASSERT_EQ(host.readings().size(), whole.increments.size());
  for (std::size_t i = 0; i < whole.increments.size(); ++i) {
    EXPECT_TRUE(host.readings()[i].u == whole.increments[i].u) << "increment " << i;
    EXPECT_TRUE(host.readings()[i].internal == whole.increments[i].internal) << "increment " << i;
  }
}

// Plastic with joints, and elastic with a condensed region, whose inside is recovered for the host alone.
TEST(Stepping, TwoInterleavedAnalysesAreThoseOfTheirRuns) {
  const std::string decks[] = {stepped_specimen(true, 4), stepped_specimen(false, 6)};
  Model models[] = {workbench().build(decks[0]), workbench().build(decks[1])};
  Host first(models[0]), second(models[1]);
  bool more = true;
  while (more) {
    const bool one = first.advance(), other = second.advance();
    more = one || other;
  }
  EXPECT_GT(second.analysis().close().work.condensed, 200);
  EXPECT_EQ(first.analysis().close().status, RunStatus::completed);
  expect_the_run(decks[0], first);
  expect_the_run(decks[1], second);
}

// Also of one and the same model.
TEST(Stepping, TwoThreadsWithAnAnalysisEachAreThoseOfTheirRuns) {
  const std::string deck = stepped_specimen(true, 4);
  Model model = workbench().build(deck);
  Host first(model), second(model);
  const auto finish = [](Host& host) {
    while (host.advance()) {
    }
  };
  std::thread thread(finish, std::ref(first));
  finish(second);
  thread.join();
  expect_the_run(deck, first);
  expect_the_run(deck, second);
}

// Libraries have variables of their own that belong to the process.
TEST(Stepping, ThreadsMayUseLibrarySolvers) {
  const std::string deck = stepped_specimen(true, 4);
  Model model = workbench().build(deck);
  for (const char* solver : {"umfpack", "mumps"}) {
    SCOPED_TRACE(solver);
    RunSettings settings = workbench().settings();
    settings.solver = workbench().catalogue().solvers.code_of(solver);
    if (settings.solver == 0) continue;  // MUMPS is optional
    const WholeRun whole = run_text(deck, {}, settings);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    std::array<Eigen::VectorXd, 2> ends;
    const auto finish = [&](Eigen::VectorXd& end) {
      Analysis analysis(model, workbench().catalogue(), settings);
      analysis.open();
      while (analysis.advance()) {
      }
      end = *analysis.state().u;
    };
    std::thread thread(finish, std::ref(ends[0]));
    finish(ends[1]);
    thread.join();
    EXPECT_TRUE(ends[0] == whole.last().u);
    EXPECT_TRUE(ends[1] == whole.last().u);
  }
}

// A square of 1 m between smooth sides, E = 1000 kPa and nu = 0, under a pressure q: it sinks by q H / E.
constexpr double kYoung = 1000.0;

std::string pressed_square(double pressure, int increments) {
  DeckWriter deck(1);
  Block block;
  block.columns = block.rows = 2;
  block.place = rectangle(0.0, 1.0, 0.0, 1.0);
  block.write_nodes(deck);
  deck.material(1, 1, {kYoung, 0.0}, 0.0, "soil");
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (const int node : block.bottom()) deck.fix(node, 1, 1);
  for (int j = 1; j <= 2; ++j)
    for (const int i : {0, 2}) deck.fix(block.node(i, j), 1, 0);
  StageCards& stage = deck.stage(increments);
  for (int i = 0; i < 2; ++i) stage.pressure(block.element(i, 1), 3, pressure, pressure);
  return deck.text();
}

double settlement_of(Analysis& analysis, const Model& model) {
  return -(*analysis.state().u)[DofMap::displacement(model.mesh.nodes() - 1, 1)];
}

void set_pressures(Stage& stage, double pressure) {
  for (EdgeLoad& load : stage.pressures) load.normal[0] = load.normal[1] = pressure;
}

// From 4 of 10 increments of 100 kPa on towards 220 kPa: 40, then 40 + 30 kPa, and so on.
TEST(Stepping, AHostChangesALoadAndGoesOn) {
  Model model = workbench().build(pressed_square(100.0, 10));
  Analysis analysis(model, workbench().catalogue(), workbench().settings());
  ASSERT_TRUE(analysis.open());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(analysis.advance());
  EXPECT_NEAR(settlement_of(analysis, model), 40.0 / kYoung, 1e-12);
  set_pressures(model.stages[0], 220.0);
  analysis.take_loads();
  EXPECT_NEAR(settlement_of(analysis, model), 40.0 / kYoung, 1e-12) << "nothing has moved yet";
  for (int i = 5; i <= 10; ++i) {
    ASSERT_TRUE(analysis.advance());
    EXPECT_NEAR(settlement_of(analysis, model), (40.0 + 30.0 * (i - 4)) / kYoung, 1e-12) << "increment " << i;
  }
  EXPECT_TRUE(analysis.is_complete());
  EXPECT_FALSE(analysis.advance());
  const RunResult result = analysis.close();
  EXPECT_EQ(result.status, RunStatus::completed);
  EXPECT_EQ(result.increments_done, 10);
}

// Ground 4 m x 8 m under a strip load at its surface, plastic in the rows below it and elastic further down.
std::string loaded_ground(int plastic_rows, const std::vector<std::pair<double, int>>& pressures) {
  constexpr int kColumns = 8, kRows = 16, kAcross = kColumns + 1;
  DeckWriter deck(1);
  Block block;
  block.columns = kColumns;
  block.rows = kRows;
  block.place = rectangle(0.0, 4.0, 0.0, 8.0);
  block.write_nodes(deck);
  deck.material(1, 1, {1e4, 0.3}, 0.0, "base");
  deck.material(2, 3, {1e4, 0.3, plastic_rows == 1 ? 4.0 : 10.0, 20.0}, 0.0, "ground");
  deck.group(1, 1, 2, 1);
  deck.group(2, 1, 2, 2);
  const int elastic_rows = kRows - plastic_rows, first = elastic_rows * kAcross + 1;
  if (elastic_rows > 0)
    deck.elements_block(1, 1, {1, 2, 2 + kAcross, 1 + kAcross}, kColumns, elastic_rows, 1, kAcross);
  deck.elements_block(elastic_rows * kColumns + 1, 2, {first, first + 1, first + 1 + kAcross, first + kAcross},
                      kColumns, plastic_rows, 1, kAcross);
  for (const int node : block.bottom()) deck.fix(node, 1, 1);
  for (int j = 1; j <= kRows; ++j)
    for (const int i : {0, kColumns}) deck.fix(block.node(i, j), 1, 0);
  for (const auto& [pressure, increments] : pressures) {
    StageCards& stage = deck.stage(increments);
    for (int i = 0; i < 3; ++i) stage.pressure(block.element(i, kRows - 1), 3, pressure, pressure);
  }
  return deck.text();
}

// 4 of 10 increments of 100 kPa and then 6 towards 70 kPa are the load path of two stages: to 40 kPa, and 30 kPa more.
// With one plastic row the base is condensed, and in the rest of the stage no longer.
TEST(Stepping, ChangedLoadsAreTheLoadPathOfTwoStages) {
  for (const int plastic_rows : {1, 15}) {
    SCOPED_TRACE(plastic_rows);
    const WholeRun stages = run_text(loaded_ground(plastic_rows, {{40.0, 4}, {30.0, 6}}));
    ASSERT_TRUE(stages.completed()) << stages.failure;
    EXPECT_GT(stages.last().points[static_cast<std::size_t>(PointStatus::yielded)], 0);
    Model model = workbench().build(loaded_ground(plastic_rows, {{100.0, 10}}));
    Host host(model);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(host.advance());
    set_pressures(model.stages[0], 70.0);
    host.analysis().take_loads();
    while (host.advance()) {
    }
    ASSERT_EQ(host.readings().size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) {
      const Snapshot& expected = stages.increments[i];
      EXPECT_LT((host.readings()[i].u - expected.u).norm(), 1e-6 * expected.u.norm()) << "increment " << i;
    }
    const RunResult result = host.analysis().close();
    EXPECT_EQ(result.status, RunStatus::completed);
    EXPECT_EQ(result.work.condensed > 0, plastic_rows == 1);
  }
}

// The whole pressure is then that of the last stage whose card was changed, as in a deck with those loads.
TEST(Stepping, AStageThatIsNotOpenStartsWithItsLoadsAsTheyAreThen) {
  Model model = workbench().build(pressed_square(100.0, 2));
  model.stages.push_back(model.stages[0]);
  Analysis analysis(model, workbench().catalogue(), workbench().settings());
  ASSERT_TRUE(analysis.open());
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(analysis.advance());
  EXPECT_EQ(analysis.stage(), 1);
  EXPECT_EQ(analysis.increment(), 0);
  set_pressures(model.stages[1], 60.0);
  ASSERT_TRUE(analysis.advance());
  EXPECT_NEAR(settlement_of(analysis, model), 130.0 / kYoung, 1e-12);
  EXPECT_EQ(analysis.close().status, RunStatus::stopped) << "an increment is left";
}

// Loads that are taken again without a change change nothing but rounding, with joints and a condensed region, too.
TEST(Stepping, TakingTheSameLoadsAgainChangesNothing) {
  for (const bool plastic : {false, true}) {
    SCOPED_TRACE(plastic);
    const std::string deck = stepped_specimen(plastic, 6);
    const WholeRun whole = run_text(deck);
    Model model = workbench().build(deck);
    Host host(model);
    for (int i = 1; host.advance(); ++i)
      if (i == 3) host.analysis().take_loads();
    ASSERT_EQ(host.readings().size(), whole.increments.size());
    const Eigen::VectorXd& u = host.readings().back().u;
    EXPECT_LT((u - whole.last().u).norm(), 1e-7 * whole.last().u.norm());
  }
}

TEST(Stepping, AnAnalysisThatIsStoppedStillHasItsLastState) {
  const std::string deck = stepped_specimen(true, 4);
  const WholeRun whole = run_text(deck);
  Model model = workbench().build(deck);
  RunSettings settings = workbench().settings();
  bool stops = false;
  settings.stop_asked = [&] { return stops; };
  Analysis analysis(model, workbench().catalogue(), settings);
  ASSERT_TRUE(analysis.open());
  ASSERT_TRUE(analysis.advance());
  ASSERT_TRUE(analysis.advance());
  stops = true;
  EXPECT_FALSE(analysis.advance());
  EXPECT_TRUE(*analysis.state().u == whole.increments[1].u);
  EXPECT_LT((*analysis.state().internal - whole.increments[1].internal).norm(),
            1e-9 * whole.increments[1].internal.norm());
  EXPECT_EQ(analysis.close().status, RunStatus::stopped);
}

TEST(Stepping, FunctionsOutOfOrderAreMistakes) {
  Model model = workbench().build(pressed_square(100.0, 2));
  Analysis analysis(model, workbench().catalogue(), workbench().settings());
  EXPECT_THROW(analysis.advance(), std::logic_error);
  ASSERT_TRUE(analysis.open());
  EXPECT_THROW(analysis.open(), std::logic_error);
  EXPECT_EQ(analysis.close().status, RunStatus::stopped);
  EXPECT_THROW(analysis.advance(), std::logic_error);
  EXPECT_THROW(analysis.close(), std::logic_error);
}

// Increments of 1, 2, 4 and 8 parts of 15.
TEST(Stepping, GradedIncrementsDivideTheLoadPath) {
  Model model = workbench().build(pressed_square(150.0, 4));
  const GradedIncrements graded(2.0);
  RunSettings settings = workbench().settings();
  settings.time_scheme = &graded;
  Analysis analysis(model, workbench().catalogue(), settings);
  ASSERT_TRUE(analysis.open());
  for (const double pressure : {10.0, 30.0, 70.0, 150.0}) {
    ASSERT_TRUE(analysis.advance());
    EXPECT_NEAR(settlement_of(analysis, model), pressure / kYoung, 1e-12);
  }
  EXPECT_TRUE(analysis.is_complete());
}

// Of a scheme of one's own, too, and from a checkpoint within the stage.
TEST(Stepping, ASchemeOfOnesOwnIsResumed) {
  struct Rooted final : TimeScheme {
    double load_factor(int, int increment, int increments) const override {
      return std::sqrt(static_cast<double>(increment) / increments);
    }
  } const rooted;
  std::string saved;
  int increments = 0;
  RunSettings settings;
  settings.time_scheme = &rooted;
  settings.checkpoint_due = [&] { return ++increments == 3; };
  settings.save_checkpoint = [&](const std::string& state) { saved = state; };
  const std::string deck = stepped_specimen(true, 6);
  const WholeRun whole = run_text(deck, {}, settings);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  EXPECT_DOUBLE_EQ(whole.increments[2].load_factor, std::sqrt(0.5));
  RunSettings resumed;
  resumed.time_scheme = &rooted;
  resumed.resume_from = saved;
  const WholeRun rest = run_text(deck, {}, resumed);
  EXPECT_TRUE(rest.last().u == whole.last().u);
  EXPECT_TRUE(rest.last().internal == whole.last().internal);
}

TEST(Stepping, ASchemeThatDoesNotReachTheEndOfItsStageIsAMistake) {
  struct Short final : TimeScheme {
    double load_factor(int, int increment, int increments) const override {
      return 0.9 * increment / increments;
    }
  } const too_short;
  RunSettings settings;
  settings.time_scheme = &too_short;
  EXPECT_THROW(run_text(pressed_square(100.0, 2), {}, settings), std::logic_error);
}

}  // namespace
}  // namespace sage::test
