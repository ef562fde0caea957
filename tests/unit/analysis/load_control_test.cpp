// Loads that a displacement controls: past the peak of soil that softens.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sage/analysis/load_control.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/model_input.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

const Workbench& bench() {
  static const Workbench made = app::make_workbench();
  return made;
}

WholeRun run_input(const ModelInput& input, const RunSettings& settings = {}) {
  return bench().run(build_model(input, bench().catalogue()), settings);
}

double vertical(const Snapshot& at, int number) {
  return at.u[2 * (number - 1) + 1];
}

// An element of 1 x 1 under two bars of length 1 that carry the load: the softening part and a spring in series.  phi = 0 and
// lateral faces are free, so that the vertical stress is 2 c and sigma_z is the intermediate one.
struct Column {
  static constexpr double kE = 1e4, kNu = 0.3, kPeak = 10.0, kResidual = 2.0, kStrain = 0.08, kLoad = 100.0;
  static constexpr int kTop = 3, kLoaded = 5;
  double bar = 500.0;
  ModelInput input;

  explicit Column(double bar_stiffness) : bar(bar_stiffness) {
    input.nodes = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {0.0, 2.0}, {1.0, 2.0}};
    input.materials = {{"mohr_coulomb_softening",
                        {{"youngs_modulus", kE},
                         {"poissons_ratio", kNu},
                         {"cohesion", kPeak},
                         {"friction_angle", 0.0},
                         {"dilation_angle", 0.0},
                         {"strain_1", kStrain},
                         {"cohesion_1", kResidual},
                         {"friction_angle_1", 0.0},
                         {"dilation_angle_1", 0.0}}},
                       {"axial_elastic", {{"stiffness", bar}}}};
    input.groups = {{"quad4", 1, {{1, 2, 4, 3}}}, {"bar2", 2, {{3, 5}, {4, 6}}}};
    constexpr FixityCode kFree = FixityCode::unchanged, kFixed = FixityCode::fixed;
    input.supports = {{{1}, kFixed, kFixed}, {{2}, kFree, kFixed}, {{5, 6}, kFixed, kFree}};
    StageInput press;
    press.increments = 20;
    press.tolerance = 1e-10;
    press.loads = {{{5, 6}, 0.0, -kLoad}};
    input.stages = {press};
  }
  StageInput& stage() { return input.stages.back(); }

  // With q the vertical stress and lambda the plastic part of the vertical strain: kappa = 2 lambda, q = 2 c(kappa).
  double stress_at(double strain) const {
    const double k = (1.0 - kNu * kNu) / kE, fall = (kPeak - kResidual) / kStrain;
    if (strain <= 2.0 * kPeak * k) return strain / k;
    const double plastic = (strain - 2.0 * kPeak * k) / (1.0 - 4.0 * fall * k);
    if (2.0 * plastic >= kStrain) return 2.0 * kResidual;
    return 2.0 * (kPeak - 2.0 * fall * plastic);
  }
};

void expect_closed_form(const Column& column, const WholeRun& run) {
  bool falls = false;
  double before = 0.0;
  for (const Snapshot& at : run.increments) {
    const double strain = -vertical(at, Column::kTop), q = 2.0 * Column::kLoad * at.load_factor;
    EXPECT_NEAR(q, column.stress_at(strain), 1e-8 * 2.0 * Column::kPeak);
    // Each bar carries half of it.
    EXPECT_NEAR(vertical(at, Column::kTop) - vertical(at, Column::kLoaded), 0.5 * q / column.bar, 1e-10);
    EXPECT_NEAR(at.external[2 * (Column::kLoaded - 1) + 1], -0.5 * q, 1e-10);
    falls = falls || at.load_factor < 0.99 * before;
    before = at.load_factor;
  }
  EXPECT_TRUE(falls);
}

// 4 H ((1 - nu^2) / E + 1 / (2 EA)) = 0.44 < 1 with H = (c - c_r) / strain_1: the loaded node goes on downward behind the peak.
TEST(LoadControl, FollowsASofteningColumnPastItsPeak) {
  Column column(500.0);
  column.stage().load_control = "5 y -0.06";
  const WholeRun run = run_input(column.input);
  ASSERT_TRUE(run.completed()) << run.failure;
  ASSERT_EQ(run.increments.size(), 20U);
  EXPECT_NEAR(vertical(run.last(), 5), -0.06, 1e-14);
  expect_closed_form(column, run);
  // Without control the load stops at the peak, of 2 c = 20 on the element: load factor 0.1.
  Column loaded(500.0);
  const WholeRun peak = run_input(loaded.input);
  EXPECT_EQ(peak.result.status, RunStatus::not_converged);
  EXPECT_LE(peak.last().load_factor, 0.1 + 1e-9);
}

