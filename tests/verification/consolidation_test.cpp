// Coupled deformation and flow: exact discrete solutions, balances, limits, cards.  Closed forms: sagefe verify.
// docs/theory/consolidation.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "sage/analysis/observer.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/dof_map.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/record/water_balance.hpp"
#include "tests/studies/scenes/consolidation.hpp"
#include "tests/studies/workbench.hpp"

namespace sage {
namespace {

using namespace scenes;

const Workbench& bench() {
  static const Workbench bench = app::make_workbench();
  return bench;
}

WholeRun run(const ModelInput& input, const RunSettings& settings = {}) {
  WholeRun done = bench().run(build_model(input, bench().catalogue()), settings);
  EXPECT_TRUE(done.completed()) << done.failure;
  return done;
}

double pressure(const WholeRun& run, const Snapshot& at, int number) {
  return at.u[DofMap(*run.model).of(run.index(number), 1)];
}
double pressure(const WholeRun& run, int number) {
  return pressure(run, run.last(), number);
}

// A column of height 1 and width 1, E' = 1, nu' = 0, k / gamma_w = 1: c = 1.  Loaded by 1 at its top.
struct Column {
  LatticeMesh mesh;
  ModelInput input;

  explicit Column(std::vector<double> y, const std::string& element = "quad8p4", double nu = 0.0,
                  int columns = 1, Geometry geometry = Geometry::plane_strain)
      : mesh{.x = graded(0.0, 1.0, columns), .y = std::move(y), .element = element},
        input(pore_input(mesh, 1.0, nu, 1.0, geometry)) {
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(2 * columns), true, false),
                      held(mesh.row(0), true, true), drained(mesh.corner_row(top()))};
  }
  int top() const { return 2 * mesh.rows(); }
  void load(StageInput stage) {
    stage.pressures = {
        {.elements = mesh.upper_elements(), .edge = mesh.upper_edge(), .normal1 = 1.0, .normal2 = 1.0}};
    input.stages.push_back(stage);
  }
};

// A shut-in column carries a load by its water alone, in one step, without any settlement.
TEST(Consolidation, AShutInColumnCarriesItsLoadByWater) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
      SCOPED_TRACE(element);
      Column column(graded(0.0, 1.0, 4), element, 0.2, 2, geometry);
      column.load(shut_in());
      const WholeRun done = run(column.input);
      for (int j = 0; j <= column.top(); j += 2)
        for (int i = 0; i <= 4; i += 2) EXPECT_NEAR(pressure(done, column.mesh.node(i, j)), 1.0, 1e-10);
      EXPECT_LT(done.last().u.head(DofMap(*done.model).displacements()).cwiseAbs().maxCoeff(), 1e-10);
    }
}

// The first step below h^2 / (6 c): exact values of the discrete equations (backward Euler, ten elements).
TEST(Consolidation, TheFirstStepOscillatesAsTheDiscreteEquationsDo) {
  Column column(graded(0.0, 1.0, 10));
  column.load(shut_in());
  column.input.stages.push_back(consolidation(0.01 / 60.0, 1));
  const WholeRun done = run(column.input);
  const double exact[] = {1.2251482266, 0.9493082761, 1.0114131518};
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(pressure(done, column.mesh.node(0, column.top() - 2 * (k + 1))), exact[k], 1e-9) << k;
}

// Two ways: a layer whose base is closed is one half of a layer with two drains.
TEST(Consolidation, TwoDrainsAreOneOfHalfTheHeight) {
  const auto middle = [](bool two) {
    Column column(graded(0.0, 1.0, two ? 8 : 4));
    if (two) {
      column.input.supports.push_back(drained(column.mesh.corner_row(0)));
    } else {
      for (Vector2& x : column.input.nodes) x.y() *= 0.5;
    }
    column.load(shut_in());
    column.input.stages.push_back(consolidation(0.025, 5));
    const WholeRun done = run(column.input);
    return pressure(done, column.mesh.node(0, two ? 8 : 0));
  };
  EXPECT_NEAR(middle(true), middle(false), 1e-12);
}

// The middle nodes of a drained side become corners, and are drained: at a support and at an exit.
TEST(Consolidation, FinerMeshesKeepTheirDrains) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const bool exit : {false, true}) {
      SCOPED_TRACE(element);
      const auto with = [&](int rows, int columns, int refine) {
        Column column(graded(0.0, 1.0, rows), element, 0.0, columns);
        column.input.supports.pop_back();
        column.load(shut_in());
        column.input.stages.push_back(consolidation(0.2, 3));
        SupportInput drain = drained(column.mesh.corner_row(column.top()));
        drain.exit = exit;
        column.input.stages.back().supports = {drain};
        BuildOptions options;
        options.refine = refine;
        const WholeRun done = bench().run(build_model(column.input, bench().catalogue(), options));
        EXPECT_TRUE(done.completed()) << done.failure;
        return Vector2(done.u(column.mesh.node(columns, column.top())).y(),
                       pressure(done, column.mesh.node(0, 0)));
      };
      const Vector2 refined = with(4, 1, 1), given = with(8, 2, 0);
      EXPECT_NEAR(refined.x(), given.x(), 1e-11);
      EXPECT_NEAR(refined.y(), given.y(), 1e-11);
      EXPECT_LT(given.y(), 0.99);
    }
}

// ---- steps in time ----

// Terzaghi's column, loaded at once, in steps that are chosen by their error.
WholeRun column_in_time(int rows, double time_error, std::vector<double> times, double end_degree = 0.0,
                        double end_pressure = 0.0, std::span<Observer* const> others = {}) {
  Column column(graded(0.0, 1.0, rows));
  column.load(shut_in());
  StageInput wait = consolidation(2.0, 1);
  wait.time_error = time_error;
  wait.output_times = std::move(times);
  wait.end_degree = end_degree;
  wait.end_pressure = end_pressure;
  column.input.stages.push_back(wait);
  column.input.stages.push_back(consolidation(1.0, 2));
  WholeRun done = bench().run(build_model(column.input, bench().catalogue()), {}, others);
  EXPECT_TRUE(done.completed()) << done.failure;
  return done;
}

// The number behind some words of a message.
double number_behind(const WholeRun& run, const std::string& words) {
  for (const std::string& text : run.warnings)
    if (const std::size_t at = text.find(words); at != std::string::npos)
      return std::stod(text.substr(at + words.size()));
  ADD_FAILURE() << "no message has: " << words;
  return std::nan("");
}

// Pressure at mid-depth and degree of consolidation (settlement) of Terzaghi's series at T = 0.1 and 0.5.
TEST(Consolidation, TheStatedErrorOfTimeBoundsTheTrueOne) {
  const double exact[2][2] = {{0.735651315244, 0.356823400452}, {0.262188275575, 0.763950330744}};
  constexpr int kRows = 128;
  const Column lattice(graded(0.0, 1.0, kRows));
  const int middle = lattice.mesh.node(0, kRows), top = lattice.mesh.node(0, 2 * kRows);
  double before = 1.0;
  for (const double time_error : {1e-3, 1e-4, 1e-5}) {
    const WholeRun done = column_in_time(kRows, time_error, {0.1, 0.5});
    const double stated = number_behind(done, "add up to at most ");
    double truly = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Snapshot& at = done.increments[1 + i];
      EXPECT_NEAR(at.load_factor * 2.0, i == 0 ? 0.1 : 0.5, 1e-14);
      truly = std::max({truly, std::abs(pressure(done, at, middle) - exact[i][0]),
                        std::abs(-at.u[DofMap::displacement(done.index(top), 1)] - exact[i][1])});
    }
    std::printf("time_error %g: stated %g, true error %g\n", time_error, stated, truly);
    EXPECT_LE(truly, stated);
    EXPECT_LT(truly, 0.5 * before);
    EXPECT_LT(stated, 2000.0 * time_error);
    before = truly;
  }
}

