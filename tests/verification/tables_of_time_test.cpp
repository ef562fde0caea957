// Loads and displacements that follow a table of time within a stage.  docs/manual/stages.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/dof_map.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/model_file/model_file.hpp"
#include "tests/studies/scenes/consolidation.hpp"
#include "tests/studies/workbench.hpp"

namespace sage {
namespace {

using namespace scenes;

constexpr double kModulus = 1000.0;

const Workbench& tables_bench() {
  static const Workbench bench = app::make_workbench();
  return bench;
}

WholeRun complete(const ModelInput& input, const RunSettings& settings = {}, const BuildOptions& options = {}) {
  WholeRun done = tables_bench().run(build_model(input, tables_bench().catalogue(), options), settings);
  EXPECT_TRUE(done.completed()) << done.failure;
  return done;
}

// Up, down below the start, up again; the last factor stays.  Its slope changes between the three increments of the stage.
const TimeTable kTable{{1.0, 1.0}, {2.0, -0.25}, {3.0, 0.5}};
constexpr double kDuration = 4.0;

double factor(double t) {
  if (t <= 1.0) return t;
  if (t <= 2.0) return 1.0 - 1.25 * (t - 1.0);
  if (t <= 3.0) return -0.25 + 0.75 * (t - 2.0);
  return 0.5;
}

enum class Driven { pressure, forces, displacement };

// A column of height 2 and width 1 without flow, nu = 0: it is compressed evenly in both geometries.
struct DryColumn {
  LatticeMesh mesh{.x = graded(0.0, 1.0, 1), .y = graded(0.0, 2.0, 3), .element = "quad8p4"};
  ModelInput input;

  explicit DryColumn(Geometry geometry) : input(pore_input(mesh, kModulus, 0.0, 1.0, geometry)) {
    input.groups[0].element = "quad8";
    input.groups[0].second_material = 0;
    input.materials.resize(1);
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(2), true, false),
                      held(mesh.row(0), true, true)};
  }
  std::vector<int> top() const { return mesh.row(2 * mesh.rows()); }

  // Each settles the top by 2 p / E where the table is p.
  void drive(Driven by, double p, const TimeTable& table, StageInput& stage) const {
    if (by == Driven::pressure) {
      stage.pressures = {{.elements = mesh.upper_elements(),
                          .edge = mesh.upper_edge(),
                          .normal1 = p,
                          .normal2 = p,
                          .history = table}};
    } else if (by == Driven::displacement) {
      stage.supports = {held(top(), false, true)};
      stage.supports[0].y_value = -2.0 * p / kModulus;
      stage.supports[0].history = table;
    } else {  // Simpson's weights: the forces of an even pressure in plane strain
      for (int i = 0; i < 3; ++i)
        stage.loads.push_back({.nodes = {top()[i]}, .y = -p * (i == 1 ? 4.0 : 1.0) / 6.0, .history = table});
    }
  }
  StageInput stage(Driven by, double p = 10.0) const {
    StageInput stage{.increments = 3, .duration = kDuration};
    drive(by, p, kTable, stage);
    return stage;
  }
};

// u = -(p0 + p(t)) h / E at the end of every increment, and the increments end at the table's times, too.
TEST(TablesOfTime, AnElasticColumnFollowsEachOfThem) {
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric})
    for (const Driven by : {Driven::pressure, Driven::forces, Driven::displacement}) {
      if (by == Driven::forces && geometry == Geometry::axisymmetric) continue;  // other weights
      SCOPED_TRACE(static_cast<int>(by));
      DryColumn column(geometry);
      StageInput first{.increments = 1};
      column.drive(by, 4.0, {}, first);
      column.input.stages = {first, column.stage(by)};
      const WholeRun done = complete(column.input);
      ASSERT_EQ(done.increments.size(), 7u);
      const double ends[] = {1.0, 4.0 / 3.0, 2.0, 8.0 / 3.0, 3.0, 4.0};
      for (std::size_t i = 0; i < 6; ++i) {
        const Snapshot& at = done.increments[i + 1];
        EXPECT_NEAR(at.load_factor * kDuration, ends[i], 1e-12);
        const double p = 4.0 + 10.0 * factor(ends[i]);
        for (const int node : column.top())  // rounding of a solution of 1e-2
          EXPECT_NEAR(at.u[DofMap::displacement(done.index(node), 1)], -2.0 * p / kModulus, 1e-14) << i;
      }
    }
}

