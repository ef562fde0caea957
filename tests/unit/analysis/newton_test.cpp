// Steps of the analysis on small models: methods, cuts, limit-load bracket, failure reports.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "sage/analysis/checked_solve.hpp"
#include "sage/analysis/dogleg.hpp"
#include "sage/analysis/run.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/support/run_text.hpp"

namespace sage {
namespace {

// Dense matrix for the dogleg alone.
class DenseMatrix final : public KeptMatrix {
 public:
  explicit DenseMatrix(Matrix2 K) : K_(K) {}
  void multiply(std::span<const double> x, std::span<double> y) const override {
    Vector2::Map(y.data()) = K_ * Vector2::Map(x.data());
  }
  void multiply_transposed(std::span<const double> x, std::span<double> y) const override {
    Vector2::Map(y.data()) = K_.transpose() * Vector2::Map(x.data());
  }
  double norm1() const override { return K_.cwiseAbs().colwise().sum().maxCoeff(); }
  void solve_transposed(std::span<const double>, std::span<double>) const override {}

 private:
  Matrix2 K_;
};

// A solver whose answers have lost their digits.
class LostDigits final : public LinearSolver {
 public:
  const SolverTraits& traits() const override { return traits_; }
  void analyse(int, ElementEquations) override {}
  void clear() override {}
  void add(int, const double*) override {}
  void factorise() override {}
  SolveStatus solve(std::span<const double>, std::span<double>) const override {
    return SolveStatus::inaccurate;
  }
  FactorReport report() const override { return {.growth = 1e12, .backward_error = 0.5}; }