struct TimeObserver final : Observer {
  std::vector<double> times;  // at the ends of increments
  void on_increment(const Model& model, const StepReport& step, const Solution&) override {
    double time = -step.early;
    for (int s = 0; s <= step.stage; ++s)
      time += model.stages[s].duration * (s == step.stage ? step.load_factor : 1.0);
    times.push_back(time);
  }
};

// U = 0.9 at T = 0.848084, where p at the base is 0.157079; one step of the run later at most.
TEST(Consolidation, AStageEndsByDegreeOrPressureAndTimeGoesOn) {
  constexpr double kT90 = 0.8480838, kBase = 0.1570792;
  for (const bool by_degree : {true, false}) {
    SCOPED_TRACE(by_degree);
    TimeObserver seen;
    Observer* also[] = {&seen};
    const WholeRun done = column_in_time(40, 1e-5, {}, by_degree ? 0.9 : 0.0, by_degree ? 0.0 : kBase, also);
    ASSERT_EQ(done.increments.size(), 4u);
    const double ended = seen.times[1] - 1.0;  // the undrained stage lasts 1
    EXPECT_GE(ended, kT90 - 5e-4);
    EXPECT_LE(ended, 1.15 * kT90);
    EXPECT_NEAR(seen.times[3], 1.0 + ended + 1.0, 1e-12);
    EXPECT_TRUE(done.warns("ended after a time of"));
  }
  EXPECT_TRUE(column_in_time(10, 1e-3, {}, 0.9999).warns("is over before the degree"));
}

// Without steps by error the stage ends behind an increment.
TEST(Consolidation, AStageOfEqualStepsEndsByDegree) {
  Column column(graded(0.0, 1.0, 20));
  column.load(shut_in());
  StageInput wait = consolidation(2.0, 100);
  wait.end_degree = 0.5;  // T = 0.196735
  column.input.stages.push_back(wait);
  const WholeRun done = run(column.input);
  EXPECT_NEAR(done.last().load_factor * 2.0, 0.20, 0.021);
  EXPECT_LT(done.increments.size(), 15u);
}

TEST(Consolidation, OutputTimesAreEndsOfIncrements) {
  Column column(graded(0.0, 1.0, 4));
  column.load(shut_in());
  StageInput wait = consolidation(2.0, 4);
  wait.output_times = {0.3, 1.0, 1.7};
  column.input.stages.push_back(wait);
  const WholeRun done = run(column.input);
  std::vector<double> times;
  for (const Snapshot& at : done.increments)
    if (at.stage == 1) times.push_back(2.0 * at.load_factor);
  const std::vector<double> wanted{0.3, 0.5, 1.0, 1.5, 1.7, 2.0};
  ASSERT_EQ(times.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(times[i], wanted[i], 1e-14);
  EXPECT_EQ(done.model->stages[1].output_at, (std::vector<int>{1, 3, 5}));
}

// ---- interfaces ----

// Two layers of height 1/2 with an interface between them, which leaks.
struct TwoLayers {
  Column column;
  int top = 0, above = 0, below = 0, base = 0;  // nodes on the left

  explicit TwoLayers(int rows, double conductance, Geometry geometry = Geometry::plane_strain)
      : column(graded(0.0, 1.0, rows), "quad8p4", 0.0, 1, geometry) {
    ModelInput& input = column.input;
    const std::vector<int> lower = column.mesh.row(rows);
    std::vector<int> upper;
    for (const int node : lower) {
      input.nodes.push_back(input.nodes[node - 1]);
      upper.push_back(static_cast<int>(input.nodes.size()));
    }
    for (std::vector<int>& nodes : input.groups[0].elements) {
      const auto is_above = [&](int node) { return input.nodes[node - 1].y() > 0.5 + 1e-9; };
      if (std::ranges::none_of(nodes, is_above)) continue;
      for (std::size_t i = 0; i < lower.size(); ++i) std::ranges::replace(nodes, lower[i], upper[i]);
    }
    input.supports.push_back(held({upper.front(), upper.back()}, true, false));
    input.materials.push_back(
        {"goodman", {{"shear_stiffness", 1e9}, {"normal_stiffness", 1e9}, {"tension", 1.0}}});
    input.materials.push_back({"pore_joint", {{"conductance", conductance}}});
    input.groups.push_back({.element = "interface6p4",
                            .material = 3,
                            .elements = {{lower[0], lower[2], upper[2], upper[0], lower[1], upper[1]}}});
    input.groups.back().second_material = 4;
    top = column.mesh.node(0, 2 * rows);
    above = upper.front();
    below = lower.front();
    base = column.mesh.node(0, 0);
  }
};

// At t = 0.1 and 0.5: pressures above, below, at the base, settlement.  Series of two layers with the resistance 1/2 between
// them (eigenfunctions), from an independent program.
TEST(Consolidation, ALeakingInterfaceFollowsItsSeries) {
  const double exact[2][4] = {{0.603673044172, 0.869791152894, 0.980130790835, 0.351858194255},
                              {0.239453189017, 0.445593077971, 0.552177597946, 0.679932371172}};
  const auto values = [](int rows) {
    TwoLayers layers(rows, 2.0);
    layers.column.load(shut_in());
    StageInput wait = consolidation(0.5, 1);
    wait.time_error = 1e-8;
    wait.output_times = {0.1};
    layers.column.input.stages.push_back(wait);
    const WholeRun done = run(layers.column.input);
    Eigen::Matrix<double, 2, 4> found;
    for (int i = 0; i < 2; ++i) {
      const Snapshot& at = done.increments[1 + i];
      found.row(i) << pressure(done, at, layers.above), pressure(done, at, layers.below),
          pressure(done, at, layers.base), -at.u[DofMap::displacement(done.index(layers.top), 1)];
    }
    return found;
  };
  const Eigen::Matrix<double, 2, 4> coarse = values(24), fine = values(48);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 4; ++k) {
      const double limit = (4.0 * fine(i, k) - coarse(i, k)) / 3.0;  // pressures have errors of order h^2
      EXPECT_NEAR(limit, exact[i][k], 1e-6) << i << k;
      EXPECT_NEAR(fine(i, k), exact[i][k], 2e-4) << i << k;
    }
}

// Between held pressures the flow is 1 / (1 / k + 1 / C) and linear in each layer.
TEST(Consolidation, SteadyFlowThroughALeakingInterface) {
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric})
    for (const double conductance : {0.0, 0.1, 2.0, 1e10}) {
      SCOPED_TRACE(conductance);
      TwoLayers layers(4, conductance, geometry);
      StageInput rise = consolidation(1e6, 6, 10.0);
      rise.supports = {drained(layers.column.mesh.corner_row(0), 1.0)};
      layers.column.input.stages = {rise, consolidation(1e6, 1)};
      const WholeRun done = run(layers.column.input);
      const double flow = conductance > 0.0 ? 1.0 / (1.0 + 1.0 / conductance) : 0.0;
      EXPECT_NEAR(pressure(done, layers.above), 0.5 * flow, 1e-8);
      EXPECT_NEAR(pressure(done, layers.below), 1.0 - 0.5 * flow, 1e-8);
    }
}

