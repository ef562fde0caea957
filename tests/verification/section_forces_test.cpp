// Section forces along cuts through solids, against statics and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sage/app/commands.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/record/report.hpp"
#include "sage/record/report_components.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

const Workbench& bench() {
  static const Workbench all = app::make_workbench();
  return all;
}

// Before a text; plane strain without it.
const std::string kRing = "geometry = \"axisymmetric\"\n";

Model model_of(const std::string& text, int refine = 0) {
  BuildOptions options;
  options.refine = refine;
  const std::string whole = text.starts_with("geometry") ? text : "geometry = \"plane strain\"\n" + text;
  return build_model(read_model_file_text(whole, "cut.sage.toml"), bench().catalogue(), options);
}

// What the first report of the model has, by rows.
std::vector<SectionRow> rows_of(const Model& model) {
  Reports reports;
  Observer* const observers[] = {&reports};
  const RunResult result = bench().run(model, observers);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  return reports.count() > 0 ? reports.sections(0) : std::vector<SectionRow>{};
}

SectionForces last_of(const std::string& text, int refine = 0) {
  const std::vector<SectionRow> rows = rows_of(model_of(text, refine));
  EXPECT_FALSE(rows.empty());
  return rows.empty() ? SectionForces{} : rows.back().value;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string cut(const std::string& from, const std::string& to, const std::string& more = "") {
  return "[[report]]\nkind = \"section\"\nfrom = " + from + "\nto = " + to + "\n" + more;
}

const std::string kHead = R"(
[units]
length = "m"
force = "kN"
stress = "kPa"
water_unit_weight = 9.81
[[material]]
name = "concrete"
law = "linear_elastic"
unit_weight = 25
youngs_modulus = 3e7
poissons_ratio = 0.2
)";

// A beam of 4 m x 0.5 m with its left end on `left` (held along x, one corner along y too).
const std::string kBeam = kHead + R"(
[mesh]
element = "quad8"
size = 0.5
[[area]]
name = "beam"
outline = [[0, 0], [4, 0], [4, 0.5], [0, 0.5]]
material = "concrete"
[points]
foot = [0, 0]
[[line]]
name = "left"
points = ["foot", [0, 0.5]]
[[line]]
name = "right"
points = [[4, 0], [4, 0.5]]
[[line]]
name = "top"
points = [[0, 0.5], [4, 0.5]]
[[fixity]]
line = "left"
x = "fixed"
[[fixity]]
point = "foot"
y = "fixed"
)";

std::string beam(const std::string& element, const std::string& stage) {
  return with(kBeam, "\"quad8\"", "\"" + element + "\"") + "[[stage]]\n" + stage;
}

std::string clamped(const std::string& element, const std::string& stage) {
  return with(beam(element, stage), "line = \"left\"\nx = \"fixed\"",
              "line = \"left\"\nx = \"fixed\"\ny = \"fixed\"");
}

// Pressure that changes along the end: 30 on the mean and 60 at the lower edge less 60 at the upper one.  Axial force and
// pure bending: stresses that quadratic elements hold, along any cut.  The tension of bending is at the top.
TEST(SectionForces, AxialForceAndBendingAreExact) {
  const double h = 0.5, N = 30.0 * h, M = -60.0 * h * h / 6.0;
  const std::string load = "pressure = [{line = \"right\", normal1 = 90, normal2 = -30}]\n";
  for (const std::string element : {"quad8", "quad9", "quad25"})
    for (const int refine : {0, 1}) {
      const std::string text = beam(element, load);
      const SectionForces up = last_of(text + cut("[1.3, 0]", "[1.3, 0.5]", "name = \"mid\"\n"), refine);
      EXPECT_NEAR(up.axial, N, 1e-9) << element;
      EXPECT_NEAR(up.shear, 0.0, 1e-9) << element;
      EXPECT_NEAR(up.moment, M, 1e-9) << element;
      EXPECT_NEAR(up.length, h, 1e-12);
      // The other way round only the moment changes its sign; so it is on a line of the mesh.
      for (const char* const x : {"1.3", "2"}) {
        const std::string at(x);
        const SectionForces down = last_of(text + cut("[" + at + ", 0.5]", "[" + at + ", 0]"), refine);
        EXPECT_NEAR(down.axial, N, 1e-9);
        EXPECT_NEAR(down.shear, 0.0, 1e-9);
        EXPECT_NEAR(down.moment, -M, 1e-9);
      }
      // A sloping cut, 0.3 along x over the height, beyond the beam at both ends: the same forces and moment on its middle,
      // turned.  The axis is 3/5 m downwards over 1 m: (0.5, -0.3) / 0.583.
      const double length = std::hypot(0.3, h), c = h / length, s = 0.3 / length;
      const SectionForces sloping = last_of(text + cut("[1.0, -0.5]", "[1.9, 1.0]"), refine);
      EXPECT_NEAR(sloping.axial, N * c, 1e-9) << element;
      EXPECT_NEAR(sloping.shear, -N * s, 1e-9) << element;
      EXPECT_NEAR(sloping.moment, M, 1e-9) << element;
      EXPECT_NEAR(sloping.length, length, 1e-9);
      if (element != "quad25") {
        EXPECT_NEAR(up.error[2], 0.0, 1e-9);
      } else {
        EXPECT_TRUE(std::isnan(up.error[2]));
      }
    }
}

