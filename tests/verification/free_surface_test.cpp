// Free surfaces, stream functions and the force of water, whole models.
#include <gtest/gtest.h>

#include <cmath>

#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/observer.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/app/commands.hpp"
#include "tests/studies/scenes/seepage.hpp"
#include "tests/studies/workbench.hpp"
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

// What blurs a free surface is named with its share, and what finds none with the ramp that it came to.
TEST(FreeSurface, WhatBlursItIsNamed) {
  Dam plain, wide, leaky;
  for (Dam* dam : {&plain, &wide, &leaky}) dam->columns = dam->rows = 14;
  wide.ramp = 4.0;
  const WholeRun sharp = run_text(plain.deck().text()), blurred = run_text(wide.deck().text());
  EXPECT_FALSE(sharp.warns("the soil falls dry over"));
  EXPECT_FALSE(sharp.warns("soil that should be dry"));
  EXPECT_TRUE(blurred.warns("the soil falls dry over")) << "S537";
  leaky.top = 14.0;  // as much soil above the water as below
  DeckWriter deck = leaky.deck();
  deck.materials.clear();
  deck.material(1, kFreeSurfaceLaw, {1e-3, 0.0, 0.0, 0.0, 0.1});
  EXPECT_TRUE(run_text(deck.text()).warns("soil that should be dry")) << "S538";
  DeckWriter short_of_iterations = plain.deck();
  short_of_iterations.stages[0].max_iterations = 1;
  const WholeRun lost = run_text(short_of_iterations.text());
  EXPECT_FALSE(lost.completed());
  EXPECT_EQ(to_string(lost.result.code.value()), "S539") << lost.failure;
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
    through =
        flow_through(model, line, model.reports[0].nodes, solution.groups(), *solution.activity, *solution.u);
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
    EXPECT_LT(last.psi.jump, 1e-10);
    EXPECT_NEAR(last.through.force.y(), 0.0, 1e-10);
  }
}

// Observes the stream function of the last state.
class Streams final : public Observer {
 public:
  void on_increment(const Model& model, const StepReport&, const Solution& solution) override {
    psi = stream_function(model, solution);
    EXPECT_EQ(&stream_function(model, solution), &stream_function(model, solution)) << "made once a solution";
  }
  StreamFunction psi;
};

struct Streamed {
  Model model;
  StreamFunction psi;
  int index(int number) const {
    for (int node = 0; node < model.mesh.nodes(); ++node)
      if (model.mesh.number[node] == number) return node;
    throw std::logic_error("no such node");
  }
  double at(int number) const { return psi.value(index(number)); }
};

Streamed stream(const DeckWriter& deck) {
  static const Workbench bench = app::make_workbench();
  Streams seen;
  Streamed run{bench.build(deck.text()), {}};
  Observer* const observers[] = {&seen};
  EXPECT_EQ(bench.run(run.model, observers).status, RunStatus::completed);
  run.psi = seen.psi;
  return run;
}

// A wall in ground without end, head 1 from side to side: x + i y = -i s cosh(xi + i eta), ground at eta = -pi/2 (left)
// and pi/2; confocal ellipses xi are stream lines, xi0 the wall (0 is a pile of depth s).  psi = k (xi1 - xi) / pi with
// its zero on the outermost; the wall lies to the left of the flow, which goes from the left to the right below it.
struct WallInGround {
  static constexpr double kPi = 3.14159265358979323846, s = 2.0, xi0 = 0.3, xi1 = 1.5;
  Block ground;

  explicit WallInGround(Cell cell, int n) {
    ground.columns = ground.rows = n;
    ground.cell = cell;
    ground.place = [](double p, double q) {
      const double xi = xi0 + (xi1 - xi0) * p, eta = kPi * (q - 0.5);
      return Vector2(s * std::sinh(xi) * std::sin(eta), -s * std::cosh(xi) * std::cos(eta));
    };
  }
  DeckWriter deck() const {
    DeckWriter writer = flow_deck(ground, 1, kDarcyLaw, {1.0});
    hold_heads(writer.stages.back(), ground.bottom(), 1.0);
    hold_heads(writer.stages.back(), ground.top(), 0.0);
    return writer;
  }
  double exact(int i) const { return (xi1 - xi0) * (1.0 - 1.0 * i / (ground.across() - 1)) / kPi; }
};