// With 1 / (2 EA) five times as large the same sum is 2.04 > 1: the loaded node has to rise while the element softens.
// Beyond, where the element has softened to the end, there are equilibria again: they are not those of the path.
TEST(LoadControl, NamesASnapBack) {
  Column column(100.0);
  column.stage().load_control = "5 y -0.2";
  const WholeRun run = run_input(column.input);
  EXPECT_EQ(run.result.status, RunStatus::not_converged);
  EXPECT_EQ(run.result.code, Code("S584"));
  for (const char* words : {"snap-back", "displacement of node 5, direction y", "difference of two nodes"})
    EXPECT_NE(run.failure.find(words), std::string::npos) << run.failure;
}

TEST(LoadControl, FollowsASnapBackByADifferenceOfDisplacements) {
  Column column(100.0);
  column.stage().load_control = "3 1 y -0.05";
  const WholeRun run = run_input(column.input);
  ASSERT_TRUE(run.completed()) << run.failure;
  expect_closed_form(column, run);
  double lowest = 0.0;
  for (const Snapshot& at : run.increments) lowest = std::min(lowest, vertical(at, Column::kLoaded));
  EXPECT_GT(vertical(run.last(), Column::kLoaded), lowest + 0.01);  // the snap-back
}

// Soil that softens under a stiff footing whose corner at the axis is loaded or moved.
ModelInput footing() {
  constexpr int kColumns = 5, kRows = 3, kOnFooting = 2;
  ModelInput input;
  const auto node = [](int i, int j) { return j * (kColumns + 1) + i + 1; };
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) input.nodes.emplace_back(i, j);
  GroupInput soil{"quad4", 1, {}}, block{"quad4", 2, {}};
  const auto cell = [](int a, int b, int c, int d) { return std::vector{a, b, c, d}; };
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i)
      soil.elements.push_back(cell(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)));
  const int above = static_cast<int>(input.nodes.size());
  for (int i = 0; i <= kOnFooting; ++i) input.nodes.emplace_back(i, kRows + 1.0);
  for (int i = 0; i < kOnFooting; ++i)
    block.elements.push_back(cell(node(i, kRows), node(i + 1, kRows), above + i + 2, above + i + 1));
  input.materials = {{"mohr_coulomb_softening",
                      {{"youngs_modulus", 1e4},
                       {"poissons_ratio", 0.3},
                       {"cohesion", 10.0},
                       {"friction_angle", 0.0},
                       {"dilation_angle", 0.0},
                       {"strain_1", 0.2},
                       {"cohesion_1", 5.0},
                       {"friction_angle_1", 0.0},
                       {"dilation_angle_1", 0.0}}},
                     {"linear_elastic", {{"youngs_modulus", 1e7}, {"poissons_ratio", 0.2}}}};
  input.groups = {soil, block};
  SupportInput base, sides;
  base.x = base.y = sides.x = FixityCode::fixed;
  for (int i = 0; i <= kColumns; ++i) base.nodes.push_back(node(i, 0));
  for (int j = 1; j <= kRows; ++j)
    for (const int i : {0, kColumns}) sides.nodes.push_back(node(i, j));
  sides.nodes.push_back(above + 1);
  input.supports = {base, sides};
  StageInput stage;
  stage.increments = 20;
  stage.tolerance = 1e-10;
  input.stages = {stage};
  return input;
}

constexpr int kCorner = 25;  // of the footing's top, at the axis
constexpr double kPush = 0.4;

WholeRun controlled_footing(const RunSettings& settings = {}) {
  ModelInput input = footing();
  input.stages[0].loads = {{{kCorner}, 0.0, -100.0}};
  input.stages[0].load_control = "25 y -0.4";
  return run_input(input, settings);
}

