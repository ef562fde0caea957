// A run that is resumed from any of its checkpoints ends bit for bit where the uninterrupted run ends.
#include <gtest/gtest.h>

#include <functional>

#include "sage/model/fingerprint.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

struct Interrupted {
  WholeRun whole;
  std::vector<std::string> checkpoints;
};

Interrupted run_with_checkpoints(const std::string& deck) {
  Interrupted result;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& state) { result.checkpoints.push_back(state); };
  result.whole = run_text(deck, {}, settings);
  return result;
}

void expect_same_end(const WholeRun& a, const WholeRun& b) {
  EXPECT_EQ(a.result.status, b.result.status);
  EXPECT_EQ(a.result.increments_done, b.result.increments_done);
  EXPECT_EQ(a.result.stages_done, b.result.stages_done);
  EXPECT_EQ(a.result.work.analyses, b.result.work.analyses);  // they stand in the listing
  EXPECT_EQ(a.result.work.factorisations, b.result.work.factorisations);
  EXPECT_EQ(a.result.work.kept_factors, b.result.work.kept_factors);
  EXPECT_EQ(a.result.work.solves, b.result.work.solves);
  EXPECT_TRUE(a.last().u == b.last().u);
  EXPECT_TRUE(a.last().internal == b.last().internal);
  EXPECT_TRUE(a.last().external == b.last().external);
  EXPECT_EQ(a.last().points, b.last().points);
  ASSERT_EQ(a.stress.size(), b.stress.size());
  for (std::size_t g = 0; g < a.stress.size(); ++g) EXPECT_TRUE(a.stress[g] == b.stress[g]) << "group " << g;
}

void expect_same_from_every_checkpoint(const std::string& deck, std::size_t checkpoints) {
  const Interrupted first = run_with_checkpoints(deck);
  ASSERT_TRUE(first.whole.completed()) << first.whole.failure;
  ASSERT_EQ(first.checkpoints.size(), checkpoints);
  for (const std::string& state : first.checkpoints) {
    RunSettings settings;
    settings.resume_from = state;
    SCOPED_TRACE("checkpoint " + std::to_string(&state - first.checkpoints.data()));
    expect_same_end(run_text(deck, {}, settings), first.whole);
  }
}

// A plastic specimen on a sliding interface.
std::string specimen(int method, bool plastic = true) {
  SpecimenDeck deck;
  deck.columns = 3;
  deck.rows = 5;
  deck.increments = 8;
  deck.method = method;
  deck.max_iterations = 400;
  deck.axial_strain = 0.06;
  deck.drucker_prager = plastic;
  return deck.text();
}

// An elastic specimen whose region is condensed: from 3000 equations on by a solver that keeps the border.
std::string condensed(int columns, int rows, int increments) {
  SpecimenDeck deck;
  deck.columns = columns;
  deck.rows = rows;
  deck.increments = increments;
  return deck.text();
}

TEST(Restart, CondensedRegionsAreResumedAnywhere) {
  ASSERT_GT(run_text(condensed(8, 16, 8)).result.work.condensed, 200);
  expect_same_from_every_checkpoint(condensed(8, 16, 8), 7);
  ASSERT_GT(run_text(condensed(30, 60, 4)).result.work.condensed, 3000);
  expect_same_from_every_checkpoint(condensed(30, 60, 4), 3);
}

TEST(Restart, NewtonStepsAreResumedAnywhere) {
  expect_same_from_every_checkpoint(specimen(0), 7);
}
TEST(Restart, ModifiedNewtonKeepsItsTangent) {
  expect_same_from_every_checkpoint(specimen(1), 7);
}
TEST(Restart, DoglegStepsAreResumedAnywhere) {
  expect_same_from_every_checkpoint(specimen(3), 7);
}
// Its tangent belongs to the start of the stage: there are checkpoints only between stages.
TEST(Restart, InitialStiffnessHasNoneWithinAStage) {
  expect_same_from_every_checkpoint(specimen(2, false), 0);
}

// Ground with a lift that is born and a part that is dug, under its own weight.
std::string cut_and_fill(int law) {
  DeckWriter deck(1);
  Block ground{4, 2, Cell::quad4, 1, 1, rectangle(0.0, 4.0, -2.0, 0.0)};
  ground.write_nodes(deck);
  for (int n : ground.left()) deck.fix(n, 1, 0);
  for (int n : ground.right()) deck.fix(n, 1, 0);
  for (int n : ground.bottom()) deck.fix(n, 1, 1);
  std::vector<double> parameters{1e4, 0.3};
  if (law != 1) parameters.insert(parameters.end(), {60.0, 30.0, 0.0});
  deck.material(1, law, parameters, 20.0);
  for (int g : {1, 2, 3}) deck.group(g, 1, 0, 1);
  deck.element(1, 1, {1, 2, 7, 6});
  deck.element(2, 1, {2, 3, 8, 7});
  deck.element(3, 2, {3, 4, 9, 8});
  deck.element(4, 2, {4, 5, 10, 9});
  for (int i = 0; i < 4; ++i) deck.element(5 + i, i < 2 ? 3 : 1, {6 + i, 7 + i, 12 + i, 11 + i});
  deck.initial(1, 1, 0.0, 20.0, 0.5, 0.0);
  deck.initial(2, 1, 0.0, 20.0, 0.5, 0.0);
  StageCards& start = deck.stage(2);
  start.births = {3};
  start.gravity_y = -1.0;
  deck.stage(3).deaths = {2};
  return deck.text();
}

TEST(Restart, StagesOfALinearScene) {
  expect_same_from_every_checkpoint(cut_and_fill(1), 1 + 1 + 2);
}
TEST(Restart, StagesWithPlasticity) {
  expect_same_from_every_checkpoint(cut_and_fill(4), 1 + 1 + 2);
}

// What results show besides numbers: a run must not go on in files that show something else.
TEST(Restart, AFingerprintKnowsNumbersAndNames) {
  const std::vector<std::pair<const char*, std::function<void(Model&)>>> changes{
      {"title", [](Model& m) { m.title += "x"; }},
      {"number of a group", [](Model& m) { m.groups[1].number = 77; }},
      {"name of a group", [](Model& m) { m.groups[1].name += "x"; }},
      {"number of an element", [](Model& m) { m.groups[1].element_numbers[0] = 77; }},
      {"number of a material", [](Model& m) { m.materials[0].number = 77; }},
      {"name of a material", [](Model& m) { m.materials[0].name += "x"; }},
  };
  const WholeRun run = run_text(cut_and_fill(1));
  EXPECT_EQ(fingerprint(*run.model), fingerprint(*run_text(cut_and_fill(1)).model));
  for (const auto& [what, change] : changes) {
    const WholeRun other = run_text(cut_and_fill(1));
    change(*other.model);
    EXPECT_NE(fingerprint(*other.model), fingerprint(*run.model)) << what;
  }
}

TEST(Restart, DamagedStatesAreRefused) {
  const Interrupted first = run_with_checkpoints(cut_and_fill(1));
  RunSettings settings;
  for (std::size_t size : {std::size_t{4}, first.checkpoints[0].size() / 2, first.checkpoints[0].size() - 1}) {
    settings.resume_from = first.checkpoints[0].substr(0, size);
    EXPECT_THROW(run_text(cut_and_fill(1), {}, settings), InputError) << size;
  }
  settings.resume_from = first.checkpoints[0] + "x";
  EXPECT_THROW(run_text(cut_and_fill(1), {}, settings), InputError);
}

}  // namespace
}  // namespace sage::test
