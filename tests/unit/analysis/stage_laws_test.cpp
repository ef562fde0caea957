// Laws that differ by stage or by point: lock-off of bars, displacements that count anew, parameters that grow with depth,
// other materials with the stress kept.  Right values are closed forms; each test says which.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sage/app/commands.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/safety/safety.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

using scenes::WholeRun;

const scenes::Workbench& workbench() {
  static const scenes::Workbench bench = app::make_workbench();
  return bench;
}

Model model_of(const std::string& text) {
  return build_model(read_model_file_text(text, "stages.sage.toml"), workbench().catalogue());
}

WholeRun run_model(const std::string& text, const RunSettings& settings = {}) {
  return workbench().run(model_of(text), settings);
}

// From every checkpoint the run ends bit for bit where the whole one ends.
void expect_restarts(const std::string& text) {
  std::vector<std::string> states;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& state) { states.push_back(state); };
  const WholeRun whole = run_model(text, settings);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  ASSERT_FALSE(states.empty());
  for (const std::string& state : states) {
    RunSettings again;
    again.resume_from = state;
    const WholeRun rest = run_model(text, again);
    EXPECT_TRUE(rest.last().u == whole.last().u);
    EXPECT_TRUE(rest.last().internal == whole.last().internal);
    for (std::size_t g = 0; g < whole.stress.size(); ++g) EXPECT_TRUE(rest.stress[g] == whole.stress[g]);
  }
}

// Code and line of the first error of a model.
std::string first_error(const std::string& text) {
  try {
    model_of(text);
  } catch (const InputError& error) {
    for (const Diagnostic& one : error.diagnostics().list())
      if (one.severity == Severity::error) return to_string(one.code);
  }
  return "none";
}

std::string head(bool ring) {
  return fmt::format("title = \"stages\"\ngeometry = \"{}\"\n", ring ? "axisymmetric" : "plane strain");
}
const std::string kUnits = "[units]\nlength = \"m\"\nforce = \"kN\"\nstress = \"kPa\"\n";

// A prop (EA 300, length 3) below node 2 and an anchor (EA 500 of one bar, one every 2 m, length 2) above it, both upright
// at x = 2.  Loads along y at node 2: `first` in stage 1, `second` in stage 3; the anchor is locked off in stage 2.
std::string prop_and_anchor(bool ring, double first, double second, double lock_off,
                            bool anchor_before = false) {
  const double measure = ring ? 2.0 * std::numbers::pi * 2.0 : 1.0;
  return head(ring) +
         "node = [{x = 2.0, y = 0.0}, {x = 2.0, y = 3.0}, {x = 2.0, y = 5.0}]\n"
         "element = [{group = \"prop\", nodes = [1, 2]}, {group = \"anchor\", nodes = [2, 3]}]\n"
         "fixity = [{first = 1, last = 3, step = 2, x = \"fixed\", y = \"fixed\"}, {first = 2, x = "
         "\"fixed\"}]\n" +
         kUnits +
         "[[material]]\nname = \"steel\"\nlaw = \"axial_elastic\"\nstiffness = 300.0\n"
         "[[material]]\nname = \"tendon\"\nlaw = \"axial_elastic\"\nstiffness = 500.0\nspacing = 2.0\n"
         "[[group]]\nname = \"prop\"\nelement = \"bar2\"\nmaterial = \"steel\"\n"
         "[[group]]\nname = \"anchor\"\nelement = \"bar2\"\nmaterial = \"tendon\"\n" +
         fmt::format("[[stage]]\ntitle = \"load\"\nload = [{{first = 2, y_force = {}}}]\n", first * measure) +
         fmt::format(
             "[[stage]]\ntitle = \"lock off\"\nincrements = 2\n{}initial = [{{group = \"anchor\", kind = "
             "\"lock off\", values = [{}]}}]\n",
             anchor_before ? "" : "birth = [\"anchor\"]\n", lock_off) +
         fmt::format("[[stage]]\ntitle = \"more\"\nincrements = 2\nload = [{{first = 2, y_force = {}}}]\n",
                     second * measure);
}