// Tight, the lower layer keeps its water; open, both are one.
TEST(Consolidation, AnInterfaceIsTightOrOpen) {
  const auto settled = [](double conductance) {
    TwoLayers layers(8, conductance);
    layers.column.load(shut_in());
    layers.column.input.stages.push_back(consolidation(0.5, 20));
    const WholeRun done = run(layers.column.input);
    return std::pair{pressure(done, layers.below), pressure(done, layers.above)};
  };
  Column whole(graded(0.0, 1.0, 8));
  whole.load(shut_in());
  whole.input.stages.push_back(consolidation(0.5, 20));
  const WholeRun one = run(whole.input);
  const double middle = pressure(one, whole.mesh.node(0, 8));
  EXPECT_NEAR(settled(1e10).first, middle, 1e-8);
  EXPECT_NEAR(settled(1e10).second, middle, 1e-8);
  EXPECT_NEAR(settled(0.0).first, 1.0, 1e-8);
  EXPECT_LT(settled(0.0).second, 0.3);
}

// ---- balances and limits ----

// A strip load on a block that drains through its top, with compressible water or not.
struct Block2d {
  LatticeMesh mesh;
  ModelInput input;

  explicit Block2d(const std::string& element, Geometry geometry = Geometry::plane_strain, double bulk = 0.0)
      : mesh{.x = graded(0.0, 2.0, 4, 1.2), .y = graded(0.0, 2.0, 4, 0.8), .element = element},
        input(pore_input(mesh, 10.0, 0.25, 0.3, geometry)) {
    if (bulk > 0.0) input.materials[1].parameters["water_bulk"] = bulk;
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(8), true, false),
                      held(mesh.row(0), true, true), drained(mesh.corner_row(8))};
  }
  void load(StageInput stage) {
    std::vector<int> under = mesh.upper_elements();
    under.resize(2);
    stage.pressures = {{.elements = under, .edge = mesh.upper_edge(), .normal1 = 1.0, .normal2 = 1.0}};
    input.stages.push_back(stage);
  }
};

// Sum over nodes of what has left, and the water in all elements: what the listing shows.
struct Volumes {
  double left = 0.0, content = 0.0, moved = 0.0;
};
struct VolumeObserver final : Observer {
  std::vector<Volumes> steps;
  std::vector<WaterBoundary> boundaries, before;  // of the last step, and of the one before
  double difference = 0.0;                        // largest, as a share of all volumes
  void on_increment(const Model& model, const StepReport&, const Solution& now) override {
    Volumes sums;
    const DofMap map(model);
    for (int dof = map.displacements(); dof < map.dofs(); ++dof) {
      sums.left += (*now.internal)[dof];
      sums.moved += std::abs((*now.internal)[dof]);
    }
    const WaterBalance balance = water_balance(model, now.stage, now);
    sums.content = balance.taken_up;
    difference = std::max(difference, std::abs(balance.difference()) / balance.scale);
    before = std::move(boundaries);
    boundaries = balance.boundaries;
    steps.push_back(sums);
  }
};

TEST(Consolidation, WaterIsBalancedInEveryStep) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric})
      for (const double bulk : {0.0, 50.0}) {
        SCOPED_TRACE(element);
        Block2d block(element, geometry, bulk);
        block.load(consolidation(1.0, 4));
        block.input.stages.push_back(consolidation(5.0, 6, 1.5, 0.5));
        VolumeObserver volumes;
        Observer* observers[] = {&volumes};
        const Model model = build_model(block.input, bench().catalogue());
        ASSERT_EQ(bench().run(model, observers).status, RunStatus::completed);
        ASSERT_EQ(volumes.steps.size(), 10u);
        for (const Volumes& step : volumes.steps) {
          EXPECT_GT(step.left, 1e-4);
          EXPECT_LE(std::abs(step.left + step.content), 1e-10 * step.moved);
        }
      }
}

// A block that drains through its top and its base: each has what passes there.  Loaded in one stage, shut in, let go.
TEST(Consolidation, EachBoundaryHasItsOutflow) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
      SCOPED_TRACE(element);
      Column column(graded(0.0, 1.0, 16), element, 0.0, 1, geometry);
      column.input.supports.push_back(drained(column.mesh.corner_row(0)));
      column.load(shut_in());
      column.input.stages.push_back(consolidation(20.0, 30, 1.3));
      VolumeObserver seen;
      Observer* also[] = {&seen};
      ASSERT_EQ(bench().run(build_model(column.input, bench().catalogue()), also).status, RunStatus::completed);
      EXPECT_LE(seen.difference, 1e-10);
      ASSERT_EQ(seen.boundaries.size(), 2u);
      // The column shortens by 1 of its height: half of that volume leaves at each end.
      const double area = geometry == Geometry::plane_strain ? 1.0 : kPi;
      for (const WaterBoundary& boundary : seen.boundaries) {
        EXPECT_EQ(boundary.nodes.size(), 2u);
        EXPECT_NEAR(boundary.left, 0.5 * area, 1e-9);
      }
    }
}

long yielding_points(const WholeRun& run);

// The shipped excavation, with its own settings: wall, joints, strut, two digs and a wait that ends by its degree.
TEST(Consolidation, AnExcavationWithWallAndJoints) {
  const std::string file = std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/models/excavation_in_clay.sage.toml";
  VolumeObserver seen;
  Observer* also[] = {&seen};
  const WholeRun done = bench().run(build_model(read_deck(file), bench().catalogue()), {}, also);
  ASSERT_TRUE(done.completed()) << done.failure;
  for (const Snapshot& at : done.increments) EXPECT_EQ(at.cuts, 0);
  EXPECT_LE(seen.difference, 1e-10);
  EXPECT_EQ(seen.boundaries.size(), 2u);  // the ground outside and the base of the dig
  EXPECT_TRUE(done.warns("ended after a time of"));
  EXPECT_LT(done.last().load_factor, 1.0);
  EXPECT_GT(yielding_points(done), 0);
  // Nothing jumps where a stage hands over to the next: the base rises on.
  const int base = done.index(465);
  double before = 0.0;
  for (const Snapshot& at : done.increments) {
    if (at.stage == 0) continue;
    const double rise = at.u[DofMap::displacement(base, 1)];
    EXPECT_GT(rise, before);
    EXPECT_LT(rise - before, 2.5e-3);
    before = rise;
  }
}

// Behind a long time nothing is left of the water: displacements are those of the skeleton alone.
TEST(Consolidation, ALongTimeEndsInTheDrainedState) {
  for (const char* element : {"quad8p4", "tri6p3"}) {
    SCOPED_TRACE(element);
    Block2d block(element);
    block.load(shut_in());
    block.input.stages.push_back(consolidation(1e6, 12, 10.0));
    const WholeRun wet = run(block.input);
    Block2d dry(element);
    dry.load({.title = "drained"});
    const WholeRun drained_run = run(dry.input);
    const int n = DofMap(*wet.model).displacements();
    const Eigen::VectorXd difference = wet.last().u.head(n) - drained_run.last().u.head(n);
    EXPECT_LT(difference.norm(), 1e-9 * drained_run.last().u.head(n).norm());
    // Solids of the same shape, without any water.
    ModelInput plain = dry.input;
    plain.supports.pop_back();
    plain.groups[0].element = std::string(element).substr(0, std::string(element).find('p'));
    plain.groups[0].second_material = 0;
    const WholeRun solid = run(plain);
    EXPECT_LT((solid.last().u.head(n) - wet.last().u.head(n)).norm(), 1e-9 * solid.last().u.norm());
  }
}