// At every node, second order: 7e-3 (quadrilaterals) and 1.6e-2 (triangles) of the discharge are left on 12 x 12 elements
// of degree 1, 2e-3 and 3.4e-3 on those of degree 2.  Walls have one value each, and theirs differ by the discharge of the
// reactions.
TEST(StreamFunctions, OfAWallAtItsNodes) {
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tri6}) {
    double before = 0.0;
    for (const int n : {6, 12}) {
      const WallInGround pile(cell, n);
      const Streamed run = stream(pile.deck());
      double error = 0.0;
      for (int j = 0; j < pile.ground.up(); ++j)
        for (int i = 0; i < pile.ground.across(); ++i)
          if (pile.ground.exists(i, j))
            error = std::max(error, std::abs(run.at(pile.ground.node(i, j)) - pile.exact(i)) / pile.exact(0));
      EXPECT_EQ(run.psi.reason, "");
      if (n == 12) {
        EXPECT_LT(error, pile.ground.order() == 1 ? 0.02 : 4e-3) << static_cast<int>(cell);
        EXPECT_LT(error, 0.35 * before) << static_cast<int>(cell);
      }
      before = error;
      const double wall = run.at(pile.ground.left()[0]);
      for (const int node : pile.ground.left()) EXPECT_NEAR(run.at(node) / wall, 1.0, 1e-9);
      for (const int node : pile.ground.right()) EXPECT_NEAR(run.at(node), 0.0, 1e-9 * wall);
      const WholeRun whole = run_text(pile.deck().text());
      EXPECT_NEAR(wall / inflow_of(whole, pile.ground.bottom()), 1.0, 1e-9);
    }
  }
}

// A pile to half of a layer's depth: K' = K, so that half of k h passes below it.
TEST(StreamFunctions, OfAPileSpanItsDischarge) {
  Barrier barrier;
  barrier.s = 0.5;
  const Streamed run = stream(barrier.deck());
  const Block ground = barrier.block();
  const double pile = run.at(ground.left().back()), floor = run.at(ground.bottom()[4]);
  EXPECT_NEAR(pile - floor, 0.5, 5e-4) << "the scheme's error of the discharge, which is the same";
  EXPECT_NEAR(floor, 0.0, 1e-12);
}

// Water that rises in a pipe of radius 2 with v = 1/4: through the full circle psi falls with r, by pi (4 - r^2) v.
// And out of a ball: between its axis and the angle b to it flows Q (1 - cos b) / 2.
TEST(StreamFunctions, OfRingsAreThroughTheFullCircle) {
  Block pipe;
  pipe.columns = 4;
  pipe.rows = 3;
  pipe.cell = Cell::quad8;
  pipe.place = rectangle(0.0, 2.0, 0.0, 4.0);
  DeckWriter up = flow_deck(pipe, 2, kDarcyLaw, {1.0});
  hold_heads(up.stages.back(), pipe.bottom(), 1.0);
  hold_heads(up.stages.back(), pipe.top(), 0.0);
  const Streamed risen = stream(up);
  const double pi = WallInGround::kPi;
  for (int i = 0; i < pipe.across(); i += 2)
    for (int j = 0; j < pipe.up(); j += 2) {
      const double r = pipe.at(i, j).x();
      EXPECT_NEAR(risen.at(pipe.node(i, j)), 0.25 * pi * (4.0 - r * r), 0.02) << r;
    }
  EXPECT_NEAR(risen.at(pipe.left()[0]), pi, 1e-10) << "all of it on the axis";
  EXPECT_NEAR(risen.at(pipe.right()[0]), 0.0, 1e-10);

  Block ball;
  ball.columns = ball.rows = 12;
  ball.cell = Cell::quad8;
  ball.place = [pi](double p, double q) {
    const double R = 1.0 + p, b = 0.5 * pi * (1.0 - q);  // from the plane to the axis
    return Vector2(R * std::sin(b), R * std::cos(b));
  };
  DeckWriter out = flow_deck(ball, 2, kDarcyLaw, {1.0});
  hold_heads(out.stages.back(), ball.left(), 1.0);
  hold_heads(out.stages.back(), ball.right(), 0.0);
  const Streamed shed = stream(out);
  const double Q = 0.5 * 4.0 * pi / (1.0 - 0.5);
  for (int j = 0; j < ball.up(); j += 2) {
    const double b = 0.5 * pi * (1.0 - 1.0 * j / (ball.up() - 1));
    const int i = ball.across() / 2;
    EXPECT_NEAR(shed.at(ball.node(i - i % 2, j)) / Q, std::cos(b), 2e-3)
        << "grows to the left of the flow: the axis";
  }
}

