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