// Springs of 300 / 3 = 100 and 250 / 2 = 125 per unit of width.  The anchor's tension of 40 on one bar, 20 per unit, pulls
// node 2 up by 20 / 100; of the later load the anchor takes 125 / 225.
TEST(StageLaws, LockOffStandsAndThenTheBarIsElastic) {
  for (const bool ring : {false, true}) {
    const WholeRun run = run_model(prop_and_anchor(ring, -10.0, -9.0, -40.0));
    ASSERT_TRUE(run.completed()) << run.failure;
    ASSERT_EQ(run.increments.size(), 5u);
    const auto uy = [&](int increment) {
      return run.increments[increment].u[DofMap::displacement(run.index(2), 1)];
    };
    EXPECT_NEAR(uy(0), -0.1, 1e-12);
    EXPECT_NEAR(uy(1), 0.0, 1e-12);  // half of the stage
    EXPECT_NEAR(uy(2), 0.1, 1e-12);
    EXPECT_NEAR(uy(4), 0.1 - 9.0 / 225.0, 1e-12);
    EXPECT_NEAR(run.stress[1](0, 0), 20.0 + 125.0 * 9.0 / 225.0, 1e-11);
    EXPECT_NEAR(run.stress[0](0, 0), -10.0 + 20.0 - 100.0 * 9.0 / 225.0, 1e-11);
  }
}

// An anchor that is there from the start takes its share of the first load, and then has the stated force whatever it was.
TEST(StageLaws, AnAnchorIsStressedAgain) {
  const WholeRun run = run_model(prop_and_anchor(false, -9.0, 0.0, -40.0, true));
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.increments[0].u[DofMap::displacement(run.index(2), 1)], -9.0 / 225.0, 1e-12);
  EXPECT_NEAR(run.stress[1](0, 0), 20.0, 1e-11);
  EXPECT_NEAR(run.u(2).y(), (20.0 - 9.0) / 100.0, 1e-12);
}

TEST(StageLaws, LockOffGoesOnFromCheckpoints) {
  expect_restarts(prop_and_anchor(true, -10.0, -9.0, -40.0));
}

TEST(StageLaws, LockOffIsWrittenAndReadAgain) {
  const Model model = model_of(prop_and_anchor(false, -10.0, -9.0, -40.0));
  Diagnostics lost;
  const std::string text = model_file_text(model, workbench().catalogue(), lost);
  EXPECT_TRUE(lost.list().empty());
  EXPECT_EQ(model_file_text(model_of(text), workbench().catalogue(), lost), text);
  EXPECT_TRUE(run_model(text).last().u == run_model(prop_and_anchor(false, -10.0, -9.0, -40.0)).last().u);
}

// A column of unit width from y = -8 to 0 in four quad4 of 2 m, held along x at its sides and pressed on its top.
std::string column(bool ring, const std::string& materials, const std::string& rest) {
  return head(ring) +
         "node = [{number = 1, x = 0.0, y = -8.0}, {number = 9, step = 2, x = 0.0, y = 0.0},\n"
         "  {number = 2, x = 1.0, y = -8.0}, {number = 10, step = 2, x = 1.0, y = 0.0}]\n"
         "element = [{group = \"soil\", nodes = [1, 2, 4, 3], rows = 4, row_step = 2}]\n"
         "fixity = [{first = 1, last = 2, x = \"fixed\", y = \"fixed\"}, {first = 1, last = 10, x = "
         "\"fixed\"}]\n" +
         kUnits + materials + "[[group]]\nname = \"soil\"\nelement = \"quad4\"\nmaterial = \"first\"\n" + rest;
}
std::string elastic(const std::string& name, double E, double nu = 0.0) {
  return fmt::format(
      "[[material]]\nname = \"{}\"\nlaw = \"linear_elastic\"\nyoungs_modulus = {:.6f}\npoissons_ratio = {}\n",
      name, E, nu);
}
std::string press(const std::string& more, double pressure) {
  return fmt::format("[[stage]]\n{}\npressure = [{{element = 4, edge = 3, normal1 = {}, normal2 = {}}}]\n",
                     more, pressure, pressure);
}