// Both prescribe the same motion of the node, and are in equilibrium with the same force on it.
TEST(LoadControl, IsThePushOfTheSameFooting) {
  const WholeRun controlled = controlled_footing();
  ModelInput input = footing();
  SupportInput push{{kCorner}};
  push.y = FixityCode::fixed;
  push.y_value = -kPush;
  input.stages[0].supports = {push};
  const WholeRun pushed = run_input(input);
  ASSERT_TRUE(controlled.completed()) << controlled.failure;
  ASSERT_TRUE(pushed.completed()) << pushed.failure;
  double peak = 0.0;
  for (std::size_t i = 0; i < pushed.increments.size(); ++i) {
    const double force = -pushed.reaction(pushed.increments[i], kCorner).y();
    EXPECT_NEAR(100.0 * controlled.increments[i].load_factor, force, 1e-6 * force) << "increment " << i + 1;
    const Eigen::VectorXd apart = controlled.increments[i].u - pushed.increments[i].u;
    EXPECT_LT(apart.lpNorm<Eigen::Infinity>(), 1e-6 * kPush) << "increment " << i + 1;
    peak = std::max(peak, force);
  }
  EXPECT_LT(100.0 * controlled.last().load_factor, 0.9 * peak);
}

TEST(LoadControl, GoesOnFromEveryCheckpointToTheSameBits) {
  std::vector<std::string> checkpoints;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& state) { checkpoints.push_back(state); };
  const WholeRun whole = controlled_footing(settings);
  ASSERT_EQ(checkpoints.size(), 19U);
  for (const std::size_t at : {0U, 9U, 17U}) {
    RunSettings resumed;
    resumed.resume_from = checkpoints[at];
    const WholeRun run = controlled_footing(resumed);
    EXPECT_EQ(run.last().load_factor, whole.last().load_factor);
    EXPECT_TRUE(run.last().u == whole.last().u) << "checkpoint " << at;
    EXPECT_TRUE(run.last().internal == whole.last().internal) << "checkpoint " << at;
    EXPECT_EQ(run.result.work.factorisations, whole.result.work.factorisations);
  }
}

// An elastic column at twice the displacement carries twice the load, to rounding; beside, condensation is left out.
TEST(LoadControl, OfALinearModelIsExact) {
  Column column(500.0);
  column.input.materials[0] = {"linear_elastic", {{"youngs_modulus", Column::kE}, {"poissons_ratio", 0.0}}};
  column.stage().load_control = "5 y -0.2";
  const WholeRun run = run_input(column.input);
  ASSERT_TRUE(run.completed()) << run.failure;
  const double factor = 0.2 / (2.0 * Column::kLoad / Column::kE + Column::kLoad / column.bar);
  EXPECT_NEAR(run.last().load_factor, factor, 1e-12 * factor);
}

std::string rejection(const std::function<void(ModelInput&)>& change) {
  Column column(500.0);
  column.stage().load_control = "5 y -0.06";
  change(column.input);
  try {
    build_model(column.input, bench().catalogue());
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(LoadControl, RejectsWhatDoesNotSuit) {
  const auto with = [](const std::string& text) {
    return rejection([&](ModelInput& i) { i.stages[0].load_control = text; });
  };
  for (const char* text : {"5", "5 z 1", "5 y 0", "5 y", "5.5 y 1", "5 5 y 1", "5 y nan", "5 6 1 y 1", "y 5 1"})
    EXPECT_NE(with(text).find("is no control of the load"), std::string::npos) << text << ": " << with(text);
  EXPECT_NE(with("77 y 1"), "");
  const std::pair<const char*, std::function<void(ModelInput&)>> cases[] = {
      {"Newton", [](ModelInput& i) { i.stages[0].method = Method::modified_newton; }},
      {"large strain", [](ModelInput& i) { i.large_strain = true; }},
      {"no load", [](ModelInput& i) { i.stages[0].loads.clear(); }},
      {"last stage", [](ModelInput& i) { i.stages.emplace_back(); }},
      {"must not prescribe", [](ModelInput& i) {
         SupportInput moved{{2}};
         moved.y = FixityCode::fixed;
         moved.y_value = 0.1;
         i.stages[0].supports = {moved};
       }}};
  for (const auto& [words, change] : cases)
    EXPECT_NE(rejection(change).find(words), std::string::npos) << words << ": " << rejection(change);
}

TEST(LoadControl, NeedsADisplacementThatIsFree) {
  Column column(500.0);
  column.stage().load_control = "1 y -0.06";
  const WholeRun run = run_input(column.input);
  EXPECT_EQ(run.result.status, RunStatus::failed);
  EXPECT_EQ(run.result.code, Code("S582"));
}

TEST(LoadControl, HasNoFactorOfSafety) {
  Column column(500.0);
  column.stage().load_control = "5 y -0.06";
  const Model model = build_model(column.input, bench().catalogue());
  EXPECT_THROW(refuse_controlled_trials(model), InputError);
}

}  // namespace
}  // namespace sage::test