// In no time a step of consolidation is the undrained stage of the same elements where no node is drained.
TEST(Consolidation, NoTimeIsTheUndrainedState) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const double bulk : {0.0, 50.0}) {
      SCOPED_TRACE(element);
      const auto with = [&](const StageInput& stage) {
        Block2d block(element, Geometry::plane_strain, bulk);
        block.input.supports.pop_back();
        block.load(stage);
        return run(block.input);
      };
      const WholeRun none = with(shut_in()), little = with(consolidation(1e-12, 1));
      EXPECT_LT((none.last().u - little.last().u).norm(), 1e-9 * none.last().u.norm());
      EXPECT_GT(none.last().u.norm(), 0.1);
    }
}

// Permeability over twelve decades at the same k dt: the same answer, without a lost digit.
TEST(Consolidation, PermeabilityAndTimeScaleWithoutLoss) {
  const auto settled = [](double k) {
    Block2d block("quad8p4");
    block.input.materials[1].parameters["permeability"] = 0.3 * k;
    block.load(shut_in());
    block.input.stages.push_back(consolidation(2.0 / k, 4));
    return run(block.input).last().u;
  };
  const Eigen::VectorXd one = settled(1.0);
  for (const double k : {1e-12, 1e-6, 1e6}) EXPECT_LT((settled(k) - one).norm(), 1e-11 * one.norm()) << k;
}

// The unit of stress: kPa, MPa and psi-like sizes.
TEST(Consolidation, UnitsOfStressScaleWithoutLoss) {
  const auto settled = [](double unit) {
    Block2d block("quad8p4");
    block.input.materials[0].parameters["youngs_modulus"] = 10.0 * unit;
    block.input.materials[1].parameters["permeability"] = 0.3 / unit;
    block.load(shut_in());
    for (PressureInput& p : block.input.stages[0].pressures) p.normal1 = p.normal2 = unit;
    block.input.stages.push_back(consolidation(2.0, 4));
    const WholeRun done = run(block.input);
    return Eigen::VectorXd(done.last().u.head(DofMap(*done.model).displacements()));
  };
  const Eigen::VectorXd one = settled(1.0);
  for (const double unit : {1e-9, 1e-3, 1e9})
    EXPECT_LT((settled(unit) - one).norm(), 1e-11 * one.norm()) << unit;
}

// ---- stages behind one another ----

// ---- boundaries in time ----

// p(t) = 2 f(t) at both ends of a column with compressible water and a rigid skeleton would be diffusion; with a soft one it is
// too.  f is 0.5 at once, 1 from t = 1 on: the answer is a sum of Terzaghi's series, one for the jump and one for the ramp.
TEST(Consolidation, APressureFollowsItsHistory) {
  Column column(graded(0.0, 1.0, 40));
  StageInput rise = consolidation(2.0, 800);
  rise.theta = 1.0;
  SupportInput top = drained(column.mesh.corner_row(column.top()), 2.0);
  top.history = {{0.0, 0.5}, {1.0, 1.0}};
  rise.supports = {top};
  column.input.stages = {rise};
  const WholeRun done = run(column.input);
  const auto exact = [](double t) {  // at the closed base: 2 f(t) less what still has to come
    double p = t < 1.0 ? 1.0 + t : 2.0;
    for (int n = 0; n < 60; ++n) {
      const double m = (n + 0.5) * kPi, a = (n % 2 == 0 ? 2.0 : -2.0) / m, z = m * m;
      const double ramp =
          t < 1.0 ? (1.0 - std::exp(-z * t)) / z : (std::exp(-z * (t - 1.0)) - std::exp(-z * t)) / z;
      p -= a * (std::exp(-z * t) + ramp);
    }
    return p;
  };
  for (const int increment : {80, 200, 400, 600, 800}) {
    const Snapshot& at = done.increments[increment - 1];
    const double t = 2.0 * at.load_factor;
    EXPECT_NEAR(pressure(done, at, column.mesh.node(0, column.top())), t < 1.0 ? 1.0 + t : 2.0, 1e-12);
    EXPECT_NEAR(pressure(done, at, column.mesh.node(0, 0)), exact(t), 2e-3) << t;
  }
}

// A volume that comes in at the closed top with a history: all of it is in the ground at any time.
TEST(Consolidation, ALoadOfWaterFollowsItsHistory) {
  Column column(graded(0.0, 1.0, 4));
  column.input.supports.pop_back();
  StageInput rain = consolidation(4.0, 8);
  rain.loads = {{.nodes = column.mesh.corner_row(column.top()),
                 .x = -0.5,
                 .unknown = "excess_pressure",
                 .history = {{1.0, 0.2}, {2.0, 1.0}, {3.0, 0.6}}}};
  column.input.stages = {rain};
  VolumeObserver seen;
  Observer* also[] = {&seen};
  ASSERT_EQ(bench().run(build_model(column.input, bench().catalogue()), also).status, RunStatus::completed);
  const double share[] = {0.1, 0.2, 0.6, 1.0, 0.8, 0.6, 0.6, 0.6};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(seen.steps[i].content, share[i], 1e-10) << i;
  EXPECT_LE(seen.difference, 1e-10);
}

// Rain on a column whose base is a drain.  Weak rain soaks in: its steady flow q = 0.5 raises the surface to q H / k.  Strong rain
// ponds: the surface stays at the pressure of the pond, and what does not soak in runs off.
TEST(Consolidation, RainSoaksInOrPonds) {
  for (const double rain : {0.5, 3.0}) {
    SCOPED_TRACE(rain);
    Column column(graded(0.0, 1.0, 10));
    column.input.supports.pop_back();
    column.input.supports.push_back(drained(column.mesh.corner_row(0)));
    constexpr double kPond = 0.8, kTime = 40.0;
    StageInput wet = consolidation(kTime, 40);
    wet.supports = {{.nodes = column.mesh.corner_row(column.top()),
                     .x_value = kPond,
                     .unknown = "excess_pressure",
                     .exit = true}};
    wet.loads = {{.nodes = column.mesh.corner_row(column.top()),
                  .x = -0.5 * rain * kTime,
                  .unknown = "excess_pressure"}};
    column.input.stages = {wet};
    VolumeObserver seen;
    Observer* also[] = {&seen};
    const WholeRun done = bench().run(build_model(column.input, bench().catalogue()), {}, also);
    ASSERT_TRUE(done.completed()) << done.failure;
    EXPECT_FALSE(done.warns("no water can leave"));
    const double surface = std::min(rain, kPond);
    EXPECT_NEAR(pressure(done, column.mesh.node(0, column.top())), surface, 1e-9);
    EXPECT_NEAR(pressure(done, column.mesh.node(0, column.top() / 2)), 0.5 * surface, 1e-9);
    EXPECT_LE(seen.difference, 1e-10);
    ASSERT_EQ(seen.boundaries.size(), 2u);
    // In the last step the base passes what soaks in.
    const Volumes &last = seen.steps.back(), &before = seen.steps[seen.steps.size() - 2];
    EXPECT_NEAR(last.content, before.content, 1e-9);
    EXPECT_NEAR(seen.boundaries[0].left - seen.before[0].left, surface, 1e-9);
    EXPECT_NEAR(seen.boundaries[1].left - seen.before[1].left, -surface, 1e-9);
  }
}