// Settlement p h / E of each stage, nu = 0: after the reset that of the second alone.  Stresses go on.
TEST(StageLaws, DisplacementsCountFromTheStageThatResetsThem) {
  for (const bool ring : {false, true}) {
    const std::string text =
        column(ring, elastic("first", 1000.0),
               press("", 50.0) + press("reset_displacements = true\nincrements = 2", 20.0) + press("", 5.0));
    const WholeRun run = run_model(text);
    ASSERT_TRUE(run.completed()) << run.failure;
    const auto top = [&](std::size_t i) { return run.increments[i].u[DofMap::displacement(run.index(9), 1)]; };
    EXPECT_NEAR(top(0), -50.0 * 8.0 / 1000.0, 1e-12);
    EXPECT_NEAR(top(1), -10.0 * 8.0 / 1000.0, 1e-12);
    EXPECT_NEAR(top(2), -20.0 * 8.0 / 1000.0, 1e-12);
    EXPECT_NEAR(top(3), -25.0 * 8.0 / 1000.0, 1e-12);
    for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) EXPECT_NEAR(run.stress[0](1, p), -75.0, 1e-10);
    expect_restarts(text);
  }
}

// E = 1000 + 250 (-2 - y) below y = -2.  The operator of each 2 m element has its points at -+ 1/sqrt(3); with nu = 0 and
// one pressure the strain of a quad4 is constant over it, p / mean(E) of its points: the mean of E over a layer in which it
// is linear is that at its middle.
TEST(StageLaws, AStiffnessGrowsWithDepth) {
  for (const bool ring : {false, true}) {
    const std::string text =
        column(ring, elastic("first", 1000.0),
               "[[initial]]\ngroup = \"soil\"\nkind = \"parameter\"\nparameter = \"youngs_modulus\"\n"
               "values = [0, -2.0, 250.0]\n" +
                   press("increments = 2", 60.0));
    const WholeRun run = run_model(text);
    ASSERT_TRUE(run.completed()) << run.failure;
    const double settlement = 60.0 * (2.0 / 1000.0 + 2.0 / 1250.0 + 2.0 / 1750.0 + 2.0 / 2250.0);
    EXPECT_NEAR(run.u(9).y(), -settlement, 1e-9);
    expect_restarts(text);
  }
}

// E = 500 + 20 sigma_v'.  Of a saturated column (18 per m, water to the top at 10) sigma_v' = 8 (-y): 8, 24, 40 and 56 in the
// middle of the elements, whose mean E are 660, 980, 1300, 1620.  Stated by a geostatic card, or found from the weight.
TEST(StageLaws, AStiffnessGrowsWithTheVerticalStress) {
  const std::string water =
      "[[water]]\nkind = \"line\"\nvalues = [[0.0, 0.0], [1.0, 0.0]]\naction = \"none\"\n";
  const std::string grows =
      "[[initial]]\ngroup = \"soil\"\nkind = \"parameter\"\nparameter = \"youngs_modulus\"\n"
      "values = [0, 0, 0, 20.0]\n";
  const std::string stated =
      "[[initial]]\ngroup = \"soil\"\nkind = \"geostatic\"\nvalues = [0.0, 18.0, 0.0, 0.0]\n";
  for (const std::string& start : {std::string(), stated}) {
    std::string text = column(
        false, elastic("first", 500.0),
        start + grows + "[[stage]]\ngravity_y = -1.0\n" + press("reset_displacements = true", 30.0) + water);
    const std::string law = "law = \"linear_elastic\"\n", units = "stress = \"kPa\"\n";
    text.replace(text.find(law), law.size(), law + "unit_weight = 18.0\n");
    text.replace(text.find(units), units.size(), units + "water_unit_weight = 10.0\n");
    const WholeRun run = run_model(text);
    ASSERT_TRUE(run.completed()) << run.failure;
    const double settlement = 30.0 * 2.0 * (1.0 / 660.0 + 1.0 / 980.0 + 1.0 / 1300.0 + 1.0 / 1620.0);
    EXPECT_NEAR(run.u(9).y(), -settlement, 1e-9);
  }
}

