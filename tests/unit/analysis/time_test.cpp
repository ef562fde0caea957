// Laws that want to know where and when they are asked (PointIn::context): times of steps that are whole, cut,
// divided, or taken up again from a checkpoint.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/core/point_driver.hpp"
#include "tests/install/consumer/creep.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

constexpr double kE = 1000.0, kTau = 2.0;

// Elastic (nu = 0), and relaxing like Maxwell's body.  History: the law's own clock, the share of the stress that
// time has left, the largest difference of that clock from the time that the analysis tells, and where the point is.
// Refuses steps that last longer than `longest`.
class Clock final : public SolidLaw {
 public:
  explicit Clock(double longest) : D_(elastic_matrix(moduli_from_young(kE, 0.0))), longest_(longest) {}
  // it is not, and nobody may believe it: it wants its context
  LawTraits traits() const override {
    return {.history = kHistory, .symmetric = true, .linear = true, .wants_context = true};
  }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const PointContext& now = *in.context;
    if (now.dt > longest_) return Outcome::cut_step;
    const double left = 1.0 / (1.0 + now.dt / kTau);
    out.sigma = left * (in.sigma0 + D_ * in.deps);
    out.D = left * D_;
    out.h1[0] = in.h0[0] + now.dt;
    out.h1[1] = in.h0[1] * left;
    out.h1[2] = std::max(in.h0[2], std::abs(out.h1[0] - now.time));
    out.h1[3] = 1000.0 * now.element + 100.0 * now.point + 10.0 * now.stage + now.increment;
    out.h1[4] = now.place.x();
    out.h1[5] = now.place.y();
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  static constexpr std::array<Quantity, 6> kHistory{{{"clock", Dimension::none, 0.0},
                                                     {"left", Dimension::none, 1.0},
                                                     {"difference", Dimension::none, 0.0},
                                                     {"where", Dimension::none, 0.0},
                                                     {"x", Dimension::length, 0.0},
                                                     {"y", Dimension::length, 0.0}}};
  Matrix4 D_;
  double longest_;
};

MaterialEntry clock_entry() {
  static const std::vector<Parameter> rows = {required("longest", Dimension::none, "longest step")};
  return {"clock", "writes down its time", 4, rows,
          [](std::span<const double> values, const UnitSystem&) -> LawPtr {
            return std::make_unique<Clock>(values[0]);
          }};
}

Workbench bench() {
  Catalogue catalogue = app::full_catalogue();
  catalogue.materials.add(90, own::maxwell());
  catalogue.materials.add(91, clock_entry());
  return {catalogue, [](const SystemSize&) { return 1; }};
}

// A column 1 x 1 of two elements, pressed by 0.01 in the first stage and held in the second.
DeckWriter column(int law, const std::vector<double>& parameters, int increments, int method = 0) {
  DeckWriter deck(1);
  const Block block{.columns = 1, .rows = 2, .place = rectangle(0.0, 1.0, 0.0, 1.0)};
  block.write_nodes(deck);
  deck.material(1, law, parameters);
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (const int node : block.bottom()) deck.fix(node, 0, 1);
  for (const int node : block.left()) deck.fix(node, 1, 0);
  StageCards& press = deck.stage();
  for (const int node : block.top()) press.fix(node, 0, 1, 0.0, -0.01);
  deck.stage(increments);
  for (StageCards& stage : deck.stages) {
    stage.method = method;
    stage.max_iterations = 400;
    stage.tolerance = 1e-12;
  }
  return deck;
}

// Backward Euler has the closed form (1 + dt/tau)^-n: 1 step of 1, then n of duration / n.
double relaxed(int n, double duration) {
  return -kE * 0.01 / (1.0 + 1.0 / kTau) * std::pow(1.0 + duration / n / kTau, -n);
}

TEST(Time, StressRelaxesAsTheStepsSay) {
  for (const int method : {0, 1, 2, 3})
    for (const double duration : {1.0, 3.0})
      for (const int n : {1, 5}) {
        SCOPED_TRACE(testing::Message() << "method " << method << ", " << n << " steps in " << duration);
        Model model = bench().build(column(90, {kE, 0.0, kTau}, n, method).text());
        model.stages[1].duration = duration;
        const WholeRun run = bench().run(std::move(model));
        ASSERT_TRUE(run.completed()) << run.failure;
        for (int p = 0; p < 8; ++p) EXPECT_NEAR(run.stress[0](1, p), relaxed(n, duration), 1e-10);
      }
}

// The history that a run of Clock ends with.
struct Last final : Observer {
  std::vector<double> h;
  int cuts = 0;
  void on_increment(const Model&, const StepReport& report, const Solution& now) override {
    h = now.groups()[0].state.committed.h;
    cuts += report.cuts;
  }
};

Last clocks(const DeckWriter& deck, double duration, const std::string& resume = {},
            std::vector<std::string>* checkpoints = nullptr) {
  static const Workbench workbench = bench();
  Model model = workbench.build(deck.text());
  model.stages[1].duration = duration;
  RunSettings settings;
  settings.choose_solver = [](const SystemSize&) { return 1; };
  settings.resume_from = resume;
  if (checkpoints != nullptr) {
    settings.checkpoint_due = [] { return true; };
    settings.save_checkpoint = [=](const std::string& bytes) { checkpoints->push_back(bytes); };
  }
  Last last;
  Observer* observers[] = {&last};
  const RunResult result = sage::run(model, workbench.catalogue(), settings, observers);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  return last;
}