// An exit lets water out and none in: under suction it is closed, under pressure it is a drain.
TEST(Consolidation, AnExitOpensUnderPressureAlone) {
  for (const double load : {1.0, -1.0}) {
    SCOPED_TRACE(load);
    const auto with = [&](bool exit) {
      Column column(graded(0.0, 1.0, 8));
      column.load(shut_in());
      column.input.stages[0].pressures[0].normal1 = column.input.stages[0].pressures[0].normal2 = load;
      column.input.supports.pop_back();
      StageInput wait = consolidation(0.3, 12);
      if (exit)
        wait.supports = {
            {.nodes = column.mesh.corner_row(column.top()), .unknown = "excess_pressure", .exit = true}};
      else if (load > 0.0)
        wait.supports = {drained(column.mesh.corner_row(column.top()))};
      column.input.stages.push_back(wait);
      return run(column.input);
    };
    const WholeRun exit = with(true), plain = with(false);
    const double size = plain.last().u.norm();
    EXPECT_LT((exit.last().u - plain.last().u).norm(), 1e-9 * size);
  }
}

// An inflow of 2 per area on half of the top: what comes in is q times the area and the time.
TEST(Consolidation, AnInflowOnEdgesIsAVolumePerAreaAndTime) {
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
      SCOPED_TRACE(element);
      Block2d block(element, geometry);
      block.input.supports = {held(block.mesh.column(0), true, false), held(block.mesh.row(0), true, true),
                              drained(block.mesh.corner_row(0))};
      StageInput wet = consolidation(0.5, 4);
      std::vector<int> half = block.mesh.upper_elements();
      half.resize(2);
      wet.pressures = {{.elements = half,
                        .edge = block.mesh.upper_edge(),
                        .normal1 = 2.0,
                        .normal2 = 2.0,
                        .unknown = "excess_pressure"}};
      block.input.stages = {wet};
      const WholeRun even = run(block.input);
      const double x = block.mesh.x[2], area = geometry == Geometry::axisymmetric ? kPi * x * x : x;
      const DofMap map(*even.model);
      const Eigen::VectorXd& loads = even.last().external;
      const double brought = -loads.tail(map.dofs() - map.displacements()).sum();
      EXPECT_NEAR(brought, 2.0 * 0.5 * area, 1e-12);
      // In time: twice as much in the first tenth, nothing in the rest.
      block.input.stages[0].pressures[0].history = {{0.0, 2.0}, {0.1, 2.0}, {0.1 + 1e-9, 0.0}};
      block.input.stages[0].output_times = {0.05, 0.3};
      const WholeRun rain = run(block.input);
      const auto volume = [&](double share) {
        for (const Snapshot& at : rain.increments)
          if (std::abs(at.load_factor - share) < 1e-9)
            return -at.external.tail(map.dofs() - map.displacements()).sum();
        return std::nan("");
      };
      const double first = 4.0 * 0.1 * area;
      EXPECT_NEAR(volume(0.1), 0.5 * first, 1e-8);
      EXPECT_NEAR(volume(0.6), first, 1e-7);
      EXPECT_NEAR(volume(1.0), first, 1e-7);
    }
}

// From q1 to q2 along the right side of a column: the mean of both.
TEST(Consolidation, AnInflowMayVaryAlongAnEdge) {
  Column column(graded(0.0, 1.0, 4));
  StageInput wet = consolidation(1.0, 1);
  wet.pressures = {{.elements = {4}, .edge = 2, .normal1 = 1.0, .normal2 = 3.0, .unknown = "excess_pressure"}};
  column.input.stages = {wet};
  const WholeRun done = run(column.input);
  const DofMap map(*done.model);
  const auto load = [&](int j) { return -done.last().external[map.of(done.index(column.mesh.node(2, j)), 1)]; };
  EXPECT_NEAR(load(6) + load(8), 2.0 * 0.25, 1e-14);
  EXPECT_NEAR(load(8) - load(6), 2.0 * 0.25 / 6.0, 1e-14);
}

// Stages without load or time change nothing, in any order.
TEST(Consolidation, EmptyStagesChangeNothing) {
  Block2d block("quad8p4");
  block.load(shut_in());
  block.input.stages.push_back(consolidation(0.5, 3));
  const WholeRun before = run(block.input);
  const Eigen::VectorXd u = before.last().u;
  const int free = block.mesh.node(4, 0);
  for (const bool kept_first : {true, false}) {
    ModelInput input = block.input;
    StageInput kept{.title = "kept"};
    input.stages.push_back(kept_first ? kept : shut_in());
    input.stages.push_back(kept_first ? shut_in() : kept);
    const WholeRun done = run(input);
    // Shut in, drained nodes are free; their pressures stay too, since nothing moves.
    EXPECT_LT((done.last().u - u).norm(), 1e-10 * u.norm());
    // And consolidation goes on as if they had not been there.
    input.stages.push_back(consolidation(0.5, 3));
    ModelInput straight = block.input;
    straight.stages.push_back(consolidation(0.5, 3));
    const WholeRun after = run(input), without = run(straight);
    EXPECT_LT((after.last().u - without.last().u).norm(), 1e-10 * u.norm());
    EXPECT_GT(std::abs(pressure(after, free) - pressure(before, free)), 1e-3);
  }
}

// Whatever a stage has done, the next one starts from it: stages in which nothing grows and no time passes change nothing,
// behind a load that is undrained, drained or applied while water flows, and behind a change of the steady pressure.
TEST(Consolidation, StagesHandOverWithoutAJump) {
  const auto level = [](int stage, double y) {
    WaterCard card;
    card.stage = stage;
    card.kind = WaterKind::line;
    card.line = {{0.0, y}, {2.0, y}};
    return card;
  };
  const std::vector<StageInput> kinds{shut_in(), {.title = "kept"}, consolidation(1.0, 2)};
  for (std::size_t first = 0; first < kinds.size(); ++first)
    for (const bool rises : {false, true})  // the steady pressure, in place of the load
      for (std::size_t second = 0; second < kinds.size(); ++second) {
        SCOPED_TRACE(testing::Message() << first << rises << second);
        Block2d block("quad8p4");
        block.input.supports.pop_back();
        block.load(kinds[first]);
        if (rises) block.input.stages.back().pressures.clear();
        StageInput next = kinds[second];
        next.duration = 1e-12;
        block.input.stages.push_back(next);
        // Goes on: with and without the stage between.
        block.load(shut_in());
        Model model = build_model(block.input, bench().catalogue());
        model.water = {level(0, rises ? 2.0 : 1.0)};
        const WholeRun with = bench().run(std::move(model));
        ASSERT_TRUE(with.completed()) << with.failure;
        ModelInput without_input = block.input;
        without_input.stages.erase(without_input.stages.begin() + 1);
        Model without_model = build_model(without_input, bench().catalogue());
        without_model.water = {level(0, rises ? 2.0 : 1.0)};
        const WholeRun without = bench().run(std::move(without_model));
        ASSERT_TRUE(without.completed()) << without.failure;
        std::vector<Eigen::VectorXd> ends(4);
        for (const Snapshot& at : with.increments) ends[at.stage] = at.u;
        ends[3] = without.last().u;
        ASSERT_GT(ends[2].norm(), 1e-3);
        EXPECT_LT((ends[1] - ends[0]).norm(), 1e-9 * ends[2].norm());
        EXPECT_LT((ends[3] - ends[2]).norm(), 1e-9 * ends[2].norm());
      }
}

// ---- undrained groups and seepage beside consolidation ----

// A layer of quad8p4 on one of quad8, which water cards can shut in; a lattice of flow elements gives heads to both.
struct TwoSoils {
  Block2d block{"quad8p4"};
  std::string water;  // cards of a model file