std::string tresca(const std::string& name, double c) {
  return fmt::format(
      "[[material]]\nname = \"{}\"\nlaw = \"mohr_coulomb\"\nyoungs_modulus = 10000.0\npoissons_ratio = 0.3\n"
      "cohesion = {}\nfriction_angle = 0.0\n",
      name, c);
}

// Free to move to the right on a smooth base; c = 10 + 3 (-z).
std::string pressed_column(const std::string& stages) {
  std::string text = column(false, tresca("first", 10.0),
                            "[[initial]]\ngroup = \"soil\"\nkind = \"parameter\"\nparameter = "
                            "\"cohesion\"\nvalues = [0, 0.0, 3.0]\n" +
                                stages);
  const std::string held =
      "{first = 1, last = 2, x = \"fixed\", y = \"fixed\"}, {first = 1, last = 10, x = \"fixed\"}";
  text.replace(text.find(held), held.size(),
               "{first = 1, last = 2, y = \"fixed\"}, {first = 1, last = 9, step = 2, x = \"fixed\"}");
  return text;
}

// A wall pushes the column from its right side until all points have yielded, with nothing on its top.  Virtual work of a
// uniform flow (across 1, upright -1) gives the wall's force, 2 times the integral of c = 10 + 3 (-z): 2 (80 + 96) = 352.
TEST(StageLaws, AStrengthGrowsWithDepth) {
  const std::string text = pressed_column(
      "[[stage]]\nincrements = 4\nfixity = [{first = 2, last = 10, step = 2, x = \"fixed\", x_value = "
      "-0.02}]\n");
  const WholeRun run = run_model(text);
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.reaction(run.last(), {2, 4, 6, 8, 10}, 0), -352.0, 1e-4);
  EXPECT_NEAR(run.reaction(run.last(), {1, 3, 5, 7, 9}, 0), 352.0, 1e-4);
}

// Stress 50 of the first stage stays, and a stage without load moves nothing; the 20 of the third act on the other modulus.
TEST(StageLaws, AMaterialChangesWithItsStressKept) {
  for (const bool ring : {false, true}) {
    const std::string text = column(ring, elastic("first", 1000.0) + elastic("other", 4000.0),
                                    press("", 50.0) +
                                        "[[stage]]\ntitle = \"grout\"\ninitial = [{group = \"soil\", kind = "
                                        "\"material\", material = \"other\"}]\n" +
                                        press("increments = 2", 20.0));
    const WholeRun run = run_model(text);
    ASSERT_TRUE(run.completed()) << run.failure;
    const double first = -50.0 * 8.0 / 1000.0;
    EXPECT_NEAR(run.increments[1].u[DofMap::displacement(run.index(9), 1)], first, 1e-12);
    EXPECT_NEAR(run.u(9).y(), first - 20.0 * 8.0 / 4000.0, 1e-11);
    for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) EXPECT_NEAR(run.stress[0](1, p), -70.0, 1e-9);
    expect_restarts(text);
  }
}

// Held at its sides (K0 = nu / (1 - nu) = 3/7) the elastic column has 70 upright and 30 across: a difference of 40.  With
// c = 12 the law returns the stress to a difference of 24 at constant mean stress (Tresca, no dilation), and the stage lets
// go the upright stress that this leaves unbalanced until the load of 70 stands again: 70 and 46.  The mean stress grows
// from 130 / 3 to 162 / 3, and the volume by that over the bulk modulus.
TEST(StageLaws, StressOutsideTheNewYieldSurfaceReturnsToIt) {
  const std::string text =
      column(false, elastic("first", 10000.0, 0.3) + tresca("weak", 12.0),
             press("", 70.0) +
                 "[[stage]]\nincrements = 4\ninitial = [{group = \"soil\", kind = \"material\", material = "
                 "\"weak\"}]\n");
  const WholeRun run = run_model(text);
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_TRUE(run.warns("lies outside the yield surface of the law that comes into force"));
  for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p) {
    EXPECT_NEAR(run.stress[0](1, p), -70.0, 1e-5);
    EXPECT_NEAR(run.stress[0](0, p), -46.0, 1e-5);
  }
  const double bulk = 10000.0 / (3.0 * (1.0 - 2.0 * 0.3));
  const double settlement = 8.0 * ((70.0 + 2.0 * 46.0) - (70.0 + 2.0 * 30.0)) / 3.0 / bulk;
  EXPECT_NEAR(run.u(9).y() - run.increments[0].u[DofMap::displacement(run.index(9), 1)], -settlement, 1e-7);
  expect_restarts(text);
}