// 20 kPa of shear down the end and the weight of 25 kN/m3: Q and M by statics.  The clamped corners disturb the stress; at
// half of the length, four heights away, that has decayed.  Elements of degree 8 leave 1e-9 of Q and M.  M of quadratic ones is
// linear along each element, and q (size)^2 / 24 too large in its middle: 0.36 % here.
TEST(SectionForces, CantileverUnderEndLoadAndWeight) {
  const double h = 0.5, x = 2.25, arm = 4.0 - x, q = 25.0 * h, P = 20.0 * h;
  const double Q = -(P + q * arm), M = -(P * arm + q * arm * arm / 2.0);
  const std::string load = "gravity_y = -1\npressure = [{line = \"right\", shear1 = -20, shear2 = -20}]\n";
  const struct {
    const char* element;
    double tolerance;
  } rows[] = {{"quad81", 1e-8}, {"quad25", 1e-6}, {"quad8", 5e-3}, {"quad9", 5e-3}};
  for (const auto& [element, tolerance] : rows) {
    const SectionForces found = last_of(clamped(element, load) + cut("[2.25, 0]", "[2.25, 0.5]"));
    std::printf("    %-7s Q %.3e M %.3e N %.3e, estimates %.1e %.1e\n", element, found.shear / Q - 1.0,
                found.moment / M - 1.0, found.axial / Q, found.error[1] / Q, found.error[2] / M);
    EXPECT_NEAR(found.shear / Q, 1.0, tolerance) << element;
    EXPECT_NEAR(found.moment / M, 1.0, tolerance) << element;
    EXPECT_NEAR(found.axial, 0.0, tolerance * std::abs(Q)) << element;
  }
}

// A pressure on the top of the same cantilever acts on nodes of elements that the cut crosses.
TEST(SectionForces, PressureOnOneFace) {
  const double x = 2.25, arm = 4.0 - x, Q = -40.0 * arm, M = -40.0 * arm * arm / 2.0;
  const std::string load = "pressure = [{line = \"top\", normal1 = 40, normal2 = 40}]\n";
  const SectionForces fine = last_of(clamped("quad81", load) + cut("[2.25, 0]", "[2.25, 0.5]"));
  EXPECT_NEAR(fine.shear / Q, 1.0, 1e-8);
  EXPECT_NEAR(fine.moment / M, 1.0, 1e-8);
  double error[2] = {};
  for (const int refine : {0, 1})
    error[refine] =
        std::abs(last_of(clamped("quad8", load) + cut("[2.25, 0]", "[2.25, 0.5]"), refine).moment / M - 1.0);
  std::printf("    quad8 error of M %.2e, refined %.2e\n", error[0], error[1]);
  EXPECT_LT(error[1], 1e-3);
}