// Loads of a later stage go on from the last factor, not from the whole value.
TEST(TablesOfTime, TheLastFactorStays) {
  DryColumn column(Geometry::plane_strain);
  StageInput next{.increments = 1};
  column.drive(Driven::forces, 3.0, {}, next);
  column.input.stages = {column.stage(Driven::pressure), next};
  const WholeRun done = complete(column.input);
  EXPECT_NEAR(done.u(column.top()[0]).y(), -2.0 * (5.0 + 3.0) / kModulus, 1e-14);
}

TEST(TablesOfTime, FinerMeshesAndSkipsFollowThem) {
  for (const Driven by : {Driven::pressure, Driven::displacement}) {
    DryColumn column(Geometry::plane_strain);
    column.input.stages = {column.stage(by)};
    BuildOptions finer;
    finer.refine = 1;
    RunSettings plain;
    for (const SkipName& skip : kSkipNames) plain.skips.*skip.flag = false;
    for (const WholeRun& done : {complete(column.input, {}, finer), complete(column.input, plain)}) {
      ASSERT_EQ(done.increments.size(), 6u);
      for (const Snapshot& at : done.increments)
        for (int node = 0; node < done.model->mesh.nodes(); ++node) {
          const double p = 10.0 * factor(at.load_factor * kDuration), y = done.model->mesh.x(1, node);
          EXPECT_NEAR(at.u[DofMap::displacement(node, 1)], -p * y / kModulus, 1e-14);
        }
    }
  }
}

// Tresca soil whose cohesion grows from 4 to 6 over a plastic shear strain of 0.1, in a column that is free at its sides: the
// stress is elastic up to 2 c, and c grows by H = 20 times kappa, which is twice the plastic part of the strain.
TEST(TablesOfTime, AYieldingColumnFollowsThem) {
  constexpr double kCohesion = 4.0, kGrowth = 20.0;
  DryColumn column(Geometry::plane_strain);
  column.input.materials[0] = {"mohr_coulomb_softening",
                               {{"youngs_modulus", kModulus},
                                {"poissons_ratio", 0.0},
                                {"cohesion", kCohesion},
                                {"friction_angle", 0.0},
                                {"dilation_angle", 0.0},
                                {"strain_1", 0.1},
                                {"cohesion_1", kCohesion + 0.1 * kGrowth},
                                {"friction_angle_1", 0.0},
                                {"dilation_angle_1", 0.0}}};
  column.input.supports = {held({column.mesh.row(0)[0]}, true, false), held(column.mesh.row(0), false, true)};
  column.input.stages = {column.stage(Driven::displacement)};
  const WholeRun done = complete(column.input);
  double stress = 0.0, c = kCohesion, before = 0.0, largest = 0.0;
  for (const Snapshot& at : done.increments) {
    const double strain = 10.0 / kModulus * factor(at.load_factor * kDuration);
    stress += kModulus * (strain - before);
    before = strain;
    if (const double beyond = std::abs(stress) - 2.0 * c; beyond > 0.0) {
      const double plastic = beyond / (kModulus + 4.0 * kGrowth);
      stress -= std::copysign(kModulus * plastic, stress);
      c += 2.0 * kGrowth * plastic;
    }
    largest = std::max(largest, std::abs(stress));
    EXPECT_NEAR(done.reaction(at, column.top(), 1), -stress, 1e-6) << at.load_factor;
  }
  EXPECT_GT(largest, 2.0 * kCohesion);
}

// ---- consolidation under a ramp ----

constexpr double kRamp = 0.2, kEnd = 0.5;

// Olson (1977): excess pressure at the closed base of a layer of height 1 with c = 1, loaded by t / kRamp, then 1.
double olson(double t) {
  double p = 0.0;
  for (int m = 0; m < 200; ++m) {
    const double M = (m + 0.5) * kPi, z = M * M, sign = m % 2 == 0 ? 1.0 : -1.0;
    const double decay = t <= kRamp ? 1.0 - std::exp(-z * t) : std::exp(-z * (t - kRamp)) - std::exp(-z * t);
    p += sign * 2.0 / (M * z * kRamp) * decay;
  }
  return p;
}

struct WetColumn {
  LatticeMesh mesh{.x = graded(0.0, 1.0, 1), .y = graded(0.0, 1.0, 64), .element = "quad8p4"};
  ModelInput input = pore_input(mesh, 1.0, 0.0, 1.0);

  explicit WetColumn(StageInput ramp) {
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(2), true, false),
                      held(mesh.row(0), true, true), drained(mesh.corner_row(2 * mesh.rows()))};
    ramp.pressures = {{.elements = mesh.upper_elements(),
                       .edge = mesh.upper_edge(),
                       .normal1 = 1.0,
                       .normal2 = 1.0,
                       .history = {{kRamp, 1.0}}}};
    input.stages = {ramp};
  }
  double base(const WholeRun& run, const Snapshot& at) const {
    return at.u[DofMap(*run.model).of(run.index(mesh.node(0, 0)), 1)];
  }
};

