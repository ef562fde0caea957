// Elements of one's own with history, a geometry that is recomputed, two laws, and a matrix for each step size: the truss and the
// consolidating bar of tests/install/consumer.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/model/dof_map.hpp"
#include "tests/install/consumer/consolidation.hpp"
#include "tests/install/consumer/truss.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/support/csv_column.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/two_bars.hpp"

namespace sage {
namespace {

namespace fs = std::filesystem;
using scenes::DeckWriter;
using scenes::WholeRun;

constexpr int kTruss = 1060, kConsolidation = 1061, kRod = 80;

Catalogue with_own() {
  Catalogue catalogue = app::full_catalogue();
  catalogue.elements.add(kTruss, own::truss2());
  catalogue.elements.add(kConsolidation, own::consolidation2());
  catalogue.materials.add(kRod, own::rod());
  return catalogue;
}

scenes::Workbench bench() {
  return {with_own(), [](const SystemSize&) { return 1; }};
}

// The committed history of the first group, increment by increment.
struct Histories final : Observer {
  std::vector<std::vector<double>> h;
  void on_increment(const Model&, const StepReport&, const Solution& now) override {
    h.push_back(now.groups().front().state.committed.h);
  }
};

DeckWriter truss() {
  return test::two_bars(kTruss, kRod);
}
double length_at(double v) {
  return std::hypot(3.0, 4.0 + v);
}
double stretch_at(double v) {
  return length_at(v) / 5.0 - 1.0;
}
// Load that holds the node v below (0, 0).
double load_at(double v) {
  return 2.0 * 200.0 * stretch_at(v) * (4.0 + v) / length_at(v);
}

// Down by 2, where both bars are a third longer, and back to 0.
DeckWriter down_and_back() {
  DeckWriter deck = truss();
  deck.stage(2).fix(3, 1, 1, 0.0, -2.0);
  deck.stage(2).fix(3, 1, 1, 0.0, 2.0);
  return deck;
}

TEST(OutsideHistory, AnElementThatRecomputesItsGeometryHasTheForcesOfTheMovedTruss) {
  const WholeRun run = bench().run(down_and_back().text());
  ASSERT_TRUE(run.completed()) << run.failure;
  ASSERT_EQ(run.increments.size(), 4u);
  const double v[] = {1.0, 2.0, 1.0, 0.0};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(run.reaction(run.increments[i], 3).y(), -load_at(v[i]), 1e-10 * load_at(2.0)) << i;
}

// By load: Newton's method finds the displacement, with a tangent that sees the rotation of the bars.
TEST(OutsideHistory, NewtonFindsTheMovedTruss) {
  DeckWriter deck = truss();
  scenes::StageCards& stage = deck.stage();
  stage.tolerance = 1e-10;
  stage.load(3, 0.0, -100.0);
  const WholeRun run = bench().run(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(load_at(-run.u(3).y()), 100.0, 1e-6);
  EXPECT_LE(run.iterations(), 8) << "quadratic";
}

TEST(OutsideHistory, HistoryOfAnElementIsCommittedAndRestarted) {
  const std::string deck = down_and_back().text();
  Histories whole;
  Observer* observers[] = {&whole};
  std::vector<std::string> checkpoints;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { checkpoints.push_back(bytes); };
  ASSERT_TRUE(bench().run(bench().build(deck), settings, observers).completed());
  ASSERT_EQ(whole.h.size(), 4u);
  const double largest[] = {stretch_at(1.0), stretch_at(2.0), stretch_at(2.0), stretch_at(2.0)};
  for (std::size_t i = 0; i < 4; ++i)
    for (const double h : whole.h[i]) EXPECT_NEAR(h, largest[i], 1e-14) << i;
  ASSERT_FALSE(checkpoints.empty());
  for (const std::string& bytes : checkpoints) {
    RunSettings again;
    again.resume_from = bytes;
    Histories rest;
    Observer* also[] = {&rest};
    ASSERT_TRUE(bench().run(bench().build(deck), again, also).completed());
    if (!rest.h.empty()) {
      EXPECT_EQ(rest.h.back(), whole.h.back());
    }
  }
}

TEST(OutsideHistory, HistoryOfAnElementIsWrittenLikeThatOfALaw) {
  const fs::path folder = test::scratch_folder("outside_history");
  std::ofstream(folder / "truss.dat") << down_and_back().text();
  app::RunRequest request;
  request.deck = (folder / "truss.dat").string();
  request.quiet = true;
  request.output.folder = folder;
  request.output.points = true;
  request.output.tables = Tables::all;
  ASSERT_EQ(app::run_deck(request, with_own()).exit_code, app::kOk);
  std::ifstream csv(folder / "truss.structures.csv");
  const std::vector<double> written =
      test::csv_column({std::istreambuf_iterator<char>(csv), {}}, "largest_stretch");
  ASSERT_EQ(written.size(), 4u);  // two bars at the end of two stages
  for (const double value : written) EXPECT_NEAR(value, stretch_at(2.0), 1e-6);
  std::ifstream listing(folder / "truss.lst");
  const std::string text{std::istreambuf_iterator<char>(listing), {}};
  EXPECT_NE(text.find("largest_stretch"), std::string::npos);
}

// A column of bars of length 1 from y = 0, where nothing flows, to its drained top; E = 1000, k = 0.5.
constexpr int kBars = 6;
constexpr int kSteps = 7;
constexpr double kE = 1000.0, kK = 0.5, kLoad = 10.0, kTime = 2.1;

Model column(bool second_law = true) {
  DeckWriter deck(1);
  for (int i = 0; i <= kBars; ++i) deck.node(i + 1, 0.0, i);
  deck.material(1, kRod, {kE, 1.0});
  deck.material(2, kRod, {kK, 1.0});
  deck.group(1, kConsolidation, 0, 1);
  for (int i = 0; i < kBars; ++i) deck.element(i + 1, 1, {i + 1, i + 2});
  deck.fix(1, 1, 1);
  for (int i = 1; i <= kBars; ++i) deck.fix(i + 1, 1, 0);
  deck.stage(kSteps).load(kBars + 1, 0.0, -kLoad);
  Model model = bench().build(deck.text());
  if (second_law) model.groups[0].second_material = 1;
  model.field_fixities.push_back({1, kBars, FixityCode::fixed, 0.0, 0});
  model.stages[0].duration = kTime;
  model.stages[0].tolerance = 1e-12;
  return model;
}

// [E/L G, -Q; Q^T/dt, H] of all nodes; unknowns u_1 ... u_n, then p_0 ... p_(n-1).
Eigen::VectorXd backward_euler(const Eigen::VectorXd& before, double dt, double load) {
  const int n = kBars;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2);
  for (int e = 0; e < n; ++e)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        const double sign = i == j ? 1.0 : -1.0, end = i == 0 ? -1.0 : 1.0;
        K(e + i, e + j) += sign * kE;
        K(e + i, n + 1 + e + j) -= 0.5 * end;
        K(n + 1 + e + j, e + i) += 0.5 * end / dt;
        K(n + 1 + e + i, n + 1 + e + j) += sign * kK;
      }
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * n + 2);
  b.tail(n + 1) = K.bottomLeftCorner(n + 1, n + 1) * before.head(n + 1);
  b[n] = -load;
  for (const int held : {0, 2 * n + 1}) {
    K.row(held).setZero();
    K(held, held) = 1.0;
    b[held] = 0.0;
  }
  return K.fullPivLu().solve(b);
}