const std::string kCylinder = kHead + R"(
[mesh]
element = "quad8"
size = 0.25
[[area]]
name = "wall"
outline = [[1, 0], [2, 0], [2, 1], [1, 1]]
material = "concrete"
[[line]]
name = "inside"
points = [[1, 0], [1, 1]]
[[line]]
name = "base"
points = [[1, 0], [2, 0]]
[[fixity]]
line = "base"
y = "fixed"
[[stage]]
pressure = [{line = "inside", normal1 = 100, normal2 = 100}]
)";

// Lame: the hoop stress A + B/r^2, A = p ri^2/(re^2 - ri^2), B = A re^2, has the resultant p ri (tension) and a moment with
// tension inside, where the cut starts.  No force acts on the cut itself.
TEST(SectionForces, ThickCylinder) {
  const double p = 100.0, ri = 1.0, re = 2.0, middle = 1.5;
  const double B = p * ri * ri / (re * re - ri * ri) * re * re;
  const double moment = B * (middle * (1.0 / ri - 1.0 / re) - std::log(re / ri));
  const std::string text = kCylinder + cut("[1, 0.45]", "[2, 0.45]");
  double error[2] = {};
  for (const int refine : {0, 1}) {
    const SectionForces found = last_of(kRing + text, refine);
    std::printf("    hoop force %.3e, moment %.3e of the closed form apart\n", found.hoop / (-p * ri) - 1.0,
                found.hoop_moment / moment - 1.0);
    EXPECT_NEAR(found.axial, 0.0, 1e-2);
    EXPECT_NEAR(found.shear, 0.0, 1e-2);
    error[refine] = std::abs(found.hoop / (-p * ri) - 1.0);
    EXPECT_NEAR(found.hoop_moment / moment, 1.0, refine == 0 ? 1e-3 : 1e-4);
  }
  EXPECT_LT(error[0], 2e-4);
  EXPECT_LT(error[1], 0.5 * error[0]);
}

// The weight of a ring of concrete, on its base: N is the weight above over the circumference at the middle of the cut.
// The base holds the ring flat, so that there is stress around the axis, which has no part in N.
TEST(SectionForces, WeightOfARing) {
  const std::string text =
      with(kCylinder, "pressure = [{line = \"inside\", normal1 = 100, normal2 = 100}]", "gravity_y = -1");
  // N(z) 2 pi 1.5 = 25 (1 - z) pi (4 - 1)
  for (const auto& [element, tolerance] : {std::pair{"quad8", 5e-3}, {"quad81", 1e-7}}) {
    const SectionForces found = last_of(kRing + with(text, "quad8", element) + cut("[2, 0.4]", "[1, 0.4]"));
    std::printf("    %-7s N %.2e of the weight apart, Q %.2e of it\n", element, found.axial / 15.0 - 1.0,
                found.shear / 15.0);
    EXPECT_NEAR(found.axial / 15.0, 1.0, tolerance);
  }
}

// A simply supported round plate of radius 10 m and 0.5 m under 20 kPa: M_r = q/16 (3 + nu)(R^2 - r^2), the moment around
// the axis q/16 ((3 + nu) R^2 - (1 + 3 nu) r^2), and Q = q r/2.  The theory of thin plates neglects parts of (h/R)^2.
TEST(SectionForces, RoundPlate) {
  const double q = 20.0, R = 10.0, r = 4.0, nu = 0.2;
  const std::string text = kRing + kHead + R"(
[mesh]
element = "quad8"
size = 0.25
[points]
edge = [10, 0]
[[area]]
name = "plate"
outline = [[0, 0], "edge", [10, 0.5], [0, 0.5]]
material = "concrete"
[[line]]
name = "axis"
points = [[0, 0], [0, 0.5]]
[[line]]
name = "top"
points = [[0, 0.5], [10, 0.5]]
[[line]]
name = "rim"
points = ["edge", [10, 0.5]]
[[fixity]]
line = "axis"
x = "fixed"
[[fixity]]
point = "edge"
y = "fixed"
[[stage]]
pressure = [{line = "top", normal1 = 20, normal2 = 20}, {line = "rim", shear1 = 200, shear2 = 200}]
)" + cut("[4, 0]", "[4, 0.5]");
  const double M = q / 16.0 * (3.0 + nu) * (R * R - r * r),
               hoop = q / 16.0 * ((3.0 + nu) * R * R - (1.0 + 3.0 * nu) * r * r);
  const SectionForces finest = last_of(with(text, "quad8", "quad81"));
  std::printf("    quad81: M %.2e, hoop moment %.2e, Q %.2e\n", finest.moment / M - 1.0,
              finest.hoop_moment / hoop - 1.0, finest.shear / (q * r / 2.0) - 1.0);
  const SectionForces found = last_of(text);
  std::printf("    M %.2e, hoop moment %.2e, Q %.2e of plate theory apart\n", found.moment / M - 1.0,
              found.hoop_moment / hoop - 1.0, found.shear / (q * r / 2.0) - 1.0);
  EXPECT_NEAR(found.moment / M, 1.0, 2e-4);
  EXPECT_NEAR(found.hoop_moment / hoop, 1.0, 2e-4);
  EXPECT_NEAR(found.shear / (q * r / 2.0), 1.0, 1e-8);
  EXPECT_NEAR(found.axial, 0.0, 1e-6 * q * R);
}