// The same layer as a drawing, loaded at once: the line that drains holds the nodes that have a pressure, corners alone.  Series
// of Terzaghi at T = .5, with what 200 steps of backward Euler leave of each term; 20 elements are good to 2e-4.
TEST(TablesOfTime, ADrawnLayerConsolidates) {
  const std::string text = R"(
geometry = "plane strain"
units = {length = "m", force = "kN", stress = "kPa", water_unit_weight = 10}
mesh = {element = "quad8p4", size = 0.05, mesher = "blocks"}
material = [
  {name = "clay", law = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0},
  {name = "water", law = "pore_flow", permeability = 10},
]
line = [
  {name = "base", points = [[0, 0], [0.05, 0]]},
  {name = "sides", points = [[0, 0], [0, 1]]},
  {name = "other", points = [[0.05, 0], [0.05, 1]]},
  {name = "top", points = [[0, 1], [0.05, 1]]},
]
area = [{name = "layer", outline = [[0, 0], [0.05, 0], [0.05, 1], [0, 1]], material = "clay", second_material = "water"}]
fixity = [
  {line = "base", x = "fixed", y = "fixed"}, {line = "sides", x = "fixed"}, {line = "other", x = "fixed"},
  {line = "top", x = "fixed", unknown = "excess_pressure"},
]
[[stage]]
pore_water = 1
pressure = [{line = "top", normal1 = 1, normal2 = 1}]
[[stage]]
pore_water = 2
increments = 200
duration = 0.5
)";
  const WholeRun run = tables_bench().run(
      build_model(read_model_file_text(text, "layer.sage.toml"), tables_bench().catalogue(), {}));
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_EQ(run.model->field_fixities.size(), 2u);
  double exact = 0.0;
  for (int m = 0; m < 50; ++m) {
    const double M = (m + 0.5) * kPi;
    exact += (m % 2 == 0 ? 2.0 : -2.0) / M * std::pow(1.0 + M * M * 0.5 / 200.0, -200.0);
  }
  const Mesh& mesh = run.model->mesh;
  int base = 0;
  while (mesh.x.col(base).norm() > 1e-12) ++base;
  EXPECT_NEAR(run.last().u[DofMap(*run.model).of(base, 1)], exact, 2e-4 * exact);
}

// Largest error at the base from the end of the ramp on.
double error_of(const StageInput& stage) {
  const WetColumn column(stage);
  const WholeRun done = complete(column.input);
  double worst = 0.0;
  bool has_corner = false;
  for (const Snapshot& at : done.increments) {
    const double t = at.load_factor * kEnd;
    has_corner = has_corner || std::abs(t - kRamp) < 1e-12;
    if (t >= kRamp - 1e-12) worst = std::max(worst, std::abs(column.base(done, at) - olson(t)));
  }
  EXPECT_TRUE(has_corner);
  return worst;
}

// Halved steps halve the error of backward Euler and quarter that of Crank-Nicolson.  The mesh itself has 1e-5.
TEST(TablesOfTime, RampOfTerzaghiConvergesWithTheOrderOfTheta) {
  const auto steps = [](int n, double theta) { return consolidation(kEnd, n, 1.0, theta); };
  const double first = error_of(steps(50, 1.0)), second = error_of(steps(100, 1.0));
  EXPECT_LT(first, 1e-2);
  EXPECT_NEAR(first / second, 2.0, 0.1);
  const double coarse = error_of(steps(10, 0.5)), fine = error_of(steps(20, 0.5));
  EXPECT_LT(coarse, 1e-2);
  EXPECT_NEAR(coarse / fine, 4.0, 0.6);
}

// Steps that are chosen by their error end at the corner, which is no end of the three increments, and keep the stated sum.
TEST(TablesOfTime, StepsByTheirErrorKeepTheStatedSum) {
  for (const double wanted : {1e-3, 1e-4}) {
    StageInput stage = consolidation(kEnd, 3);
    stage.time_error = wanted;
    const WetColumn column(stage);
    const WholeRun done = complete(column.input);
    ASSERT_EQ(done.increments.size(), 4u);
    const auto note = std::ranges::find_if(done.warnings, [](const std::string& text) {
      return text.find("add up to at most ") != std::string::npos;
    });
    ASSERT_NE(note, done.warnings.end());
    const std::string before = "add up to at most ";
    const double stated = std::stod(note->substr(note->find(before) + before.size()));
    EXPECT_LT(stated, 100.0 * wanted);
    EXPECT_LT(error_of(stage), stated + 1e-5);  // 1e-5: of the mesh
  }
}