// A cantilever of 2 m in two elements, whose EI is four times as large from the second stage on: tip P L^3 / (3 EI) of each
// load on the EI of its stage, and P L / GA with GA = 5/12 EA where the material leaves it out.
TEST(StageLaws, ABeamGetsStiffer) {
  const auto section = [](const char* name, double EI) {
    return fmt::format(
        "[[material]]\nname = \"{}\"\nlaw = \"section_elastic\"\naxial_stiffness = 1e5\n"
        "bending_stiffness = {:.1f}\n",
        name, EI);
  };
  const std::string text =
      head(false) +
      "node = [{x = 0.0, y = 0.0}, {x = 1.0, y = 0.0}, {x = 2.0, y = 0.0}]\n"
      "element = [{group = \"lining\", nodes = [1, 2]}, {group = \"lining\", nodes = [2, 3]}]\n"
      "fixity = [{first = 1, x = \"fixed\", y = \"fixed\"}, {first = 1, x = \"fixed\", unknown = "
      "\"rotation\"}]\n" +
      kUnits + section("young", 100.0) + section("old", 400.0) +
      "[[group]]\nname = \"lining\"\nelement = \"beam2\"\nmaterial = \"young\"\n"
      "[[stage]]\nload = [{first = 3, y_force = -3.0}]\n"
      "[[stage]]\nload = [{first = 3, y_force = -6.0}]\ninitial = [{group = \"lining\", kind = \"material\", "
      "material = \"old\"}]\n";
  const WholeRun run = run_model(text);
  ASSERT_TRUE(run.completed()) << run.failure;
  const double GA = 5.0 / 12.0 * 1e5;
  EXPECT_NEAR(run.increments[0].u[DofMap::displacement(run.index(3), 1)], -3.0 * (8.0 / 300.0 + 2.0 / GA),
              1e-10);
  EXPECT_NEAR(run.u(3).y(), -3.0 * 8.0 / 300.0 - 6.0 * 8.0 / 1200.0 - 9.0 * 2.0 / GA, 1e-10);
  expect_restarts(text);
}

// Pressed from its right side by c = 10 + 3 (-z), with nothing on its top, the column needs c / F = c / 2 everywhere.
TEST(StageLaws, ASafetyFactorDividesStrengthsPointByPoint) {
  const std::string text = pressed_column(
      "[[stage]]\npressure = [{element = 1, edge = 2, normal1 = 34.0, normal2 = 28.0},\n"
      "  {element = 2, edge = 2, normal1 = 28.0, normal2 = 22.0},\n"
      "  {element = 3, edge = 2, normal1 = 22.0, normal2 = 16.0},\n"
      "  {element = 4, edge = 2, normal1 = 16.0, normal2 = 10.0}]\n");
  Model model = model_of(text);
  safety::Options options;
  options.limits.tolerance = 0.02;
  const safety::Safety found =
      safety::find_safety(model, workbench().catalogue(), workbench().settings(), options);
  ASSERT_TRUE(found.lower && found.upper);
  EXPECT_LE(*found.lower, 2.0);
  EXPECT_GE(*found.upper, 2.0);
  EXPECT_LE(*found.upper - *found.lower, 0.0201);
}