  TwoSoils() {
    GroupInput lower = block.input.groups[0], upper = lower;
    lower.element = "quad8";
    lower.second_material = 0;
    const auto half = static_cast<std::ptrdiff_t>(upper.elements.size() / 2);
    lower.elements.erase(lower.elements.begin() + half, lower.elements.end());
    upper.elements.erase(upper.elements.begin(), upper.elements.begin() + half);
    block.input.groups = {lower, upper};
  }
  // The lower layer, from that stage on.
  void shut(int stage) { card("undrained", stage, "group = 1\nvalue1 = 1000.0\n"); }
  void open(int stage) { card("drained", stage, "group = 1\n"); }
  void level(int stage, double y) {
    card("line", stage, "values = [[0.0, " + std::to_string(y) + "], [2.0, " + std::to_string(y) + "]]\n");
  }
  void card(const std::string& kind, int stage, const std::string& rest) {
    water += "\n[[water]]\nkind = \"" + kind + "\"\nstage = " + std::to_string(stage) + "\n" + rest;
  }
  WholeRun run() const {
    Diagnostics notes;
    const std::string text =
        model_file_text(build_model(block.input, bench().catalogue()), bench().catalogue(), notes) + water;
    WholeRun done = bench().run(build_model(read_model_file_text(text, "two.sage.toml"), bench().catalogue()));
    EXPECT_TRUE(done.completed()) << done.failure;
    return done;
  }
};

// Elastic soil: whichever order the lower layer is loaded in, shut in, opened, its steady pressure changed and the upper layer
// left to consolidate, the end is that of the drained soil under all of it, and a stage without load or time changes nothing.
TEST(Consolidation, UndrainedGroupsAndSteadyPressuresHandOver) {
  enum class Event { load, shut, open, level };
  const std::vector<std::vector<Event>> orders{{Event::shut, Event::load, Event::open, Event::level},
                                               {Event::load, Event::shut, Event::open, Event::level},
                                               {Event::level, Event::shut, Event::load, Event::open},
                                               {Event::shut, Event::open, Event::level, Event::load}};
  TwoSoils all;
  all.block.load({.title = "drained"});
  all.level(1, 1.5);
  const Eigen::VectorXd drained_u = all.run().last().u;
  const auto n = DofMap(build_model(all.block.input, bench().catalogue())).displacements();
  for (const std::vector<Event>& order : orders) {
    TwoSoils soils;
    int stage = 0;
    for (const Event event : order) {
      ++stage;
      if (event == Event::load)
        soils.block.load(consolidation(0.2, 2));
      else
        soils.block.input.stages.push_back(consolidation(0.2, 2));
      if (event == Event::shut) soils.shut(stage);
      if (event == Event::open) soils.open(stage);
      if (event == Event::level) soils.level(stage, 1.5);
      soils.block.input.stages.push_back(consolidation(1e-12, 1));
      ++stage;
    }
    soils.block.input.stages.push_back(consolidation(1e6, 12, 10.0));
    const WholeRun done = soils.run();
    EXPECT_LT((done.last().u.head(n) - drained_u.head(n)).norm(), 1e-9 * drained_u.head(n).norm());
    std::vector<Eigen::VectorXd> ends(soils.block.input.stages.size());
    for (const Snapshot& at : done.increments) ends[at.stage] = at.u;
    for (std::size_t i = 1; i < ends.size(); i += 2)
      EXPECT_LT((ends[i] - ends[i - 1]).norm(), 1e-9 * drained_u.norm()) << i;
  }
}

// A drained load while pressures are kept: what it squeezes out is no load of the next stage.
TEST(Consolidation, WaterOfDrainedStagesDoesNotComeBack) {
  Block2d block("quad8p4");
  block.load({.title = "drained"});
  block.input.stages.push_back(consolidation(1.0, 3));
  const WholeRun done = run(block.input);
  const Eigen::VectorXd& first = done.increments.front().u;
  EXPECT_LT((done.last().u - first).norm(), 1e-10 * first.norm());
}

// The pressure of a drain follows its card: steady flow at the end, exactly linear along a column.
TEST(Consolidation, AHeldPressureIsReached) {
  Column column(graded(0.0, 1.0, 4));
  StageInput rise = consolidation(1.0, 4);
  rise.supports = {drained(column.mesh.corner_row(0), 2.0)};
  column.input.stages.push_back(rise);
  column.input.stages.push_back(consolidation(1e4, 8, 10.0));
  const WholeRun done = run(column.input);
  EXPECT_NEAR(pressure(done, done.increments[1], column.mesh.node(0, 0)), 1.0, 1e-12);
  for (int j = 0; j <= 8; j += 2) EXPECT_NEAR(pressure(done, column.mesh.node(0, j)), 2.0 - 0.25 * j, 1e-9);
}

// ---- laws ----

void add_strip(Block2d& block, const StageInput& stage, double load) {
  block.load(stage);
  PressureInput& last = block.input.stages.back().pressures[0];
  last.normal1 = last.normal2 = load;
}

// A block that starts with 50 in all directions, under as much on its top; then a strip load.
Block2d loaded_block(const MaterialInput& law, StageInput strip, double load) {
  Block2d block("quad8p4");
  block.input.materials[0] = law;
  block.input.initials = {{.group = 1, .kind = InitialKind::uniform, .values = {50.0, 50.0, 50.0, 0.0}}};
  StageInput all{.title = "surcharge"};
  all.pressures = {{.elements = block.mesh.upper_elements(),
                    .edge = block.mesh.upper_edge(),
                    .normal1 = 50.0,
                    .normal2 = 50.0}};
  block.input.stages = {all};
  strip.tolerance = 1e-11;
  add_strip(block, strip, load);
  return block;
}

struct LawOfSoil {
  MaterialInput material;
  bool yields = true;
  bool parts = false;  // increments are taken in parts, whose sizes depend on the state
};
const std::vector<LawOfSoil>& laws_of_soil() {
  static const std::vector<LawOfSoil> laws{
      {{"linear_elastic", {{"youngs_modulus", 1e4}, {"poissons_ratio", 0.3}}}, false},
      {{"mohr_coulomb",
        {{"youngs_modulus", 1e4}, {"poissons_ratio", 0.3}, {"cohesion", 2.0}, {"friction_angle", 22.0}}}},
      {{"drucker_prager",
        {{"youngs_modulus", 1e4}, {"poissons_ratio", 0.3}, {"cohesion", 2.0}, {"friction_angle", 22.0}}}},
      {{"mohr_coulomb_softening",
        {{"youngs_modulus", 1e4},
         {"poissons_ratio", 0.3},
         {"cohesion", 3.0},
         {"friction_angle", 22.0},
         {"dilation_angle", 0.0},
         {"strain_1", 0.1},
         {"cohesion_1", 2.5},
         {"friction_angle_1", 21.0},
         {"dilation_angle_1", 0.0}}}},
      {{"modified_cam_clay",
        {{"M", 1.0},
         {"lambda", 0.2},
         {"kappa", 0.04},
         {"specific_volume", 2.2},
         {"poissons_ratio", 0.3},
         {"ocr", 1.2}}},
       true,
       true}};
  return laws;
}

long yielding_points(const WholeRun& run) {
  return run.last().points[static_cast<std::size_t>(PointStatus::yielded)];
}