 private:
  SolverTraits traits_{"lost_digits", false};
};

TEST(CheckedSolve, AnInaccurateAnswerIsAnErrorThatNamesTheRemedy) {
  const double b[] = {1.0};
  double x[] = {0.0};
  try {
    checked_solve(LostDigits(), b, x);
    ADD_FAILURE() << "no error";
  } catch (const AnalysisError& error) {
    EXPECT_NE(std::string(error.what()).find("wrong by 5.0e-01 of the forces"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("choose a solver that pivots"), std::string::npos) << error.what();
  }
}

TEST(Dogleg, StaysInTheTrustRegionAndBendsTowardsDescent) {
  Matrix2 K;
  K << 1.0, 0.5, 0.0, 100.0;
  const DenseMatrix matrix(K);
  const Eigen::VectorXd R = Vector2(1.0, 1.0);
  const Eigen::VectorXd newton = K.inverse() * R;
  Eigen::VectorXd step;
  Dogleg dogleg;
  dogleg.choose(matrix, R, newton, step);
  EXPECT_NEAR((step - newton).norm(), 0.0, 1e-15) << "the first step is Newton's";
  EXPECT_FALSE(dogleg.accept(R.norm(), 10.0 * R.norm()));
  dogleg.choose(matrix, R, newton, step);
  EXPECT_NEAR(step.norm(), 0.25 * newton.norm(), 1e-14) << "a quarter of the rejected step";
  EXPECT_LT((R - K * step).norm(), R.norm()) << "and downhill";
  for (int i = 0; i < 12; ++i) {
    EXPECT_FALSE(dogleg.accept(R.norm(), 2.0 * R.norm()));
    dogleg.choose(matrix, R, newton, step);
  }
  const Vector2 descent = (K.transpose() * R).normalized();
  EXPECT_NEAR(descent.dot(step.normalized()), 1.0, 1e-12) << "a tiny region leaves steepest descent";
  EXPECT_TRUE(dogleg.accept(R.norm(), (R - K * step).norm())) << "as good as hoped";
}

struct Outcome {
  RunResult result;
  std::vector<StepReport> steps;
  double settlement = 0.0;  // of the top at the last converged state
};

class Watch final : public Observer {
 public:
  explicit Watch(Outcome& outcome) : outcome_(outcome) {}
  void on_increment(const Model&, const StepReport& report, const Solution& solution) override {
    outcome_.steps.push_back(report);
    outcome_.settlement = -solution.u->minCoeff();
  }
  void on_failure(const Model&, const StepReport& report, const std::string&,
                  const Solution& solution) override {
    outcome_.steps.push_back(report);
    outcome_.settlement = -solution.u->minCoeff();
  }

 private:
  Outcome& outcome_;
};

// A column 1 x 2 of four b-bar elements in plane strain, sides free, base smooth, pressed by `pressure` in 10
// increments.  Tresca, c = 10: it fails at 2 c = 20.
Outcome press(double pressure, int method, int law = 4) {
  test::DeckWriter deck(1);
  test::Block block;
  block.columns = 1;
  block.rows = 4;
  block.place = test::rectangle(0.0, 1.0, 0.0, 2.0);
  block.write_nodes(deck);
  block.write_elements(deck, 1);
  if (law == 1)
    deck.material(1, 1, {1000.0, 0.3});
  else
    deck.material(1, 4, {1000.0, 0.3, 10.0, 0.0, 0.0});
  deck.group(1, 1, 2, 1);
  for (int node : block.bottom()) deck.fix(node, node == 1 ? 1 : 0, 1);
  test::StageCards& stage = deck.stage(10);
  stage.method = method;
  stage.max_iterations = method == 0 ? 0 : 200;
  stage.pressure(block.element(0, 3), 3, pressure, pressure);
  static const Catalogue catalogue = app::full_catalogue();
  const Model model = build_model(read_deck_text(deck.text(), "column.dat", load_layout("sage1")), catalogue);
  RunSettings settings;
  settings.choose_solver = choose_solver;
  Outcome outcome;
  Watch watch(outcome);
  Observer* observers[] = {&watch};
  outcome.result = run(model, catalogue, settings, observers);
  return outcome;
}

// Plane strain, free sides: settlement = p H (1 - nu^2) / E.
TEST(Methods, AllFindTheElasticAnswer) {
  for (int method : {0, 1, 2, 3}) {
    const Outcome outcome = press(15.0, method);
    EXPECT_EQ(outcome.result.status, RunStatus::completed) << "method " << method;
    EXPECT_NEAR(outcome.settlement, 15.0 * 2.0 * (1.0 - 0.09) / 1000.0, 1e-12) << "method " << method;
  }
}

TEST(LimitLoad, IsBracketedAndTheLastEquilibriumKept) {
  for (int method : {0, 3}) {
    const Outcome outcome = press(25.0, method);
    EXPECT_NE(outcome.result.status, RunStatus::completed);
    ASSERT_FALSE(outcome.steps.empty());
    const StepReport& last = outcome.steps.back();
    EXPECT_FALSE(last.converged);
    EXPECT_LE(25.0 * last.load_factor, 20.0 * (1.0 + 1e-6)) << "equilibrium cannot exist above 2 c";
    EXPECT_GE(25.0 * last.failed_at, 20.0 * (1.0 - 1e-6)) << "and must be found below it";
    EXPECT_LT(last.failed_at - last.load_factor, 0.01) << "cuts close in on the limit";
    EXPECT_NE(outcome.result.reason.find("limit load: between"), std::string::npos) << outcome.result.reason;
    EXPECT_TRUE(std::isfinite(outcome.settlement));
  }
}

// Who runs with a matrix kept from before is not advised to do so.
TEST(Advice, NamesAnotherMethodThanTheStages) {
  for (int method : {1, 2}) {
    const std::string reason = press(25.0, method).result.reason;
    EXPECT_NE(reason.find("no equilibrium found"), std::string::npos) << reason;
    const std::string advice = reason.substr(std::min(reason.find("  try: "), reason.size()));
    EXPECT_EQ(advice.find("method 2"), std::string::npos) << reason;
    EXPECT_NE(advice.find("method 0 (Newton)"), std::string::npos) << reason;
  }
}

// A biaxial specimen of reduced quad8 that flows without dilation is singular at its peak.  Its platen is
// moved: advice to move it would be none.
TEST(SingularMatrix, TheAdviceFitsWhatDrivesTheStage) {
  for (bool cell_pressure : {false, true}) {
    test::DeckWriter deck(1);
    test::Block block;
    block.cell = test::Cell::quad8;
    block.columns = block.rows = 2;
    block.place = test::rectangle(0.0, 1.0, 0.0, 1.0);
    block.write_nodes(deck);
    deck.material(1, 4, {20000.0, 0.3, 10.0, 30.0, 0.0});
    deck.group(1, 2, 1, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    if (cell_pressure) deck.initial(1, 0, 100.0, 100.0, 100.0, 0.0);
    test::StageCards& stage = deck.stage(20);
    for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -0.05);
    if (cell_pressure)
      for (int j = 0; j < 2; ++j) stage.pressure(block.element(1, j), 2, 100.0, 100.0);
    const test::WholeRun run = test::run_text(deck.text());
    ASSERT_EQ(run.result.status, RunStatus::singular) << run.failure;
    EXPECT_EQ(run.failure.find("displacement control"), std::string::npos) << run.failure;
    EXPECT_NE(run.failure.find("method 2"), std::string::npos) << run.failure;
    EXPECT_NE(run.failure.find(cell_pressure ? "of the stage's loads and displacements ("
                                             : "of the stage's displacement ("),
              std::string::npos)
        << run.failure;
    EXPECT_EQ(run.failure.find("limit load"), std::string::npos) << run.failure;
  }
}

// Half of a rough rigid strip 2 m wide, pushed 0.1 m into weightless ground with c = 10, phi = psi = 20.
std::string footing(int method) {
  const std::string stage = "   40" + std::string(4, ' ') + std::to_string(method);
  return "Strip footing on c-phi soil, half model, rough rigid, weightless\n"
         "m       kN      kPa        101.325      9.81\n"
         "* geom solv node fill matl grup elem fixi init stag rept nnod nele\n"
         "    1    0    6    2    1    1    1    3    0    1    1  375  336\n"
         "    1    0    0       0.0      -6.0\n"
         "    9    1    0       1.0      -6.0\n"
         "   25    1    0      10.0      -6.0      10.0\n"
         "  351    0    0       0.0       0.0\n"
         "  359    1    0       1.0       0.0\n"
         "  375    1    0      10.0       0.0      10.0\n"
         "    1    8    1   14   25       0.0       0.1\n"
         "    9   16    1   14   25      10.0       0.1\n"
         "    1    4    6       0.0 soil\n"
         "    30000.      0.30       10.       20.       20.        -1.\n"
         "    1    1    2    1 soil\n"
         "    1    1    1    2   27   26                       24   14    1   25\n"
         "    1   25    1    1    1\n"
         "    1  351   25    1    0\n"
         "   25  375   25    1    0\n"
         "Push the footing 0.1 m\n" +
         stage +
         "   50    5    1    0    0    0    0    0       0.0       0.0    1.0E-6\n"
         "  351  359    1    1    1       0.0     -0.10\n"
         "    2    1  351  359    1    1\n"
         "END\n";
}

BuildOptions graded() {
  BuildOptions options;
  options.gradings.push_back({});
  options.element = 2;  // quad8
  return options;
}

// The small elements at the edge flow from the first increment on.  Started from the elastic
// tangent after every cut, and stopped after twelve cuts in all, the run ended at 5.6 % of the
// push.  200 increments of the same mesh, which need no help, end at 150.476; Prandtl: c N_c b =
// 148.3, and the mesh's error.
TEST(Cuts, TheRunGoesOnByItselfWhereShorterStepsDo) {
  const test::WholeRun run = test::run_text(footing(0), graded());
  ASSERT_TRUE(run.completed()) << run.failure;
  double force = 0.0;
  for (int node = 0; node < run.model->mesh.nodes(); ++node)
    if (run.model->mesh.x(1, node) == 0.0 && run.model->mesh.x(0, node) <= 1.0)
      force += run.last().internal[2 * node + 1];
  EXPECT_NEAR(force, -150.476, 1e-4 * 150.476) << "40 increments instead of 200 differ by 1e-5";
}

// Three iterations and no cut: a failure that says nothing of the ground.
TEST(Cuts, AFailureFarBelowCollapseIsNotCalledALimit) {
  RunSettings settings;
  settings.max_cuts = 0;
  std::string deck = footing(0);
  deck.replace(deck.find("   40    0   50"), 15, "    8    0    3");
  const test::WholeRun run = test::run_text(deck, graded(), settings);
  ASSERT_EQ(run.result.status, RunStatus::not_converged);
  for (const char* words :
       {"no equilibrium found", "needs not be a limit", "tried: method 0 (Newton), up to 3 iterations",
        "more increments; method 3 (Newton with dogleg) with more iterations"})
    EXPECT_NE(run.failure.find(words), std::string::npos) << words << "\n" << run.failure;
  for (const char* words : {"limit load", "equilibrium ends", "method 2"})
    EXPECT_EQ(run.failure.find(words), std::string::npos) << words << "\n" << run.failure;
}

// Modified Newton ran away to forces of 1e77 and more, which the failure then printed.
TEST(Cuts, AnIterationThatRunsAwayLeavesNoNumbers) {
  RunSettings settings;
  settings.max_cuts = 4;
  const test::WholeRun run = test::run_text(footing(1), graded(), settings);
  ASSERT_EQ(run.result.status, RunStatus::not_converged);
  const std::size_t at = run.failure.find("largest out-of-balance force of the best iteration: ");
  ASSERT_NE(at, std::string::npos) << run.failure;
  const double force = std::stod(run.failure.substr(run.failure.find(": ", at) + 2));
  EXPECT_LT(std::abs(force), 150.0) << "no node bears more than the footing at collapse";
}

TEST(LinearScene, FactorisesOncePerStage) {
  const Outcome outcome = press(15.0, 0, 1);
  EXPECT_EQ(outcome.result.work.factorisations, 1);
  EXPECT_EQ(outcome.result.work.assemblies, 1);
  EXPECT_EQ(outcome.result.work.solves, 10);
}

// Two blocks with a joint between them, the upper one on rollers at its sides.
struct Blocks {
  test::Block lower, upper;
  test::DeckWriter deck{1};
  Blocks() {
    lower.place = test::rectangle(0.0, 1.0, 0.0, 1.0);
    upper.place = test::rectangle(0.0, 1.0, 1.0, 2.0);
    upper.first_node = upper.first_element = 11;
    lower.write_nodes(deck);
    upper.write_nodes(deck);
    deck.material(1, 1, {1000.0, 0.3});
    deck.material(2, 21, {1000.0, 1000.0});
    deck.group(1, 1, 2, 1);
    deck.group(2, 11, 1, 2);
    lower.write_elements(deck, 1);
    upper.write_elements(deck, 1);
    test::join(deck, 21, 2, lower.top(), upper.bottom(), 1);
    for (int n : lower.bottom()) deck.fix(n, 1, 1);
    for (int n : upper.left()) deck.fix(n, 1, 0);
    for (int n : upper.right()) deck.fix(n, 1, 0);
  }
};

// An initial stress that no load balances and a couple that the rollers bear: the upper block springs off its
// joint and ends in equilibrium wherever.  Only a matrix kept from before finds that.
TEST(OpenJoint, ALoosePartIsTold) {
  for (int method : {1, 2}) {
    Blocks blocks;
    blocks.deck.initial(1, 0, 0.0, 100.0);
    blocks.deck.initial(2, 0, 0.0, 100.0);
    test::StageCards& stage = blocks.deck.stage();
    stage.method = method;
    stage.max_iterations = 200;
    stage.load(13, 0.0, 5.0);
    stage.load(14, 0.0, -5.0);
    const test::WholeRun run = test::run_text(blocks.deck.text());
    ASSERT_TRUE(run.completed()) << run.failure;
    EXPECT_EQ(run.last().points[static_cast<std::size_t>(PointStatus::open)], 2);
    EXPECT_TRUE(
        run.warns("increment 1: all interfaces around the part that contains node 11 (4 nodes: 11, 12, 13, 14) "
                  "are open: nothing holds it against a rigid translation in y"));
  }
}

// Lifted off by its top, which is then let go: the rollers do not hold it up.
TEST(OpenJoint, IsNamedWhereThePartBehindItIsHeldOneWay) {
  Blocks blocks;
  test::StageCards& lift = blocks.deck.stage();
  for (int n : blocks.upper.top()) lift.fix(n, 0, 1, 0.0, 0.1);
  test::StageCards& release = blocks.deck.stage();
  for (int n : blocks.upper.top()) release.fix(n, 0, -1);
  release.load(13, 0.0, 1.0);
  const test::WholeRun run = test::run_text(blocks.deck.text());
  EXPECT_EQ(run.result.status, RunStatus::singular);
  EXPECT_NE(run.failure.find("the part behind it is loose"), std::string::npos) << run.failure;
}

}  // namespace
}  // namespace sage