// Eight elements around a hole.
DeckWriter around_a_hole() {
  DeckWriter deck(1);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) deck.node(4 * j + i + 1, i, j);
  deck.material(1, kDarcyLaw, {1.0});
  deck.group(1, 41, 0, 1);
  int number = 0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      if (i != 1 || j != 1) {
        const int first = 4 * j + i + 1;
        deck.element(++number, 1, {first, first + 1, first + 5, first + 4});
      }
  deck.stage();
  return deck;
}

// psi has one value around a closed hole, and none around a well, or around a hole that water comes out of.
TEST(StreamFunctions, OfWellsAndHolesThatGiveWaterAreNone) {
  DeckWriter closed = around_a_hole();
  for (int j = 0; j < 4; ++j) {
    hold_heads(closed.stages.back(), {4 * j + 1}, 1.0);
    hold_heads(closed.stages.back(), {4 * j + 4}, 0.0);
  }
  const Streamed passing = stream(closed);
  EXPECT_EQ(passing.psi.reason, "");
  EXPECT_NEAR(passing.at(6), passing.at(7), 1e-12) << "the hole's edge is a stream line";
  EXPECT_NEAR(passing.at(6), 0.5 * passing.at(13), 1e-12);

  DeckWriter spring = around_a_hole();
  hold_heads(spring.stages.back(), {6, 7, 10, 11}, 1.0);
  hold_heads(spring.stages.back(), {1, 2, 3, 4, 5, 8, 9, 12, 13, 14, 15, 16}, 0.0);
  const Streamed sprung = stream(spring);
  EXPECT_NE(sprung.psi.reason.find("around a hole in the flow"), std::string::npos) << sprung.psi.reason;
  EXPECT_TRUE(std::isnan(sprung.at(1)));

  Block ground;
  ground.columns = ground.rows = 4;
  ground.place = rectangle(0.0, 4.0, 0.0, 4.0);
  for (const bool inside : {true, false}) {
    DeckWriter deck = flow_deck(ground, 1, kDarcyLaw, {1.0});
    hold_heads(deck.stages.back(), ground.left(), 1.0);
    hold_heads(deck.stages.back(), ground.right(), 0.0);
    const int well = ground.node(2, inside ? 2 : 0);
    deck.stages.back().loads.push_back(inflow_card(well, -0.125));
    const Streamed run = stream(deck);
    EXPECT_EQ(std::isnan(run.at(ground.node(0, 0))), inside);
    const std::string named = "inside the flow, most at node " + std::to_string(well) + " (0.125";
    EXPECT_EQ(run.psi.reason.find(named) != std::string::npos, inside) << run.psi.reason;
    RunSettings asked = app::make_workbench().settings();
    asked.stream_function = true;
    EXPECT_EQ(run_text(deck.text(), {}, asked).warns("no stream function: water is put in or taken out inside"),
              inside);
    EXPECT_FALSE(run_text(deck.text()).warns("no stream function"));
  }
}

// Still water: no flow, and rounding of heads makes none.
TEST(StreamFunctions, OfStillWaterIsZero) {
  Block ground;
  ground.columns = ground.rows = 5;
  ground.place = rectangle(0.0, 3.0, 0.0, 7.0);
  DeckWriter deck = flow_deck(ground, 1, kDarcyLaw, {1e-7});
  hold_heads(deck.stages.back(), ground.left(), 123.456);
  hold_heads(deck.stages.back(), {ground.node(3, 3)}, 123.456);
  const Streamed run = stream(deck);
  EXPECT_EQ(run.psi.reason, "");
  for (int node = 0; node < run.model.mesh.nodes(); ++node) EXPECT_EQ(run.psi.value(node), 0.0);
}

}  // namespace
}  // namespace sage::test