// A load that grows so slowly that no pressure is left is the drained load of quad8, of any law; one in no time is the
// undrained stage.
TEST(Consolidation, EveryLawHasItsDrainedAndUndrainedLimit) {
  constexpr int kIncrements = 4;
  for (const LawOfSoil& law : laws_of_soil()) {
    SCOPED_TRACE(law.material.law);
    Block2d dry = loaded_block(law.material, {.increments = kIncrements}, 250.0);
    dry.input.groups[0].element = "quad8";
    dry.input.groups[0].second_material = 0;
    dry.input.supports.pop_back();
    dry.input.materials.pop_back();
    const WholeRun drained = run(dry.input),
                   slow = run(loaded_block(law.material, consolidation(1e12, kIncrements), 250.0).input);
    const auto closed = [&](StageInput strip) {
      strip.increments = kIncrements;
      Block2d block = loaded_block(law.material, strip, 80.0);
      block.input.supports.pop_back();
      return run(block.input);
    };
    const WholeRun undrained = closed(shut_in()), fast = closed(consolidation(1e-18, kIncrements));
    const Eigen::Index n = DofMap(*drained.model).dofs();
    const auto difference = [&](const WholeRun& a, const WholeRun& b) {
      return (a.last().u.head(n) - b.last().u.head(n)).norm() / b.last().u.head(n).norm();
    };
    EXPECT_LT(difference(slow, drained), 1e-9);
    EXPECT_LT(difference(fast, undrained), law.parts ? 1e-6 : 1e-9);
    EXPECT_EQ(yielding_points(drained) > 0, law.yields);
  }
}

struct ResidualObserver final : Observer {
  std::vector<std::vector<double>> steps;
  void on_increment(const Model&, const StepReport& step, const Solution&) override {
    std::vector<double> forces;
    for (const IterationRecord& one : step.iterations) forces.push_back(one.force);
    steps.push_back(forces);
  }
};

// Half of an embankment in two lifts with a wait between them, on clay of Mohr-Coulomb's law.
TEST(Consolidation, AnEmbankmentOnMohrCoulombConvergesQuadratically) {
  Block2d block = loaded_block(laws_of_soil()[1].material, consolidation(1e-5, 4), 90.0);
  block.input.stages.push_back(consolidation(2e-4, 4, 2.0));
  add_strip(block, consolidation(1e-5, 4), 60.0);
  for (StageInput& stage : block.input.stages) stage.tolerance = 1e-11;
  ResidualObserver seen;
  Observer* also[] = {&seen};
  const WholeRun done = bench().run(build_model(block.input, bench().catalogue()), {}, also);
  ASSERT_TRUE(done.completed()) << done.failure;
  EXPECT_GT(yielding_points(done), 0);
  int pairs = 0;
  for (const std::vector<double>& f : seen.steps)
    for (std::size_t i = 1; i < f.size(); ++i) {
      if (!(f[i - 1] > 1e-6 && f[i - 1] < 1e-3)) continue;
      EXPECT_LT(f[i], 1e3 * f[i - 1] * f[i - 1]);
      ++pairs;
    }
  EXPECT_GE(pairs, 5);
}

// ---- cards ----

// The wide layout has all that the model says.
TEST(Consolidation, ADeckSaysWhatTheModelSays) {
  Block2d block("quad8p4");
  block.load(shut_in());
  block.input.stages.push_back(consolidation(2.5, 4, 1.5, 0.75));
  const Model model = build_model(block.input, bench().catalogue());
  Diagnostics notes;
  const std::string text = sage1_text(model, notes);
  EXPECT_EQ(notes.warnings(), 0);
  const Model again =
      build_model(read_deck_text(text, "written", load_layout("sage1_wide")), bench().catalogue());
  EXPECT_EQ(fingerprint(model), fingerprint(again));
  EXPECT_EQ(again.stages[1].pores, PoreWater::flows);
  EXPECT_EQ(again.stages[1].theta, 0.75);
  EXPECT_EQ(again.stages[1].grading, 1.5);
}

std::string refusal(const ModelInput& input) {
  try {
    build_model(input, bench().catalogue());
  } catch (const InputError& error) {
    std::string all;
    for (const Diagnostic& d : error.diagnostics().list()) all += to_string(d) + "\n";
    return all;
  }
  return "taken";
}

TEST(Consolidation, StepsInTimeGoThroughDecksAndModelFiles) {
  Block2d block("quad8p4");
  block.load(shut_in());
  StageInput wait = consolidation(2.5, 4, 1.5);
  wait.time_error = 1e-4;
  wait.end_degree = 0.95;
  wait.end_pressure = 0.125;
  wait.output_times = {0.1, 1.0 / 3.0, 2.0};
  block.input.stages.push_back(wait);
  StageInput wet = consolidation(3.0, 2);
  wet.supports = {drained(block.mesh.corner_row(8), 2.0)};
  wet.supports[0].history = {{0.0, 0.5}, {2.0 / 3.0, 1.0}};
  wet.loads = {{.nodes = {1}, .x = 0.25, .unknown = "excess_pressure", .history = {{1.0, 0.25}}}};
  block.input.stages.push_back(wet);
  block.input.stages.push_back(consolidation(1.0, 1));
  const Model model = build_model(block.input, bench().catalogue());
  Diagnostics notes;
  const std::string deck = sage1_text(model, notes), file = model_file_text(model, bench().catalogue(), notes);
  EXPECT_EQ(notes.warnings(), 0);
  for (const std::string& text : {deck, file}) {
    const Model again = build_model(text == file ? read_model_file_text(text, "written.sage.toml")
                                                 : read_deck_text(text, "written", load_layout("sage1_wide")),
                                    bench().catalogue());
    EXPECT_EQ(fingerprint(model), fingerprint(again));
    EXPECT_EQ(again.stages[1].output_times, wait.output_times);
    EXPECT_EQ(again.stages[1].given_increments(), 4);
    EXPECT_EQ(again.stages[1].increments, 7);
    EXPECT_EQ(again.stages[1].end_pressure, 0.125);
    EXPECT_EQ(again.stages[2].field_fixities[0].history, wet.supports[0].history);
    EXPECT_EQ(again.stages[2].field_loads[0].history, wet.loads[0].history);
  }
}

TEST(Consolidation, BadInputIsRefusedByName) {
  const auto with = [](const auto& change) {
    Block2d block("quad8p4");
    block.load(consolidation(1.0, 2));
    change(block.input);
    return refusal(block.input);
  };
  EXPECT_EQ(with([](ModelInput&) {}), "taken");
  EXPECT_NE(with([](ModelInput& i) { i.stages[0].theta = 0.4; }).find("S362"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.stages[0].grading = -2.0; }).find("S362"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.stages[0].theta = std::nan(""); }).find("theta"), std::string::npos);
  for (const auto& change : std::initializer_list<std::function<void(StageInput&)>>{
           [](StageInput& s) { s.time_error = -1e-3; }, [](StageInput& s) { s.time_error = 0.5; },
           [](StageInput& s) { s.time_error = 1e-3, s.theta = 0.5; }, [](StageInput& s) { s.end_degree = 1.0; },
           [](StageInput& s) { s.end_degree = 0.9; },  // it loads
           [](StageInput& s) { s.end_pressure = -1.0; },
           [](StageInput& s) {
             s.output_times = {0.5, 1.5};
           },
           [](StageInput& s) { s.output_times = {0.0}; }})
    EXPECT_NE(with([&](ModelInput& i) { change(i.stages[0]); }).find("S579"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) {
              i.stages[0].pores = PoreWater::shut_in;
              i.stages[0].time_error = 1e-3;
            }).find("S579"),
            std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.groups[0].second_material = 0; }).find("pore_flow"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.groups[0].second_material = 1; }).find("pore_flow"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.groups[0].second_material = 9; }).find("S204"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.groups[0].material = 2; }).find("S225"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.units.water_unit_weight = 0.0; }).find("water"), std::string::npos);
  EXPECT_NE(with([](ModelInput& i) { i.materials[1].parameters["permeability"] = 0.0; }).find("permeability"),
            std::string::npos);
  EXPECT_NE(with([](ModelInput& i) {
              i.materials[1] = {"darcy", {{"permeability", 1.0}}};
            }).find("pore_flow"),
            std::string::npos);
  EXPECT_NE(with([](ModelInput& i) {
              i.groups[0].element = "quad8";
              i.groups[0].second_material = 0;
              i.supports.pop_back();
            }).find("S361"),
            std::string::npos);
}