// Two layers of ground, 2 m wide and each 2 m high, below a water level at y = 3; the upper layer is removed in stage 2, when
// the level falls to its base.
std::string ground(const std::string& more) {
  return with(kHead, "unit_weight = 25", "unit_weight = 20") + R"(
[mesh]
element = "quad8"
size = 0.5
[points]
low = [0, 1.1]
high = [2, 1.1]
[[area]]
name = "lower"
outline = [[0, 0], [2, 0], [2, 2], [0, 2]]
material = "concrete"
[[area]]
name = "upper"
outline = [[0, 2], [2, 2], [2, 4], [0, 4]]
material = "concrete"
[[line]]
name = "base"
points = [[0, 0], [2, 0]]
[[line]]
name = "left"
points = [[0, 0], [0, 4]]
[[line]]
name = "right"
points = [[2, 0], [2, 4]]
[[fixity]]
line = "base"
y = "fixed"
[[fixity]]
line = "left"
x = "fixed"
[[fixity]]
line = "right"
x = "fixed"
[[water]]
kind = "line"
stage = 1
values = [[-1, 3], [4, 3]]
[[stage]]
gravity_y = -1
increments = 2
[[stage]]
death = ["upper"]
[[stage]]
[[report]]
kind = "section"
)" + more;
}

// The total stress carries the weight: with and without water in the pores N is the weight above, in both geometries.
TEST(SectionForces, TotalStressHasTheWeightAbove) {
  const Model model = model_of(with(ground("from = \"high\"\nto = \"low\"\n"), "death = [\"upper\"]", ""));
  const std::vector<SectionRow> rows = rows_of(model);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_NEAR(rows[1].value.axial, 20.0 * 2.9 * 2.0, 1e-9);
  EXPECT_NEAR(rows[1].value.moment, 0.0, 1e-9);
  EXPECT_NEAR(rows[1].value.length, 2.0, 1e-12);
}

// An upright cut through both layers and the air above, then through what is left; of one group alone; through a layer that
// is no longer there.
TEST(SectionForces, RemovedSolidsCarryNothing) {
  const std::vector<SectionRow> both = rows_of(model_of(ground("from = [1.1, 0]\nto = [1.1, 5]\n")));
  const std::vector<SectionRow> lower =
      rows_of(model_of(ground("from = [1.1, 0]\nto = [1.1, 5]\ngroup = \"lower\"\n")));
  const std::vector<SectionRow> upper =
      rows_of(model_of(ground("from = [1.1, 2]\nto = [1.1, 4]\ngroup = \"upper\"\n")));
  ASSERT_EQ(both.size(), 4U);
  EXPECT_NEAR(both[1].value.length, 4.0, 1e-12);
  EXPECT_NEAR(both[3].value.length, 2.0, 1e-12);
  EXPECT_NEAR(lower[1].value.length, 2.0, 1e-12);
  EXPECT_NEAR(upper[1].value.length, 2.0, 1e-12);
  // Both layers together, as forces go.
  EXPECT_NEAR(both[1].value.axial, lower[1].value.axial + upper[1].value.axial, 1e-6 * both[1].value.axial);
  EXPECT_NEAR(both[3].value.axial, lower[3].value.axial, 1e-9 * std::abs(lower[3].value.axial));
  EXPECT_EQ(upper[3].value.length, 0.0);
  EXPECT_TRUE(std::isnan(upper[3].value.axial));
}