// Steps of at most 0.3 in a stage that lasts 3: every increment of 1.5 is cut three times and more, and grows
// again.  What the law counts up by itself is what it is told, to rounding.
TEST(Time, CutStepsHaveTheirOwn) {
  for (const double longest : {10.0, 0.3}) {
    const Last last = clocks(column(91, {longest}, 2), 3.0);
    ASSERT_EQ(last.h.size(), 48u);
    if (longest < 1.0) {
      EXPECT_GE(last.cuts, 6);
    }
    for (std::size_t p = 0; p < 8; ++p) {
      const double* h = last.h.data() + 6 * p;
      EXPECT_NEAR(h[0], 4.0, 1e-14);
      EXPECT_LE(h[2], 1e-14);
      EXPECT_EQ(h[3], 1000.0 * static_cast<double>(p / 4 + 1) + 100.0 * static_cast<double>(p % 4) + 22.0);
      const double gauss = 0.5 / std::sqrt(3.0);
      EXPECT_NEAR(std::abs(h[4] - 0.5), gauss, 1e-14);
      EXPECT_NEAR(std::abs(h[5] - (p < 4 ? 0.25 : 0.75)), 0.5 * gauss, 1e-14);
    }
  }
}

TEST(Time, ARestartGoesOnAtItsTime) {
  for (const double longest : {10.0, 0.3})
    for (const int method : {0, 1, 3}) {
      SCOPED_TRACE(method);
      const DeckWriter deck = column(91, {longest}, 4, method);
      std::vector<std::string> checkpoints;
      const Last whole = clocks(deck, 3.0, {}, &checkpoints);
      ASSERT_EQ(checkpoints.size(), 4u);
      for (const std::string& bytes : checkpoints) EXPECT_EQ(clocks(deck, 3.0, bytes).h, whole.h);
    }
}

// Nothing but the state that stands is shown of a stage whose steps are all too long: forces, too, at dt = 0.
TEST(Time, AFailureShowsTheStateBefore) {
  Model model = bench().build(column(91, {0.5}, 2).text());
  model.stages[1].duration = 1000.0;
  RunSettings settings;
  settings.max_cuts = 3;
  const WholeRun run = bench().run(std::move(model), settings);
  ASSERT_EQ(run.result.status, RunStatus::not_converged) << run.failure;
  ASSERT_EQ(run.increments.size(), 2u);
  EXPECT_TRUE(run.increments[1].u == run.increments[0].u);
  EXPECT_LE((run.increments[1].internal - run.increments[0].internal).norm(),
            1e-14 * run.increments[0].internal.norm());
}

// A stage card of another layout may have a field for it, here in the room that sage1 gives the tolerance.
TEST(Time, ALayoutMayGiveTheDuration) {
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/layouts/sage1.toml");
  std::string toml{std::istreambuf_iterator<char>(in), {}};
  const auto replace = [](std::string& text, const std::string& old, const std::string& by) {
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), by);
  };
  replace(toml, "(10I5,3F10.0)", "(10I5,2F10.0,2F5.0)");
  const std::string tolerance =
      "{ name = \"tolerance\", label = \"tolerance of equilibrium\", codes = \"largest unbalanced force in "
      "relation to the forces of the model; 0 = 1e-8\" },";
  replace(toml, tolerance, tolerance + "\n    { name = \"duration\", label = \"duration of the stage\" },");
  const Layout layout = load_layout_text(toml, "timed.toml");
  DeckWriter deck = column(90, {kE, 0.0, kTau}, 2);
  for (StageCards& stage : deck.stages) stage.tolerance = 0.125;
  std::string text = deck.text();  // the tolerance fills ten columns: "     0.125"
  const std::size_t second = text.find("\n    2    0  400");
  ASSERT_NE(second, std::string::npos) << text;
  const auto with = [&](const std::string& columns) {
    std::string timed = text;
    timed.replace(second + 76, 5, columns);
    timed.replace(text.find("\n    1    0  400") + 76, 5, "     ");
    return build_model(read_deck_text(timed, "deck", layout), bench().catalogue());
  };
  EXPECT_EQ(with("   3.").stages[0].duration, 1.0);
  EXPECT_EQ(with("   3.").stages[1].duration, 3.0);
  EXPECT_EQ(with("     ").stages[1].duration, 1.0);
  EXPECT_THROW(with("  -1."), InputError);
}

// A point is driven in a time of its own: three steps of 2 under a constant strain.
TEST(Time, ThePointDriverHasATimeToo) {
  const Clock law(1.9);
  PointDriver<4> driver(law);
  constexpr std::array<Control, 4> kStrain{Control::strain, Control::strain, Control::strain, Control::strain};
  driver.advance(kStrain, {0.0, -0.01, 0.0, 0.0}, 0.5);
  for (int i = 0; i < 3; ++i) driver.advance(kStrain, Vector4::Zero(), 2.0);  // each in two parts
  EXPECT_NEAR(driver.history()[0], 6.5, 1e-14);
  EXPECT_LE(driver.history()[2], 1e-14);
  EXPECT_NEAR(driver.sigma()[1], -kE * 0.01 / 1.25 * std::pow(1.5, -6.0), 1e-10);
}

}  // namespace
}  // namespace sage::test