TEST(Consolidation, AShortFirstStepIsNamed) {
  const auto first = [](double dt) {
    Column column(graded(0.0, 1.0, 10));
    column.load(shut_in());
    column.input.stages.push_back(consolidation(dt, 1));
    return run(column.input);
  };
  const WholeRun little = first(0.9 * 0.01 / 6.0), tiny = first(0.1 * 0.01 / 6.0),
                 enough = first(1.01 * 0.01 / 6.0);
  EXPECT_TRUE(little.warns("element(s) 10 beside drained nodes"));
  EXPECT_TRUE(tiny.warns("oscillate from corner to corner"));
  EXPECT_FALSE(enough.warns("oscillate"));
}

// A part whose whole boundary is held, of water that cannot be compressed: the level of its pressure is open.
TEST(Consolidation, AnOpenLevelIsNamed) {
  Column column(graded(0.0, 1.0, 2));
  column.input.supports.pop_back();
  column.input.supports.push_back(held(column.mesh.row(4), true, true));
  column.input.stages = {consolidation(1.0, 1)};
  column.input.stages[0].loads = {{.nodes = {column.mesh.node(0, 2)}, .x = 0.1, .unknown = "excess_pressure"}};
  const WholeRun done = bench().run(build_model(column.input, bench().catalogue()));
  EXPECT_EQ(done.result.status, RunStatus::singular);
  EXPECT_NE(done.result.reason.find("excess_pressure"), std::string::npos) << done.result.reason;
}

// ---- work ----

TEST(Consolidation, OneFactorisationServesEqualSteps) {
  Block2d block("quad8p4");
  block.load(shut_in());
  block.input.stages.push_back(consolidation(1.0, 20));
  const WholeRun done = run(block.input);
  EXPECT_EQ(done.result.work.factorisations, 2);  // undrained, and the step
  EXPECT_LE(done.result.work.solves, 24);
}

// A mesh with equal parts; in the second stage the steps have another size, in the third one they grow.
TEST(Consolidation, EqualPartsAreEliminatedOnceInEqualSteps) {
  const LatticeMesh mesh{.x = graded(0.0, 1.0, 30), .y = graded(0.0, 2.0, 60)};
  ModelInput input = pore_input(mesh, 1.0, 0.2, 1.0);
  input.supports = {held(mesh.column(0), true, false), held(mesh.row(0), true, true),
                    drained(mesh.corner_row(2 * mesh.rows()))};
  StageInput load = shut_in();
  const std::vector<int> all = mesh.upper_elements(), loaded(all.begin(), all.begin() + 12);
  load.pressures = {{.elements = loaded, .edge = mesh.upper_edge(), .normal1 = 1.0, .normal2 = 1.0}};
  input.stages = {load, consolidation(0.1, 3), consolidation(1.0, 2), consolidation(5.0, 3, 2.0)};
  RunSettings plain;
  plain.skips.twins = false;
  const WholeRun with = run(input), without = run(input, plain);
  EXPECT_GT(with.result.work.twin_equations, 1000);
  EXPECT_EQ(without.result.work.twin_equations, 0);
  ASSERT_EQ(with.increments.size(), without.increments.size());
  for (std::size_t i = 0; i < with.increments.size(); ++i)
    EXPECT_TRUE(with.increments[i].u == without.increments[i].u) << i;
}

// Forces of elastic soil by the matrices of a step, and states where they are needed: as with every element in every pass.
TEST(Consolidation, MatricesOfAStepChangeNothing) {
  struct LastStates final : Observer {
    std::vector<std::vector<double>> sigma, eps, h;
    bool wants_states(const Model& model, const StepReport& step) const override {
      return step.stage + 1 == static_cast<int>(model.stages.size()) && step.increment == step.increments;
    }
    void on_increment(const Model& model, const StepReport& step, const Solution& now) override {
      if (!wants_states(model, step)) return;
      for (const GroupData& data : now.groups()) {
        sigma.push_back(data.state.committed.sigma);
        eps.push_back(data.state.committed.eps);
        h.push_back(data.state.committed.h);
      }
    }
  };
  const auto near = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    const Eigen::Map<const Eigen::VectorXd> x(a.data(), static_cast<Eigen::Index>(a.size())),
        y(b.data(), x.size());
    EXPECT_GT(y.norm(), 1e-3);
    EXPECT_LT((x - y).norm(), 1e-11 * y.norm());
  };
  for (const char* element : {"quad8p4", "tri6p3"})
    for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
      SCOPED_TRACE(element);
      Block2d block(element, geometry, 50.0);
      block.load(shut_in());
      block.input.stages.push_back(consolidation(1.0, 3, 1.5, 0.7));
      block.load({.title = "kept"});
      StageInput chosen = consolidation(3.0, 1);
      chosen.time_error = 1e-3;
      block.input.stages.push_back(chosen);
      LastStates mine, all;
      Observer *also_mine[] = {&mine}, *also_all[] = {&all};
      const Model model = build_model(block.input, bench().catalogue());
      RunSettings settings = bench().settings();
      ASSERT_EQ(sage::run(model, bench().catalogue(), settings, also_mine).status, RunStatus::completed);
      settings.skips.elements = false;
      ASSERT_EQ(sage::run(model, bench().catalogue(), settings, also_all).status, RunStatus::completed);
      near(mine.sigma.at(0), all.sigma.at(0));
      near(mine.eps.at(0), all.eps.at(0));
      near(mine.h.at(0), all.h.at(0));
    }
}

TEST(Consolidation, RestartsToTheLastBit) {
  Block2d block("tri6p3");
  block.load(shut_in());
  block.input.stages.push_back(consolidation(1.0, 3, 1.5, 0.7));
  StageInput chosen = consolidation(3.0, 3, 2.0);
  chosen.time_error = 1e-3;
  chosen.end_degree = 0.6;
  block.input.stages.push_back(chosen);
  block.input.stages.push_back({.title = "kept"});
  block.input.stages.push_back(consolidation(1.0, 2));
  std::vector<std::string> checkpoints;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { checkpoints.push_back(bytes); };
  const WholeRun whole = run(block.input, settings);
  ASSERT_GE(checkpoints.size(), 6u);
  for (const std::string& bytes : checkpoints) {
    RunSettings again;
    again.resume_from = bytes;
    const WholeRun rest = run(block.input, again);
    if (!rest.increments.empty()) {
      EXPECT_EQ(rest.last().u, whole.last().u);
    }
  }
}

TEST(Consolidation, SolversAgree) {
  for (const double duration : {1e-10, 1.0}) {
    Block2d block("quad8p4");
    block.load(shut_in());
    block.input.stages.push_back(consolidation(duration, 2));
    const Eigen::VectorXd u = run(block.input).last().u;
    for (const int code : {1, 2, 5, 8}) {
      RunSettings settings;
      settings.solver = code;
      EXPECT_LT((run(block.input, settings).last().u - u).norm(), 1e-11 * u.norm()) << code;
    }
  }
}

}  // namespace
}  // namespace sage