// The load grows in seven steps, whose sizes differ by the rounding of their times alone: one factorisation.
TEST(OutsideHistory, OneFactorisationServesAllStepsOfASize) {
  const Model model = column();
  const WholeRun run = bench().run(column());
  ASSERT_TRUE(run.completed()) << run.failure;
  ASSERT_EQ(run.increments.size(), std::size_t{kSteps});
  EXPECT_EQ(run.result.work.factorisations, 1);
  const DofMap map(model);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(2 * kBars + 2);
  for (std::size_t i = 0; i < kSteps; ++i) {
    expected = backward_euler(expected, kTime / kSteps, kLoad * static_cast<double>(i + 1) / kSteps);
    for (int node = 0; node <= kBars; ++node) {
      EXPECT_NEAR(run.increments[i].u[DofMap::displacement(node) + 1], expected[node], 1e-9 * kLoad / kE);
      EXPECT_NEAR(run.increments[i].u[map.of(node, 1)], expected[kBars + 1 + node], 1e-9 * kLoad);
    }
  }
}

// A stage that begins while water flows goes on with it: what the elements store is no load that fades.
TEST(OutsideHistory, StoredRatesGoOnInTheNextStage) {
  Model model = column();
  Stage next = model.stages[0];
  next.number = 2;
  next.loads.clear();
  model.stages.push_back(next);
  const DofMap map(model);
  const WholeRun run = bench().run(std::move(model));
  ASSERT_TRUE(run.completed()) << run.failure;
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(2 * kBars + 2);
  for (int i = 0; i < 2 * kSteps; ++i)
    expected = backward_euler(expected, kTime / kSteps, kLoad * std::min(1.0, (i + 1.0) / kSteps));
  for (int node = 0; node <= kBars; ++node) {
    EXPECT_NEAR(run.last().u[DofMap::displacement(node) + 1], expected[node], 1e-9 * kLoad / kE);
    EXPECT_NEAR(run.last().u[map.of(node, 1)], expected[kBars + 1 + node], 1e-9 * kLoad);
  }
}

TEST(OutsideHistory, AMissingSecondLawIsAnError) {
  try {
    bench().run(column(false));
    ADD_FAILURE() << "it ran";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("group 1 needs a second material"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace sage
