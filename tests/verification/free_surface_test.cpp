// Free surfaces, stream functions and the force of water, whole models.
#include <gtest/gtest.h>

#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/observer.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/app/commands.hpp"
#include "sage/scenes/seepage.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

// Charny's discharge is exact; 1e-3 is what the ramp of one element leaves on 28 x 28.
TEST(FreeSurface, DischargeOfADam) {
  const Dam dam;
  const WholeRun run = run_text(dam.deck().text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double out = -inflow_of(run, dam.block().right()), in = inflow_of(run, dam.block().left());
  EXPECT_NEAR(out / 3.2142857142857143e-3, 1.0, 1e-3);
  EXPECT_NEAR(in / out, 1.0, 1e-10);
}

// Lengths and permeability times 1024.
TEST(FreeSurface, UnitsDoNotMatter) {
  Dam dam, other;
  dam.columns = dam.rows = other.columns = other.rows = 7;
  for (double* length : {&other.H, &other.W, &other.h, &other.top, &other.k}) *length *= 1024.0;
  const WholeRun run = run_text(dam.deck().text()), large = run_text(other.deck().text());
  ASSERT_TRUE(run.completed() && large.completed());
  EXPECT_NEAR(inflow_of(large, dam.block().left()) / (1024.0 * 1024.0), inflow_of(run, dam.block().left()),
              1e-12);
}

// The dam the other way round, numbered from the other end, and by several threads.
TEST(FreeSurface, SideNumbersAndThreadsDoNotMatter) {
  Dam dam;
  dam.columns = dam.rows = 7;
  const auto deck = [&](bool mirrored, bool reversed) {
    Block body = dam.block();
    body.place = [=](double s, double t) {
      const double x = 7.0 * (mirrored != reversed ? 1.0 - s : s);
      return Vector2(mirrored ? -x : x, 7.0 * (reversed ? 1.0 - t : t));
    };
    DeckWriter writer = flow_deck(body, 1, kFreeSurfaceLaw, {1e-3});
    const bool swapped = mirrored != reversed;
    for (const bool high : {true, false}) {
      const std::vector<int> face = high != swapped ? body.left() : body.right();
      for (std::size_t j = 0; j < face.size(); ++j) {
        const double y = body.at(0, static_cast<int>(j)).y(), water = high ? 7.0 : 2.0;
        const bool wet = y <= water + 1e-9;
        writer.stages.back().fixities.push_back(head_card(face[j], wet ? water : 0.0, wet ? 1 : 2));
      }
    }
    return writer.text();
  };
  const WholeRun plain = run_text(deck(false, false));
  ASSERT_TRUE(plain.completed()) << plain.failure;
  const Block lattice = dam.block();
  const int head = find_unknown(plain.model->unknowns, "head");
  const auto head_at = [&](const WholeRun& run, int i, int j) {
    return run.last().u[DofMap(*run.model).of(run.index(lattice.node(i, j)), head)];
  };
  for (const auto& [mirrored, reversed] : {std::pair{true, false}, {false, true}}) {
    const WholeRun run = run_text(deck(mirrored, reversed));
    ASSERT_TRUE(run.completed()) << run.failure;
    const bool swapped = mirrored != reversed;
    for (int j = 0; j <= 7; ++j)
      for (int i = 0; i <= 7; ++i)
        EXPECT_NEAR(head_at(run, swapped ? 7 - i : i, reversed ? 7 - j : j), head_at(plain, i, j), 1e-9)
            << i << " " << j;
  }
  for (const int threads : {1, 3}) {
    RunSettings several = app::make_workbench().settings();
    several.threads = threads;
    EXPECT_EQ((run_text(deck(false, false), {}, several).last().u - plain.last().u).cwiseAbs().maxCoeff(), 0.0);
  }
}

// Water that rises in three increments, gone on with from each of the checkpoints.
TEST(FreeSurface, RestartsToTheSameBits) {
  Dam dam;
  dam.columns = dam.rows = 7;
  DeckWriter deck = dam.deck();
  deck.stages[0].increments = 3;
  std::vector<std::string> saved;
  RunSettings settings = app::make_workbench().settings();
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { saved.push_back(bytes); };
  const WholeRun whole = run_text(deck.text(), {}, settings);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  ASSERT_EQ(saved.size(), 2U);
  for (const std::string& bytes : saved) {
    RunSettings again = app::make_workbench().settings();
    again.resume_from = bytes;
    const WholeRun rest = run_text(deck.text(), {}, again);
    ASSERT_TRUE(rest.completed()) << rest.failure;
    EXPECT_EQ((rest.last().u - whole.last().u).cwiseAbs().maxCoeff(), 0.0);
  }
}

class Last final : public Observer {
 public:
  void on_increment(const Model& model, const StepReport&, const Solution& solution) override {
    psi = stream_function(model, solution.activity->group, solution.groups());
    const FlowLine line = flow_line(model, solution.activity->group, model.reports[0].nodes);
    through = flow_through(model, line, model.reports[0].nodes, solution.groups(), solution.activity->dof_map,
                           *solution.u);
  }
  StreamFunction psi;
  FlowThrough through;
};

// The stream function spans what flows, of rings through the full circle.  On the downstream face of the dam water
// 2 m high presses with gamma_w h^2 / 2, less the suction of the dry part.
TEST(FreeSurface, StreamFunctionSpansTheDischarge) {
  for (const int geometry : {1, 2}) {
    Dam dam;
    dam.geometry = geometry;
    dam.left = geometry == 2 ? 1.0 : 0.0;
    dam.columns = dam.rows = 7;
    const Workbench bench = app::make_workbench();
    const Model model = bench.build(dam.deck().text());
    Last last;
    Observer* const observers[] = {&last};
    ASSERT_EQ(bench.run(model, observers).status, RunStatus::completed);
    EXPECT_NEAR(last.psi.largest / last.through.discharge, 1.0, 1e-10);
    EXPECT_LT(last.psi.sources, 1e-10);
    EXPECT_NEAR(last.through.force.y(), 0.0, 1e-10);
  }
}

}  // namespace
}  // namespace sage::test
