// Decks as limit analysis sees them, and what it rejects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"
#include "sage/safety/safety.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::bounds {
namespace {

const scenes::Workbench& bench() {
  static const scenes::Workbench made = [] {
    Catalogue catalogue;
    register_elements(catalogue);
    register_materials(catalogue);
    register_solvers(catalogue);
    return scenes::Workbench(std::move(catalogue), choose_solver);
  }();
  return made;
}

Model model_of(const std::string& deck, const BuildOptions& options = {}) {
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/" + deck);
  return bench().build({std::istreambuf_iterator<char>(in), {}}, options);
}

Bounds factor_of(const Model& model) {
  const Ground ground = make_ground(model, 0, static_cast<int>(model.stages.size()) - 1);
  Options options;
  options.quantity = Quantity::strength;
  options.elements = 0;
  return find_bounds(ground.domain, options);
}

void expect_around(const Bounds& found, double exact, double gap) {
  ASSERT_TRUE(found.lower.value) << found.lower.reason;
  ASSERT_TRUE(found.upper.value) << found.upper.reason;
  EXPECT_LE(*found.lower.value, exact);
  EXPECT_LE(*found.relative_gap(), gap);
  EXPECT_GE(*found.upper.value, 0.997 * exact);
}

// Log spirals through the toe, an upper bound (docs/theory/strength_reduction.md).
TEST(Ground, SlopeAndWaterPressures) {
  expect_around(factor_of(model_of("slopes/griffiths_lane/deck.dat")), 1.36821452, 0.02);
  expect_around(factor_of(model_of("slopes/griffiths_lane_ru/deck.dat")), 1.10035217, 0.02);
}

// Finite elements with associated flow: at most 2.5 % above the upper bound, less so on a finer mesh, never below the
// lower bound.  The other shipped slopes: scripts/check_bounds.
TEST(Ground, BoundsHoldForFiniteElements) {
  const Bounds found = factor_of(model_of("slopes/acads_1a/deck.dat"));
  ASSERT_TRUE(found.lower.value && found.upper.value);
  double before = 1.025 * *found.upper.value;
  for (const int refine : {0, 1}) {
    BuildOptions build;
    build.refine = refine;
    build.associated = true;
    Model model = model_of("slopes/acads_1a/deck.dat", build);
    safety::Options options;
    options.limits.tolerance = 0.004;
    options.limits.start = 0.9;
    const safety::Safety safety = safety::find_safety(model, bench().catalogue(), bench().settings(), options);
    ASSERT_TRUE(safety.complete()) << safety.incomplete;
    EXPECT_GE(*safety.upper, *found.lower.value);
    EXPECT_LE(*safety.lower, before);
    before = *safety.lower;
  }
}

// A slope 1:1 of height 1 with so many cells of quad8 in its height.
scenes::DeckWriter slope(int cells, const std::vector<double>& soil, double weight, double run,
                         double unit = 1.0) {
  scenes::Block block;
  block.columns = block.rows = cells;
  block.cell = scenes::Cell::quad8;
  block.straight = true;
  block.place = [=](double s, double t) -> Vector2 { return {unit * s * (1.2 + run - run * t), unit * t}; };
  scenes::DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 4, soil, weight);
  deck.group(1, 2, 1, 1);
  block.write_elements(deck, 1);
  for (const int n : block.left()) deck.fix(n, 1, 0);
  for (const int n : block.bottom()) deck.fix(n, 1, 1);
  deck.stage().gravity_y = -1.0;
  return deck;
}

Bounds factor_of(const scenes::DeckWriter& deck) {
  return factor_of(bench().build(deck.text()));
}

// With phi = 0 the factor is inverse to weight, far below 1 as well.
TEST(Ground, SlopesThatFail) {
  const std::vector<double> clay{1e4, 0.49, 1.0, 0.0, 0.0};
  const Bounds stable = factor_of(slope(6, clay, 2.0, 1.0)), fails = factor_of(slope(6, clay, 20.0, 1.0));
  ASSERT_TRUE(stable.lower.value && stable.upper.value && fails.lower.value && fails.upper.value);
  EXPECT_LT(*fails.upper.value, 0.5);
  EXPECT_NEAR(10.0 * *fails.lower.value, *stable.lower.value, 2e-4 * *stable.lower.value);
  EXPECT_NEAR(10.0 * *fails.upper.value, *stable.upper.value, 2e-4 * *stable.upper.value);
}

// Without cohesion a layer along the face slides at tan(phi) / tan(b): the upper field may find less, the lower none more.
TEST(Ground, SlopeOfSandHasBoundsOrAReason) {
  const double exact = 2.0 * std::tan(35.0 * kRadiansPerDegree);
  const Bounds found = factor_of(slope(6, {1e4, 0.3, 0.0, 35.0, 35.0}, 20.0, 2.0));
  if (found.lower.value)
    EXPECT_LE(*found.lower.value, exact * (1.0 + 1e-9));
  else
    EXPECT_FALSE(found.lower.reason.empty());
  if (found.upper.value)
    EXPECT_GE(*found.upper.value, 0.9 * exact);
  else
    EXPECT_FALSE(found.upper.reason.empty());
}

