// Decks whose layouts make the cards that the program asks for: PLAST (Owen and Hinton) and STAP (Bathe).
// Expected values are closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/deck/layout_names.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage {
namespace {

const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const scenes::Workbench& bench() {
  static const scenes::Workbench one(app::full_catalogue(), choose_solver);
  return one;
}

Model model_of(const std::string& text, const std::string& layout) {
  return build_model(read_deck_text(text, "deck.dat", load_layout(layout)), bench().catalogue());
}

scenes::WholeRun run_of(const std::string& path, const std::string& layout) {
  scenes::WholeRun run = bench().run(model_of(text_of(kInputs + path), layout));
  EXPECT_TRUE(run.completed()) << run.failure;
  return run;
}

std::string errors_of(const std::string& text, const std::string& layout) {
  std::string all;
  try {
    model_of(text, layout);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics().list())
      if (d.severity == Severity::error)
        all +=
            std::to_string(d.where.line) + ":" + std::to_string(d.where.first_column) + " " + d.message + "\n";
  }
  return all;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Radius of the elastic-plastic boundary where f grows with it: f(c) = p.
template <class F>
double boundary(const F& f, double low, double high, double p) {
  for (int i = 0; i < 200; ++i) (f(0.5 * (low + high)) < p ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

// A thick cylinder in plane strain, Tresca, pressure p inside (Hill, The Mathematical Theory of Plasticity, V.2:
// exact while the axial stress stays between the others): p = k [2 ln(c/a) + 1 - c^2/b^2], k = yield / 2, and the
// outer radius grows by 2 (1 - nu^2) k c^2 / (E b).  Four elements
// along the radius: .26 %, since the boundary goes through elements; four times as many leave .02 %.
TEST(Plast, ThickCylinderOfTresca) {
  const double a = 100.0, b = 200.0, k = 12.0;
  const scenes::WholeRun run = run_of("plast/cylinder_tresca.dat", "plast");
  ASSERT_EQ(run.increments.size(), 3u);
  const double pressures[] = {8.0, 11.0, 13.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto p = [&](double c) { return k * (2.0 * std::log(c / a) + 1.0 - c * c / (b * b)); };
    const double c = boundary(p, a, b, pressures[i]);
    double u = 2.0 * (1.0 - 0.09) * k * c * c / (21000.0 * b);
    if (pressures[i] < p(a)) u *= pressures[i] / p(a);  // elastic: in proportion
    double mean = 0.0;
    int count = 0;
    for (int n = 0; n < run.model->mesh.nodes(); ++n) {
      const Vector2 x = run.model->mesh.x.col(n);
      if (std::abs(x.norm() - b) > 1e-3) continue;
      mean += run.increments[i].u.segment<2>(DofMap::displacement(n)).dot(x) / x.norm();
      ++count;
    }
    ASSERT_EQ(count, 7);
    EXPECT_NEAR(mean / count, u, 4e-3 * u) << "pressure " << pressures[i];
  }
}

// A hollow sphere: p = 2 Y ln(c/a) + 2/3 Y (1 - c^3/b^3), and the outer radius grows by (1 - nu) Y c^3 / (E b^2) (Hill,
// V.1; Tresca and von Mises are one in it).  Four elements along
// the radius: .54 %; four times as many leave .04 %.
TEST(Plast, HollowSphereOfVonMises) {
  const double a = 100.0, b = 200.0, y = 24.0;
  const scenes::WholeRun run = run_of("plast/sphere_von_mises.dat", "plast");
  ASSERT_EQ(run.increments.size(), 3u);
  const double pressures[] = {10.0, 20.0, 25.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto p = [&](double c) {
      return 2.0 * y * std::log(c / a) + 2.0 / 3.0 * y * (1.0 - std::pow(c / b, 3));
    };
    double c = a;
    if (pressures[i] > p(a)) c = boundary(p, a, b, pressures[i]);
    double u = 0.7 * y * c * c * c / (21000.0 * b * b);
    if (pressures[i] < p(a)) u *= pressures[i] / p(a);
    double mean = 0.0;
    int count = 0;
    for (int n = 0; n < run.model->mesh.nodes(); ++n) {
      const Vector2 x = run.model->mesh.x.col(n);
      if (std::abs(x.norm() - b) > 1e-3) continue;
      mean += run.increments[i].u.segment<2>(DofMap::displacement(n)).dot(x) / x.norm();
      ++count;
    }
    ASSERT_EQ(count, 9);
    EXPECT_NEAR(mean / count, u, 8e-3 * u) << "pressure " << pressures[i];
  }
}

// A cylinder crushed without side pressure: 2 c cos(phi) / (1 - sin(phi)) = 2 * 2 * tan(60 deg), by both cones (that of
// Drucker-Prager goes through the corners of compression).  First step elastic: E * strain.
TEST(Plast, CrushedCylinderHasItsStrength) {
  for (const char* deck : {"plast/cylinder_mohr_coulomb.dat", "plast/cylinder_drucker_prager.dat"}) {
    const scenes::WholeRun run = run_of(deck, "plast");
    ASSERT_EQ(run.increments.size(), 2u) << deck;
    const double area = std::acos(-1.0);
    EXPECT_NEAR(run.reaction(run.increments[0], {3, 4}, 1) / area, -1000.0 * 0.001, 1e-9) << deck;
    EXPECT_NEAR(run.reaction(run.increments[1], {3, 4}, 1) / area, -4.0 * std::sqrt(3.0), 1e-6) << deck;
  }
}

TEST(Plast, MidSideNodesThatAreLeftOutStandHalfway) {
  const Model model = model_of(text_of(kInputs + "plast/cylinder_tresca.dat"), "plast");
  EXPECT_EQ(model.mesh.nodes(), 51);
  EXPECT_EQ(model.mesh.deck_nodes, 51);
  // Node 8 is the middle of the first radial side.
  const auto at = std::find(model.mesh.number.begin(), model.mesh.number.end(), 8) - model.mesh.number.begin();
  EXPECT_DOUBLE_EQ(model.mesh.x(0, at), 110.0);
  EXPECT_DOUBLE_EQ(model.mesh.x(1, at), 0.0);
  // A corner that is left out is a mistake.
  const std::string text =
      changed(text_of(kInputs + "plast/cylinder_tresca.dat"), "\n    7   0.00000 100.00000", "");
  EXPECT_NE(errors_of(text, "plast").find("node 7 is not defined"), std::string::npos)
      << errors_of(text, "plast");
}

TEST(Plast, WhatIsNotComputedIsNamed) {
  const std::string deck = text_of(kInputs + "plast/cylinder_tresca.dat");
  EXPECT_EQ(errors_of(changed(deck, "   18    2    8", "   18    1    8"), "plast"),
            "2:16 the deck asks for plane stress (NTYPE 1), which this program does not compute\n");
  EXPECT_NE(errors_of(changed(deck, "   24.0000    0.0000", "   24.0000   10.0000"), "plast")
                .find("the deck asks for hardening, which this program does not compute"),
            std::string::npos);
  EXPECT_NE(errors_of(changed(deck, "   18    2    8", "   18    2    9"), "plast").find("9-node elements"),
            std::string::npos);
}

// Nodes of an edge that run the wrong way around, that are no edge, or that belong to another element.
TEST(Plast, EdgesAreCheckedByTheirNodes) {
  const std::string deck = text_of(kInputs + "plast/cylinder_tresca.dat");
  const std::string edge = "    1    3    2    1\n";
  EXPECT_NE(errors_of(changed(deck, edge, "    1    1    2    3\n"), "plast")
                .find("edge 1-2-3: its nodes, listed in this order, run clockwise around element 1"),
            std::string::npos);
  EXPECT_NE(
      errors_of(changed(deck, edge, "    1    5    2    1\n"), "plast").find("no solid element has an edge"),
      std::string::npos);
  EXPECT_NE(
      errors_of(changed(deck, edge, "    2    3    2    1\n"), "plast").find("belongs to element 1, not 2"),
      std::string::npos);
  EXPECT_NE(
      errors_of(changed(deck, edge, "    1    3    4    1\n"), "plast").find("node 4 is not the middle node"),
      std::string::npos);
}

// A value at a third node that the edge has not: on its columns, and nothing is left out in silence.
TEST(Plast, AThirdPressureNeedsAThirdNode) {
  const std::string deck = text_of(kInputs + "plast/cylinder_tresca.dat");
  const std::string edge = "    1    3    2    1\n", two = "    1    3    1\n";
  const std::size_t at = deck.find(edge) + edge.size();
  const std::string pressures = deck.substr(at, deck.find('\n', at) + 1 - at);
  const auto errors = [&](const std::string& values) {
    return errors_of(changed(deck, edge + pressures, two + values), "plast");
  };
  EXPECT_EQ(errors("       1.0       0.0       1.0       0.0\n"), "");
  EXPECT_EQ(errors("       1.0       0.0       1.0       0.0       0.0       0.0\n"), "");
  EXPECT_NE(errors("       1.0       0.0       1.0       0.0       2.0       0.0\n")
                .find(":41 edge 3-1: the pressure at the third node is 2, but the card has no third node"),
            std::string::npos)
      << errors("       1.0       0.0       1.0       0.0       2.0       0.0\n");
  EXPECT_NE(
      errors("       1.0       0.0       1.0       0.0       0.0       3.0\n").find(":51 edge 3-1: the shear"),
      std::string::npos);
}

// A pressure that is parabolic along an edge: its forces, against those of the shape functions by hand.  On a straight
// edge of length 2 with 0, p, 0 at its nodes they are 2p/15, 16p/15, 2p/15 of the middle one's share.
TEST(Plast, AParabolicPressureHasItsNodalForces) {
  const std::string deck =
      "Square\n    8    1    3    2    8    1    2    2    2    1    3\n"
      "    1    1    1    2    3    4    5    6    7    8\n"
      "    1   0.00000   0.00000\n    3   2.00000   0.00000\n    5   2.00000   2.00000\n    7   0.00000   "
      "2.00000\n"
      "    8   0.00000   1.00000\n"
      "    1        11            0.0       0.0\n    2        01            0.0       0.0\n"
      "    3        01            0.0       0.0\n"
      "    1\n   1000.0       0.3       0.0       0.0    1000.0       0.0       0.0\n"
      "load\n    0    0    1\n    1\n    1    5    6    7\n"
      "       0.0       0.0      15.0       0.0       0.0       0.0\n"
      "       1.0       0.1   50    1    1\n";
  const scenes::WholeRun run = bench().run(model_of(deck, "plast"));
  ASSERT_TRUE(run.completed()) << run.failure;
  const Eigen::VectorXd& f = run.last().external;
  const double expected[] = {-2.0, -16.0, -2.0};
  for (int n : {5, 6, 7}) EXPECT_NEAR(f[DofMap::displacement(run.index(n)) + 1], expected[n - 5], 1e-12) << n;
}

// Uniform stress 100 along x in plane strain: u = (1 - nu^2) 100 x / E, v = -nu (1 + nu) 100 y / E.
TEST(Stap, PlateInPlaneStrain) {
  const scenes::WholeRun run = run_of("stap/plate.dat", "stap");
  EXPECT_EQ(run.model->mesh.nodes(), 15);
  EXPECT_EQ(run.model->materials.size(), 2u);
  for (int number = 1; number <= 15; ++number) {
    const Vector2 x = run.position(number), u = run.u(number);
    EXPECT_NEAR(u.x(), 0.91 * 100.0 / 30000.0 * x.x(), 1e-12) << number;
    EXPECT_NEAR(u.y(), -0.39 * 100.0 / 30000.0 * x.y(), 1e-12) << number;
  }
}

// A material that its group has not, where another group has one of that number in the whole deck, and where none has:
// both are shown on the element's card.
TEST(Stap, AnUnknownMaterialIsShownOnItsElement) {
  const std::string deck = text_of(kInputs + "stap/plate.dat");
  EXPECT_EQ(
      errors_of(changed(deck, "    3    3    4    9    8    1\n", "    3    3    4    9    8    2\n"), "stap"),
      "20:26 the material can't be 2: the number of one of the group's materials, 1 to NPAR(3)\n");
  EXPECT_EQ(
      errors_of(changed(deck, "    3    8    9   14   13    1\n", "    3    8    9   14   13    2\n"), "stap"),
      "26:26 the material can't be 2: the number of one of the group's materials, 1 to NPAR(3)\n");
}

// Uniform radial and hoop stress 100: u = (1 - nu) 100 r / E, w = -2 nu 100 z / E.
TEST(Stap, DiscOfTriangles) {
  const scenes::WholeRun run = run_of("stap/disc.dat", "stap");
  for (int number = 1; number <= 4; ++number) {
    const Vector2 x = run.position(number), u = run.u(number);
    EXPECT_NEAR(u.x(), 0.7 * 100.0 / 30000.0 * x.x(), 1e-8) << number;  // the deck's forces have four decimals
    EXPECT_NEAR(u.y(), -0.6 * 100.0 / 30000.0 * x.y(), 1e-8) << number;
  }
}

TEST(Stap, WhatIsNotComputedIsNamed) {
  EXPECT_EQ(errors_of(text_of(kInputs + "stap/trusses.dat"), "stap"),
            "8:1 the deck asks for truss elements (NPAR(1) = 1), which its layout does not translate: bars in "
            "the plane "
            "are element 31 (bar2) of a sage1 deck\n");
  const std::string disc = text_of(kInputs + "stap/disc.dat");
  EXPECT_NE(
      errors_of(changed(disc, "    3    2    1    0", "    3    2    1    2"), "stap").find("plane stress"),
      std::string::npos);
  EXPECT_NE(errors_of(changed(disc, "    0.5000    0.0000", "    0.5000    0.2000"), "stap")
                .find("a body in three dimensions"),
            std::string::npos);
}

// What a layout leaves out with partial = 1 can be computed without it; the title says so.
TEST(LeftOut, ThePartThatIsKnownIsComputedWhereItIsAskedFor) {
  std::string toml = text_of(kInputs + "layouts/stap.toml");
  toml = changed(toml, R"({ name = "of", value = "direction" }])",
                 R"({ name = "of", value = "direction" }, { name = "partial", value = 1 }])");
  const Layout layout = load_checked_layout(toml, "stap.toml");
  const std::string deck =
      changed(text_of(kInputs + "stap/plate.dat"), "   10    1    50.000", "   10    3    50.000");
  const Deck read = read_deck_text(deck, "deck.dat", layout);
  EXPECT_THROW(build_model(read, bench().catalogue()), InputError);
  BuildOptions options;
  options.partial = true;
  const Model model = build_model(read, bench().catalogue(), options);
  ASSERT_EQ(model.left_out.size(), 1u);
  EXPECT_EQ(model.left_out[0], "a load across the plane");
  EXPECT_EQ(model.title.substr(0, 9), "PARTIAL: ");
}

}  // namespace
}  // namespace sage