TEST(SectionForces, RestartsToTheBit) {
  const std::string text = ground("from = \"low\"\nto = \"high\"\n");
  std::vector<std::string> saved;
  RunSettings settings = bench().settings();
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& bytes) { saved.push_back(bytes); };
  Reports whole;
  Observer* const observers[] = {&whole};
  ASSERT_TRUE(bench().run(model_of(text), settings, observers).completed());
  ASSERT_FALSE(saved.empty());
  for (const std::string& bytes : saved) {
    RunSettings again = bench().settings();
    again.resume_from = bytes;
    Reports rest;
    Observer* const others[] = {&rest};
    ASSERT_TRUE(bench().run(model_of(text), again, others).completed());
    ASSERT_EQ(rest.rows(0), whole.rows(0));
    for (std::size_t row = 0; row < rest.rows(0); ++row)
      EXPECT_EQ(rest.values(0, row), whole.values(0, row)) << row;
  }
}

// Cards and back, and what --converge follows.
TEST(SectionForces, CardsHaveTheSameCut) {
  const Model model = model_of(ground("from = \"high\"\nto = \"low\"\nname = \"level\"\n"));
  Diagnostics words;
  const Model again = bench().build(sage1_text(model, words, FieldWidth::narrow));
  ASSERT_EQ(again.reports.size(), 1U);
  EXPECT_EQ(again.reports[0].kind, ReportKind::section);
  EXPECT_EQ(again.reports[0].place, Vector2(2.0, 1.1));
  EXPECT_EQ(again.reports[0].end, Vector2(0.0, 1.1));
  EXPECT_EQ(again.reports[0].name, "level");
  Reports reports;
  Observer* const observers[] = {&reports};
  ASSERT_EQ(bench().run(again, observers).status, RunStatus::completed);
  std::string followed;
  for (const ReportComponent& one : last_components(again, reports))
    if (one.main) followed += one.name + " ";
  EXPECT_EQ(followed, "report1.axial_force report1.shear_force report1.bending_moment ");
}

std::string complaint(const std::string& text) {
  std::string all;
  const auto add = [&](const Diagnostics& found) {
    for (const Diagnostic& one : found.list()) all += with_code(one.message, one.code) + "\n";
  };
  try {
    add(model_of(text).diagnostics);
  } catch (const InputError& error) {
    add(error.diagnostics());
  }
  return all;
}

TEST(SectionForces, BadCutsAreNamed) {
  const struct {
    std::string keys, code, words;
  } rows[] = {
      {"from = [5, 0]\nto = [5, 4]\n", "S635", "meets no solid element of the mesh"},
      {"from = [1, 2.5]\nto = [1, 4]\ngroup = \"lower\"\n", "S635", "meets no solid element of group 1"},
      {"from = [1, 2]\nto = [1, 2]\n", "S636", "are one place"},
      {"from = [1, 2]\n", "S242", "both ends of its cut"},
      {"from = \"hgh\"\nto = \"low\"\n", "S153", "[points] has no \"hgh\""},
      {"from = [1, 2, 3]\nto = \"high\"\n", "S152", "from is [x, y]"},
      {"from = [1, 2]\nx = 1\nto = \"high\"\n", "S152", "not both"},
      {"from = [1, 2.5]\nto = [1, 4]\nstage = 2\n", "S638", "it shows no forces"},
  };
  for (const auto& [keys, code, words] : rows) {
    const std::string found = complaint(ground(keys));
    EXPECT_NE(found.find(code), std::string::npos) << keys << found;
    EXPECT_NE(found.find(words), std::string::npos) << keys << found;
  }
  const std::string ring = kRing + ground("from = [0, 1]\nto = [0, 3]\n");
  EXPECT_NE(complaint(ring).find("lies on the axis"), std::string::npos) << complaint(ring);
}

}  // namespace
}  // namespace sage::test