// Micrometres and gigapascals, or the other way.
TEST(Ground, SlopesInOtherUnits) {
  const auto in = [](double length, double stress) {
    return factor_of(
        slope(5, {1e4 * stress, 0.3, 1.0 * stress, 20.0, 20.0}, 10.0 * stress / length, 1.0, length));
  };
  const Bounds one = in(1.0, 1.0);
  ASSERT_TRUE(one.lower.value && one.upper.value);
  for (const auto& [length, stress] : {std::pair{1e6, 1.0}, {1e-6, 1.0}, {1.0, 1e6}, {1.0, 1e-6}, {1e6, 1e6}}) {
    const Bounds other = in(length, stress);
    ASSERT_TRUE(other.lower.value && other.upper.value) << length << " " << stress << other.lower.reason;
    EXPECT_NEAR(*other.lower.value, *one.lower.value, 2e-4 * *one.lower.value);
    EXPECT_NEAR(*other.upper.value, *one.upper.value, 2e-4 * *one.upper.value);
  }
}

// Refined from halves of the deck's quadrilaterals.  Taylor's log spiral through the toe is an upper bound.
TEST(Ground, SteepSlopeWithoutFriction) {
  const Model model = model_of("slopes/taylor_60/deck.dat");
  Options options;
  options.quantity = Quantity::strength;
  const Bounds found = find_bounds(make_ground(model, 0, 0, nullptr, options.elements).domain, options);
  ASSERT_TRUE(found.relative_gap());
  EXPECT_LE(*found.relative_gap(), 0.015);
  EXPECT_LE(*found.lower.value, 5.247358 / 5.0);
  EXPECT_GE(*found.upper.value, 1.0313);  // the lower bound on this mesh
}

// Pore pressure gamma_w (h - y) at every node of the deck, from the heads that a run leaves at the start of the stage.
TEST(Ground, HeadsOfAFlow) {
  const Model model = model_of("seepage/earth_dam/deck.dat");
  ASSERT_TRUE(wants_heads(model, 1));
  EXPECT_FALSE(wants_heads(model, 0));
  EXPECT_THROW((void)make_ground(model, 1, 1), InputError);
  const scenes::WholeRun run = bench().run(model_of("seepage/earth_dam/deck.dat"));
  ASSERT_TRUE(run.completed());
  const Eigen::VectorXd& u = run.increments.front().u;
  const Ground ground = make_ground(model, 1, 1, &u);
  const DofMap map(model);
  const int field = find_unknown(model.unknowns, "head");
  int found = 0;
  for (const Triangle& t : ground.domain.triangles)
    for (int i = 0; i < 3; ++i) {
      const Vector2& x = ground.domain.x[at(t.node[at(i)])];
      for (int node = 0; node < model.mesh.nodes(); ++node) {
        if ((model.mesh.x.col(node) - x).norm() > 1e-9) continue;
        const double p = 9.81 * std::max(0.0, u[map.of(node, field)] - x.y());
        EXPECT_NEAR(ground.domain.pressure(t, i), p, 1e-9);
        found += p > 1.0 ? 1 : 0;
      }
    }
  EXPECT_GT(found, 300);
}

// Where elements leave no room for refinement a quadrilateral becomes two triangles.
TEST(Ground, DividesQuadrilaterals) {
  const auto triangles = [](double phi, int room) {
    const Model model = bench().build(slope(3, {1e4, 0.3, 1.0, phi, phi}, 10.0, 1.0).text());
    return make_ground(model, 0, 0, nullptr, room).domain.triangles.size();
  };
  EXPECT_EQ(triangles(20.0, 0), 36U);
  EXPECT_EQ(triangles(20.0, 100), 36U);
  EXPECT_EQ(triangles(20.0, 40), 18U);
  EXPECT_EQ(triangles(0.0, 40), 18U);
}

// The material's psi becomes phi before elements and law are chosen.
TEST(Ground, AssociatedModels) {
  BuildOptions build;
  build.associated = true;
  const Model model = bench().build(slope(1, {1e4, 0.3, 1.0, 20.0, 0.0}, 10.0, 1.0).text(), build);
  EXPECT_EQ(model.materials[0].parameters[4], 20.0);
}

std::string code_of(const Model& model) {
  try {
    (void)make_ground(model, 0, static_cast<int>(model.stages.size()) - 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Ground, RejectsByName) {
  EXPECT_NE(code_of(model_of("chapter7/dp_285/deck.dat")).find("axisymmetric"), std::string::npos);
  EXPECT_NE(code_of(model_of("structures/sheet_pile/deck.dat")).find("is a structure"), std::string::npos);
  EXPECT_NE(code_of(model_of("hyperbolic/strip_footing/deck.dat")).find("has no bounds"), std::string::npos);
  Model large = model_of("slopes/taylor_60/deck.dat");
  large.large_strain = true;
  EXPECT_NE(code_of(large).find("small strain"), std::string::npos);
}

}  // namespace
}  // namespace sage::bounds