TEST(TablesOfTime, RestartsToTheLastBit) {
  DryColumn dry(Geometry::axisymmetric);
  dry.input.stages = {dry.stage(Driven::pressure), dry.stage(Driven::displacement)};
  StageInput chosen = consolidation(kEnd, 3);
  chosen.time_error = 1e-3;
  for (const ModelInput& input : {dry.input, WetColumn(chosen).input}) {
    std::vector<std::string> checkpoints;
    RunSettings settings;
    settings.checkpoint_due = [] { return true; };
    settings.save_checkpoint = [&](const std::string& bytes) { checkpoints.push_back(bytes); };
    const WholeRun whole = complete(input, settings);
    ASSERT_GE(checkpoints.size(), 3u);
    for (const std::string& bytes : checkpoints) {
      RunSettings again;
      again.resume_from = bytes;
      const WholeRun rest = complete(input, again);
      if (!rest.increments.empty()) {
        EXPECT_EQ(rest.last().u, whole.last().u);
      }
    }
  }
}

TEST(TablesOfTime, GoThroughDecksAndModelFiles) {
  DryColumn column(Geometry::plane_strain);
  StageInput all = column.stage(Driven::pressure);
  column.drive(Driven::displacement, 1.0, {{0.0, 0.0}, {1.0 / 3.0, 0.5}}, all);
  all.loads = {{.nodes = {column.mesh.node(0, 2)}, .y = 1.0, .history = {{2.0, 3.0}}}};
  column.input.stages = {all};
  const Model model = build_model(column.input, tables_bench().catalogue());
  EXPECT_EQ(model.stages[0].increments, 7);  // 1/3, 1, 4/3, 2, 8/3, 3 and 4
  Diagnostics notes;
  const std::string deck = sage1_text(model, notes),
                    file = model_file_text(model, tables_bench().catalogue(), notes);
  EXPECT_EQ(notes.warnings(), 0);
  for (const std::string& text : {deck, file}) {
    const Model again = build_model(text == file ? read_model_file_text(text, "written.sage.toml")
                                                 : read_deck_text(text, "written", load_layout("sage1_wide")),
                                    tables_bench().catalogue());
    EXPECT_EQ(fingerprint(model), fingerprint(again));
    EXPECT_EQ(again.stages[0].pressures[0].history, kTable);
    EXPECT_EQ(again.stages[0].loads[0].history, all.loads[0].history);
  }
}

TEST(TablesOfTime, MistakesAreOneErrorEach) {
  const auto refusal = [](const std::function<void(ModelInput&)>& change, const BuildOptions& options = {}) {
    DryColumn column(Geometry::plane_strain);
    column.input.stages = {column.stage(Driven::pressure)};
    change(column.input);
    try {
      build_model(column.input, tables_bench().catalogue(), options);
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().errors(), 1);
      return to_string(error.diagnostics().list().front());
    }
    return std::string("none");
  };
  const auto of_table = [&](const TimeTable& table) {
    return refusal([&](ModelInput& input) { input.stages[0].pressures[0].history = table; });
  };
  EXPECT_EQ(of_table(kTable), "none");
  EXPECT_NE(of_table({{1.0, 1.0}, {0.5, 0.0}}).find("must ascend"), std::string::npos);
  EXPECT_NE(of_table({{1.0, 1.0}, {1.0, 0.0}}).find("S591"), std::string::npos);
  EXPECT_NE(of_table({{-1.0, 1.0}}).find("S591"), std::string::npos);
  EXPECT_NE(of_table({{1.0, 1.0}, {4.5, 0.0}}).find("whose duration is 4"), std::string::npos);
  EXPECT_NE(of_table({{0.0, 1.0}}).find("at time 0 must be 0"), std::string::npos);
  const auto on_support_of_deck = [](ModelInput& input) {
    input.supports[0].nodes.resize(1);
    input.supports[0].history = kTable;
  };
  EXPECT_NE(refusal(on_support_of_deck).find("S591"), std::string::npos);
  EXPECT_NE(refusal([](ModelInput& input) { input.large_strain = true; }).find("large strains"),
            std::string::npos);
  BuildOptions coarser;
  coarser.coarsen = true;
  EXPECT_NE(refusal([](ModelInput&) {}, coarser).find("--coarsen"), std::string::npos);
}

}  // namespace
}  // namespace sage