// A block of 1 m x .5 m on a joint of 30 degrees.  Gravity 1 - k_v down and k_h across: it slides where k_h / (1 - k_v) is
// above tan 30, and its factor of safety is tan 30 (1 - k_v) / k_h.
TEST(StageLaws, ABlockSlidesUnderAPseudoStaticLoad) {
  const auto block = [](double k_h, double k_v) {
    return head(false) +
           "node = [{x = 0.0, y = 0.0}, {x = 1.0, y = 0.0}, {x = 1.0, y = 0.0}, {x = 0.0, y = 0.0}, {x = 1.0, "
           "y = "
           "0.5}, {x = 0.0, y = 0.5}]\n"
           "element = [{group = \"block\", nodes = [4, 3, 5, 6]}, {group = \"joint\", nodes = [1, 2, 3, 4]}]\n"
           "fixity = [{first = 1, last = 2, x = \"fixed\", y = \"fixed\"}]\n" +
           kUnits +
           "[[material]]\nname = \"rock\"\nlaw = \"linear_elastic\"\nunit_weight = 20.0\nyoungs_modulus = 1e5\n"
           "poissons_ratio = 0.2\n"
           "[[material]]\nname = \"base\"\nlaw = \"dilating_joint\"\nnormal_stiffness = 1e5\nshear_stiffness = "
           "1e5\n"
           "cohesion = 0.0\nfriction_angle = 30\n"
           "[[group]]\nname = \"block\"\nelement = \"quad4\"\nmaterial = \"rock\"\n"
           "[[group]]\nname = \"joint\"\nelement = \"interface4\"\nmaterial = \"base\"\n"
           "[[stage]]\ngravity_y = -1.0\n" +
           fmt::format("[[stage]]\nincrements = 4\ngravity_x = {:.6f}\ngravity_y = {:.6f}\n", k_h, k_v);
  };
  const double tangent = std::tan(std::numbers::pi / 6.0), k_v = 0.1;
  EXPECT_TRUE(run_model(block(0.99 * tangent * (1.0 - k_v), k_v)).completed());
  EXPECT_FALSE(run_model(block(1.01 * tangent * (1.0 - k_v), k_v)).completed());
  Model model = model_of(block(0.3, k_v));
  safety::Options options;
  options.reduce = {ModelPart::soil, ModelPart::joints};
  options.limits.tolerance = 0.02;
  const safety::Safety found =
      safety::find_safety(model, workbench().catalogue(), workbench().settings(), options);
  const double factor = tangent * (1.0 - k_v) / 0.3;
  ASSERT_TRUE(found.lower && found.upper);
  EXPECT_LE(*found.lower, factor);
  EXPECT_GE(*found.upper, factor);
  EXPECT_LE(*found.upper - *found.lower, 0.0201);
}

TEST(StageLaws, CardsThatDoNotFitAreRejected) {
  const auto with = [](const std::string& cards) {
    return column(false, elastic("first", 1000.0) + elastic("other", 4000.0), cards);
  };
  const std::string stage = "[[stage]]\ninitial = [{group = \"soil\", ";
  EXPECT_EQ(first_error(with(stage + "kind = \"lock off\", values = [1.0]}]\n")), "S614");
  EXPECT_EQ(first_error(with(stage + "kind = \"material\", values = [9]}]\n")), "S204");
  EXPECT_EQ(first_error(with(stage + "kind = \"parameter\", parameter = \"cohesion\", values = [0, 0, 1]}]\n")),
            "S614");
  EXPECT_EQ(first_error(with(stage + "kind = \"parameter\", values = [1, 0, -500]}]\n")), "S611");
  EXPECT_EQ(
      first_error(with("[[initial]]\ngroup = \"soil\"\nkind = \"material\"\nvalues = [2]\n" + press("", 1.0))),
      "S614");
  EXPECT_EQ(first_error(with(stage + "kind = \"parameter\", values = [1, 0, 0]}]\n")), "S614");
  std::string blank = prop_and_anchor(false, -10.0, -9.0, -40.0);
  blank.replace(blank.find(", values = [-40]"), 16, "");
  EXPECT_EQ(first_error(blank), "S614");
  std::string loose = prop_and_anchor(false, -10.0, -9.0, -40.0);
  loose.replace(loose.find("{first = 1, last = 3, step = 2,"), 31, "{first = 1, ");
  EXPECT_EQ(first_error(loose), "S613");
}

}  // namespace
}  // namespace sage::test
