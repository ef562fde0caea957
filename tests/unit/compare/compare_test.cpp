// Two runs side by side: what theory gives in closed form must come out of the comparison.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/compare/comparison.hpp"
#include "sage/compare/pair_picture.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::compare {
namespace {

namespace fs = std::filesystem;
using scenes::Block;
using scenes::Cell;
using scenes::DeckWriter;

constexpr double kE = 3000.0, kNu = 0.3, kCell = 50.0;

// A block 1 x 2 between smooth plates, compressed by `strain` under a cell pressure; with a triaxial report.
struct Specimen {
  int law = 1;
  std::vector<double> parameters{kE, kNu};
  bool confined = false, report = true;
  double strain = 0.01, stage_load = 0.0, top_load = 0.0;  // top_load: on each node, instead of the plate
  int increments = 2, columns = 2, rows = 3;
  Cell cell = Cell::quad4;
  double cell_pressure = kCell;

  std::string text() const {
    Block block;
    block.cell = cell;
    block.columns = columns;
    block.rows = rows;
    block.place = scenes::rectangle(0.0, 1.0, 0.0, 2.0);
    DeckWriter deck(2);
    block.write_nodes(deck);
    deck.material(1, law, parameters);
    deck.group(1, static_cast<int>(cell), 0, 1);
    block.write_elements(deck, 1);
    for (int n : block.bottom()) deck.fix(n, 0, 1);
    for (int n : block.left()) deck.fix(n, 1, 0);
    if (confined)
      for (int n : block.right()) deck.fix(n, 1, 0);
    if (cell_pressure != 0.0) deck.initial(1, 0, cell_pressure, cell_pressure, cell_pressure);
    scenes::StageCards& stage = deck.stage(increments);
    for (int n : block.top()) {
      if (top_load != 0.0)
        stage.load(n, 0.0, -top_load);
      else
        stage.fix(n, 0, 1, 0.0, -2.0 * strain);
    }
    const bool triangles = cell == Cell::tri3 || cell == Cell::tri6;  // the second of a cell has its right side
    if (!confined && cell_pressure != 0.0)
      for (int j = 0; j < block.rows; ++j)
        stage.pressure(block.element(columns - 1, j) + (triangles ? 1 : 0), triangles ? 3 : 2, cell_pressure,
                       cell_pressure);
    for (int n : block.right())
      if (stage_load != 0.0) stage.load(n, stage_load, 0.0);
    if (report) deck.triaxial_report(1, block.top().front(), block.top().back(), 1, 2.0, kCell);
    return deck.text();
  }
};

fs::path folder() {
  return test::scratch_folder("compare");
}

Side run(const char* label, const std::string& deck, int geometry, const BuildOptions& build = {},
         int solver = -1) {
  static const Catalogue catalogue = app::full_catalogue();
  static const Layout layout = load_layout("sage1");
  BuildOptions options = build;
  options.geometry = geometry;
  RunSettings settings;
  settings.solver = solver;
  settings.choose_solver = choose_solver;
  Side side(label, build_model(read_deck_text(deck, "deck", layout), catalogue, options), folder(), label);
  side.run(catalogue, settings);
  return side;
}

const Expectation* find(const std::vector<Expectation>& list, const std::string& start) {
  for (const Expectation& e : list)
    if (e.what.rfind(start, 0) == 0) return &e;
  return nullptr;
}

const Row* find(const std::vector<Row>& rows, const std::string& section, const std::string& name) {
  for (const Row& row : rows)
    if (row.section.rfind(section, 0) == 0 && row.name == name) return &row;
  return nullptr;
}

// Smooth plates: E/(1-nu^2) in plane strain, E in axisymmetry; sigma_zz = nu (sigma_xx + sigma_yy).
TEST(Compare, FreeLateralStrainGivesBothModuli) {
  const std::string deck = Specimen{}.text();
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  ASSERT_EQ(a.error() + b.error(), "");
  const Comparison c = compare(a, b, {});
  const double plane = kE / (1 - kNu * kNu);
  for (const auto& [what, expected] :
       {std::pair{"apparent modulus, A", plane}, std::pair{"apparent modulus, B /", kE / plane},
        std::pair{"apparent modulus, B (", kE}}) {
    const Expectation* e = find(c.theory, what);
    ASSERT_NE(e, nullptr) << what;
    EXPECT_NEAR(e->expected, expected, 1e-12 * expected);
    EXPECT_NEAR(e->found, expected, 1e-9 * expected);
    EXPECT_EQ(e->why.find("restrained"), std::string::npos) << e->why;
  }
  const Expectation* zz = find(c.theory, "sigma_zz");
  ASSERT_NE(zz, nullptr);
  EXPECT_LT(zz->found, 1e-12);
  const Expectation* report = find(c.theory, "report 1");
  ASSERT_NE(report, nullptr);
  EXPECT_NEAR(report->expected, kE / plane, 1e-9);
  EXPECT_NEAR(report->found, kE / plane, 1e-9);
  const Row* ratio = find(c.rows, "report 1, stage 1, increment 2", "measured / correct");
  ASSERT_NE(ratio, nullptr);
  EXPECT_NEAR(ratio->a, 1.0, 1e-9);
  EXPECT_NEAR(ratio->b, 1.0, 1e-9);
}

// A lift that is born with its weight strains what is below it, and the top shows a part of that weight only.
TEST(Compare, AStageThatBringsALiftIsNoTestOfTheModulus) {
  std::ifstream file(SAGE_SOURCE_DIR "/legacy_inputs/stages/fill_lifts_plane/deck.dat");
  const std::string deck{std::istreambuf_iterator<char>(file), {}};
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  ASSERT_EQ(a.error() + b.error(), "");
  EXPECT_EQ(find(compare(a, b, {}).theory, "apparent modulus"), nullptr);
}

// A pressure on the side that grows while the plate goes down, on one element whose side has no node between
// its ends, and on several where it pushes below as it pulls above: E is not what the top shows.
TEST(Compare, AGrowingLateralPressureIsNoTestOfTheModulus) {
  for (const bool cancels : {false, true}) {
    std::string texts[2];
    for (const double pressure : {0.0, 20.0}) {
      Block block{1, cancels ? 4 : 1, Cell::quad4, 1, 1, scenes::rectangle(0.0, 1.0, 0.0, 2.0)};
      DeckWriter deck(2);
      block.write_nodes(deck);
      deck.material(1, 1, {kE, kNu});
      deck.group(1, 1, 0, 1);
      block.write_elements(deck, 1);
      for (int n : block.bottom()) deck.fix(n, 0, 1);
      for (int n : block.left()) deck.fix(n, 1, 0);
      scenes::StageCards& stage = deck.stage();
      for (int n : block.top()) stage.fix(n, 0, 1, 0.0, -0.02);
      for (int j = 0; pressure != 0.0 && j < block.rows; ++j) {
        const double sign = cancels && 2 * j >= block.rows ? -1.0 : 1.0;
        stage.pressure(block.element(0, j), 2, sign * pressure, sign * pressure);
      }
      texts[pressure == 0.0 ? 0 : 1] = deck.text();
    }
    for (const int k : {0, 1}) {
      const Side a = run("a", texts[k], 1), b = run("b", texts[k], 2);
      ASSERT_EQ(a.error() + b.error(), "");
      const Comparison c = compare(a, b, {});
      EXPECT_EQ(find(c.theory, "apparent modulus, A") == nullptr, k == 1) << cancels;
      EXPECT_EQ(find(c.theory, "apparent modulus, B (") == nullptr, k == 1) << cancels;
    }
  }
}

// Rough platens: the plane of symmetry carries what they hold back, and no pressure acts on the free side.
TEST(Compare, RoughPlatensRaiseTheModulusInBothGeometries) {
  const scenes::RestrainedCylinder scene{1.0, kNu, Cell::quad4, 1, 4, 4, 1.0};
  const std::string deck = scene.between_rough_platens(0.01).text();
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  ASSERT_EQ(a.error() + b.error(), "");
  const Comparison c = compare(a, b, {});
  for (const char* what : {"apparent modulus, A", "apparent modulus, B ("}) {
    const Expectation* e = find(c.theory, what);
    ASSERT_NE(e, nullptr) << what;
    EXPECT_GT(e->found, 1.01 * e->expected) << what;
    EXPECT_LT(e->found, 1.5 * e->expected) << what;
    EXPECT_NE(e->why.find("restrained"), std::string::npos) << e->why;
  }
}

// The same forces on all nodes of the top are no even pressure, on rings even less: no closed form holds.
TEST(Compare, ForcesOnNodesAreNoTestOfTheModulus) {
  Specimen specimen;
  specimen.top_load = 10.0;
  const Side a = run("a", specimen.text(), 1), b = run("b", specimen.text(), 2);
  ASSERT_EQ(a.error() + b.error(), "");
  EXPECT_EQ(find(compare(a, b, {}).theory, "apparent modulus"), nullptr);
}

// No lateral strain: one modulus in both geometries.
TEST(Compare, ConfinedCompressionIsTheSameInBoth) {
  Specimen specimen;
  specimen.confined = true;
  specimen.report = false;
  const Side a = run("a", specimen.text(), 1), b = run("b", specimen.text(), 2);
  const Comparison c = compare(a, b, {});
  const Expectation* e = find(c.theory, "apparent modulus, B /");
  ASSERT_NE(e, nullptr);
  EXPECT_EQ(e->expected, 1.0);
  EXPECT_NEAR(e->found, 1.0, 1e-10);
  EXPECT_NEAR(find(c.theory, "apparent modulus, A")->found, kE * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu)), 1e-6);
}

// Full circle against unit thickness: the forces differ by pi, the mean stress of the sides does not.
TEST(Compare, SidesNormaliseForces) {
  Specimen specimen;
  specimen.strain = 0.0;
  const Side a = run("a", specimen.text(), 1), b = run("b", specimen.text(), 2);
  const Comparison c = compare(a, b, {});
  const Row* force = find(c.rows, "forces", "reactions along y (z)");
  ASSERT_NE(force, nullptr);
  for (const char* side : {"bottom", "top", "right"}) {
    const Row* stress = find(c.rows, "sides", std::string(side) + ": mean normal stress");
    ASSERT_NE(stress, nullptr);
    EXPECT_NEAR(stress->a, kCell, 1e-9) << side;
    EXPECT_NEAR(stress->b, kCell, 1e-9) << side;
  }
  EXPECT_NEAR(find(c.rows, "sides", "left: mean normal stress")->a, kCell, 1e-9);
  EXPECT_TRUE(std::isnan(find(c.rows, "sides", "left: mean normal stress")->b));  // no area on the axis
  ASSERT_FALSE(c.notes.empty());
  EXPECT_NE(c.notes[0].find("full circle"), std::string::npos);
}

// Drucker-Prager matched in triaxial compression, no volume change: phi = 20 is phi* = 26.47 in plane strain,
// 30 is 43.85 (associated 27.47, 49.11); 36.87 has 60, and no limit when associated.
TEST(Theory, PlaneStrainStrengthOfTheTriaxialCone) {
  const auto degrees = [](double phi, bool associated) {
    const double s = std::sin(phi * kRadiansPerDegree), alpha = 2 * s / (std::sqrt(3.0) * (3 - s));
    return plane_strain_strength(alpha, 0.0, associated ? alpha : 0.0).phi / kRadiansPerDegree;
  };
  EXPECT_NEAR(degrees(20, false), 26.47, 0.005);
  EXPECT_NEAR(degrees(20, true), 27.47, 0.005);
  EXPECT_NEAR(degrees(30, false), 43.85, 0.005);
  EXPECT_NEAR(degrees(30, true), 49.11, 0.005);
  EXPECT_NEAR(degrees(std::asin(0.6) / kRadiansPerDegree, false), 60.0, 1e-6);
  EXPECT_TRUE(std::isnan(degrees(std::asin(0.6) / kRadiansPerDegree, true)));
}

// Both laws far beyond yield: Mohr-Coulomb has one strength in both geometries, the cone does not.
TEST(Compare, StrengthOfBothGeometries) {
  for (int law : {3, 4}) {
    Specimen specimen;
    specimen.law = law;
    specimen.parameters = {kE, kNu, 5.0, 30.0, 0.0};
    specimen.strain = 3.0;  // sigma_zz gets to its value at collapse slowly
    specimen.increments = 60;
    const Side a = run("a", specimen.text(), 1), b = run("b", specimen.text(), 2);
    ASSERT_EQ(a.error() + b.error(), "");
    const Comparison c = compare(a, b, {});
    const Expectation* ratio = find(c.theory, "strength, B / A");
    ASSERT_NE(ratio, nullptr);
    if (law == 4) {
      EXPECT_NEAR(ratio->expected, 1.0, 1e-12);
    } else {
      EXPECT_LT(ratio->expected, 0.6);
    }
    EXPECT_NEAR(ratio->found, ratio->expected, 2e-3 * ratio->expected) << law;
    EXPECT_EQ(find(c.rows, "points", "solids: yielded")->b, 1.0);
  }
}

// sigma and u of a uniform state anywhere in the mesh, in every kind of cell; nothing outside.
TEST(Sampler, UniformStateOnALine) {
  for (Cell cell : {Cell::quad4, Cell::quad8, Cell::quad9, Cell::tri3, Cell::tri6}) {
    Specimen specimen;
    specimen.cell = cell;
    specimen.rows = 4;  // quarters: mid-side nodes of a card's ten columns are in the middle
    specimen.report = false;
    const Side side = run("a", specimen.text(), 2);
    ASSERT_EQ(side.error(), "");
    const Solution now = side.last();
    const FieldTable table;
    const Sampler sampler(side.model(), now, fields_named(table, {"displacement", "stress", "deviator"}));
    for (const Vector2& x : {Vector2(0.0, 0.0), Vector2(0.31, 1.1), Vector2(1.0, 2.0), Vector2(0.5, 0.7)}) {
      const Sample s = sampler.at(x);
      EXPECT_GT(s.element, 0);
      EXPECT_NEAR(s.values[1], -0.01 * x.y(), 1e-12);
      EXPECT_NEAR(s.values[0], 0.003 * x.x(), 1e-12);
      EXPECT_NEAR(s.values[3], kCell + 0.01 * kE, 1e-8);
      EXPECT_NEAR(s.values[6], 0.01 * kE, 1e-8);
    }
    for (const Vector2& x : {Vector2(-0.1, 0.5), Vector2(0.5, 2.01)}) {
      EXPECT_EQ(sampler.at(x).element, 0);
      EXPECT_TRUE(std::isnan(sampler.at(x).values[2]));
    }
  }
}

// A sector's curved 8-node elements: the quadratic geometry is inverted, and a place in the void is outside.
TEST(Sampler, CurvedElements) {
  for (Cell cell : {Cell::quad8, Cell::tri6}) {
    Block block;
    block.cell = cell;
    block.columns = block.rows = 2;
    block.polar = true;
    block.place = scenes::rectangle(1.0, 2.0, 0.0, 90.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 1, {1.0, kNu});
    deck.group(1, static_cast<int>(cell), 0, 1);
    block.write_elements(deck, 1);
    // u = (x, y)/100: uniform strain
    scenes::StageCards& stage = deck.stage();
    for (int j = 0; j < block.up(); ++j)
      for (int i = 0; i < block.across(); ++i) {
        if (!block.exists(i, j)) continue;
        const Vector2 polar = block.at(i, j);
        const double angle = polar.y() * kRadiansPerDegree;
        stage.fix(block.node(i, j), 1, 1, 0.01 * polar.x() * std::cos(angle),
                  0.01 * polar.x() * std::sin(angle));
      }
    const Side side = run("a", deck.text(), 1);
    ASSERT_EQ(side.error(), "");
    const Solution now = side.last();
    const FieldTable table;
    const Sampler sampler(side.model(), now, fields_named(table, {"displacement", "stress"}));
    for (double angle : {0.1, 0.5, 1.2})
      for (double r : {1.1, 1.5, 1.9}) {
        const Vector2 x(r * std::cos(angle), r * std::sin(angle));
        const Sample s = sampler.at(x);
        EXPECT_NEAR((Vector2(s.values[0], s.values[1]) - 0.01 * x).norm(), 0.0, 1e-8)
            << r << " " << angle;  // ten columns of a card
        EXPECT_NEAR(s.values[2], -0.01 / ((1 + kNu) * (1 - 2 * kNu)), 1e-6);
      }
    EXPECT_EQ(sampler.at({0.5, 0.5}).element, 0);
  }
}

// Solvers and formulations differ by rounding and by the mesh: the note says which.
TEST(Compare, OneGeometryTwoWays) {
  const std::string deck = Specimen{}.text();
  BuildOptions middle;
  middle.points.push_back({{0.5, 0.5}, "middle", 0});
  const Side a = run("a", deck, 2, middle), b = run("b", deck, 2, middle, 2);
  const Comparison c = compare(a, b, {line_from_text("0,1,1,1:cut:5")});
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_NE(c.notes[0].find("equations are the same"), std::string::npos);
  for (const Row& row : c.rows)
    if (row.section != "course" && !std::isnan(row.relative())) {
      EXPECT_NEAR(row.relative(), 0.0, 1e-9) << row.section << " " << row.name;
    }
  const Row* stress = find(c.rows, "report 2, middle at (0.5; 0.5), stage 1, increment 2", "stress_yy");
  ASSERT_NE(stress, nullptr);
  EXPECT_NEAR(stress->a, kCell + 0.01 * kE, 1e-8);
  EXPECT_NE(find(c.rows, "line cut: mean of 5 places", "sigma_yy"), nullptr);
  EXPECT_NE(find(c.details, "line cut at (0.25; 1)", "u_x"), nullptr);

  BuildOptions full, b_bar;
  full.formulation = 1;
  b_bar.formulation = 2;
  const Comparison e = compare(run("c", deck, 2, full), run("d", deck, 2, b_bar), {});
  ASSERT_EQ(e.notes.size(), 1u);
  EXPECT_NE(e.notes[0].find("mesh's error"), std::string::npos);
}

TEST(Compare, OtherMeshesMeetOnLinesOnly) {
  Specimen fine;
  fine.columns = 4;
  const Side a = run("a", Specimen{}.text(), 2), b = run("b", fine.text(), 2);
  const Comparison c = compare(a, b, {line_from_text("0,0.5,1,0.5")});
  EXPECT_EQ(find(c.rows, "nodes", "largest |u| along r"), nullptr);
  const Row* row = find(c.rows, "line", "sigma_yy");
  ASSERT_NE(row, nullptr);
  EXPECT_NEAR(row->difference(), 0.0, 1e-8);
}

// The line is twice as long as the specimen is wide: the means are those of the places
// that both meshes have, with their number; one place outside used to make them blank.
TEST(Compare, LinesCountThePlacesThatBothMeshesHave) {
  const Side a = run("a", Specimen{}.text(), 2), b = run("b", Specimen{}.text(), 2);
  const Comparison c =
      compare(a, b, {line_from_text("0,0.5,2,0.5:long:11"), line_from_text("3,0,3,1:beside:5")});
  const Row* row = find(c.rows, "line long: mean of 6 of 11 places", "sigma_yy");
  ASSERT_NE(row, nullptr);
  EXPECT_NEAR(row->a, kCell + 0.01 * kE, 1e-8);
  EXPECT_NEAR(row->difference(), 0.0, 1e-8);
  const Row* none = find(c.rows, "line beside: mean of 0 of 5 places", "sigma_yy");
  ASSERT_NE(none, nullptr);
  EXPECT_TRUE(std::isnan(none->a));
  const auto noted = [&](const std::string& words) {
    return std::ranges::any_of(c.notes,
                               [&](const std::string& n) { return n.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(
      noted("line long: 5 of 11 places lie outside of one mesh or both; the means are over the other 6"));
  EXPECT_TRUE(noted("line beside: 5 of 5 places lie outside of one mesh or both; the means are not known"));
}

// The first lines are the answer: what the reports end with, the ratio, and what theory expects of it; the rows
// come behind.
TEST(Compare, TheAnswerComesFirst) {
  Specimen specimen;
  BuildOptions point;
  point.points.push_back({{0.5, 0.5}, "middle", 0});
  const Side a = run("a", specimen.text(), 1, point), b = run("b", specimen.text(), 2, point);
  const Comparison c =
      compare(a, b, {}, {{"report2.stress_yy", 83.0, 0.25}}, {{"report2.stress_yy", 80.0, 0.5}});
  ASSERT_GE(c.answers.size(), 3u);
  const auto answer = [&](const std::string& name) {
    for (const Answer& one : c.answers)
      if (one.name == name) return one;
    ADD_FAILURE() << name;
    return Answer{};
  };
  const double plane = kE / (1 - kNu * kNu);
  const Answer deviator = answer("report1.measured_deviator");
  EXPECT_NEAR(deviator.a, 0.01 * plane, 1e-8);
  EXPECT_NEAR(deviator.ratio(), kE / plane, 1e-9);
  EXPECT_NEAR(deviator.expected, kE / plane, 1e-9);
  EXPECT_TRUE(std::isnan(deviator.error_a) && std::isnan(deviator.ratio_error()));
  // What finer meshes found takes the place of the run's, with its error: of the ratio the sum of both.
  const Answer stress = answer("report2.stress_yy");
  EXPECT_EQ(stress.a, 83.0);
  EXPECT_EQ(stress.error_b, 0.5);
  EXPECT_NEAR(stress.ratio_error(), 80.0 / 83.0 * (0.25 / 83.0 + 0.5 / 80.0), 1e-12);
  EXPECT_EQ(stress.why, "nothing is known");
  const std::string text = to_text(c, a, b);
  const std::size_t first = text.find("reported at the end");
  ASSERT_NE(first, std::string::npos);
  EXPECT_LT(first, text.find("theory  "));
  EXPECT_LT(text.find("theory  "), text.find("course"));
  EXPECT_NE(text.find("80.0 +- 0.5"), std::string::npos) << text;
  // One deck in two ways: theory expects the same.
  const Comparison same = compare(a, run("c", specimen.text(), 1, point, 2), {});
  EXPECT_EQ(same.answers.front().expected, 1.0);
}

// Decks that end at different steps meet at the last common one: a value of the end has no place there.
TEST(Compare, ValuesOfTheEndAreNotThoseOfAnEarlierStep) {
  Specimen shorter, longer;
  longer.increments = 3;
  const Side a = run("a", shorter.text(), 1), b = run("b", longer.text(), 1);
  ASSERT_EQ(a.error() + b.error(), "");
  const Comparison c = compare(a, b, {}, {{"report1.measured_deviator", 30.0, 0.1}},
                               {{"report1.measured_deviator", 31.0, 0.1, false}});
  ASSERT_FALSE(c.answers.empty());
  EXPECT_EQ(c.answers[0].name, "report1.measured_deviator");
  EXPECT_NEAR(c.answers[0].b, 2.0 / 3.0 * 0.01 * kE / (1 - kNu * kNu), 1e-8);
  EXPECT_TRUE(std::isnan(c.answers[0].error_a) && c.answers[0].reached_b);
}

// What is no larger than its error gives no ratio; a side that is less certain than wanted is named.
TEST(Compare, AnswersSayWhatIsNotCertain) {
  const std::string deck = Specimen{}.text();
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  const double infinite = std::numeric_limits<double>::infinity();
  const Comparison c =
      compare(a, b, {}, {{"report1.ratio", 0.001, 0.002}},
              {{"report1.measured_deviator", 30.0, 0.1, false}, {"report1.ratio", 1.0, infinite, false}});
  const std::string text = to_text(c, a, b);
  EXPECT_EQ(c.answers[1].name, "report1.ratio");
  EXPECT_FALSE(c.answers[1].ratio_known());
  EXPECT_TRUE(c.answers[0].ratio_known());
  EXPECT_NE(text.find(" certainty          NOT REACHED in B\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" NOT REACHED in B; error unknown in B\n"), std::string::npos) << text;
}

// The chapter's own deck, whose strains differ by rounding between the runs: E against E / (1 - nu^2),
// nu = 1/3.
TEST(Compare, TheoryKnowsTheChaptersSpecimen) {
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/chapter7/pinned_ld2_nu0333/deck.dat");
  const std::string deck{std::istreambuf_iterator<char>(in), {}};
  const Comparison c = compare(run("a", deck, 1), run("b", deck, 2), {});
  ASSERT_FALSE(c.answers.empty());
  EXPECT_EQ(c.answers[0].name, "report1.measured_deviator");
  EXPECT_NEAR(c.answers[0].expected, 1.0 - 1.0 / 9.0, 1e-6);
  EXPECT_NE(c.answers[0].why.find("these are restrained"), std::string::npos) << c.answers[0].why;
}

// A uniform elastic body: the force on its end, over the area of a unit of thickness and of the full circle, by the
// moduli.
TEST(Compare, TheoryKnowsTheEndsOfUniformBodies) {
  Specimen specimen;
  specimen.report = false;
  specimen.cell_pressure = 0.0;
  std::string deck = specimen.text();
  // Nodes 10 to 12 are the top.
  const std::size_t end = deck.rfind("END");
  deck.insert(end, "    2    0   10   12    1    1\n");
  std::size_t line = deck.find('\n', deck.find('\n') + 1) + 1;
  deck.replace(line + 50, 5, "    1");
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  ASSERT_EQ(a.error() + b.error(), "");
  const Comparison c = compare(a, b, {});
  const auto fy = std::find_if(c.answers.begin(), c.answers.end(),
                               [](const Answer& answer) { return answer.name == "report1.fy / area"; });
  ASSERT_NE(fy, c.answers.end());
  EXPECT_NEAR(fy->a, -0.01 * kE / (1 - kNu * kNu), 1e-8);
  EXPECT_NEAR(fy->b, -0.01 * kE, 1e-8);
  EXPECT_NEAR(fy->expected, 1 - kNu * kNu, 1e-9);
  EXPECT_NEAR(fy->ratio(), fy->expected, 1e-8);
  EXPECT_NE(fy->why.find("ratio of moduli"), std::string::npos);
}

// What the tolerance of equilibrium leaves open is zero, however large it is beside nothing.
TEST(Compare, DifferencesBelowTheToleranceAreZero) {
  Row row{"forces", "reactions along x", "kN", 4e-5, -2494.0};
  row.scale = 2494.0;
  EXPECT_GT(std::abs(row.relative()), 1e7);  // what was shown
  row.floor_a = row.floor_b = 1e-4;
  EXPECT_TRUE(std::isnan(row.relative()));
  EXPECT_TRUE(row.zero_a() && !row.zero_b());
  row.b = -4e-5;
  EXPECT_EQ(row.difference(), 0.0);
  EXPECT_EQ(row.relative(), 0.0);

  // The floors are those of the runs: tolerance x forces x sqrt(dofs), far above rounding
  // and far below the forces.
  const Side a = run("a", Specimen{}.text(), 2);
  EXPECT_GT(a.floors().force, 1e-8 * 100.0);
  EXPECT_LT(a.floors().force, 1e-6 * 1000.0);
  EXPECT_NEAR(a.floors().stress, 1e-8 * (kCell + 0.01 * kE), 1e-12);
  EXPECT_NEAR(a.floors().displacement, 1e-8 * 0.02, 1e-12);
}

// A step has no top that stays plane, nor one as wide as its box.
TEST(Compare, NoModulusWithoutAUniformSide) {
  DeckWriter deck(1);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < (j < 2 ? 3 : 2); ++i) deck.node(1 + i + 3 * j, i, j);
  deck.material(1, 1, {kE, kNu});
  deck.group(1, 1, 0, 1);
  deck.element(1, 1, {1, 2, 5, 4});
  deck.element(2, 1, {2, 3, 6, 5});
  deck.element(3, 1, {4, 5, 8, 7});
  for (int n : {1, 2, 3}) deck.fix(n, 1, 1);
  scenes::StageCards& stage = deck.stage();
  for (int n : {7, 8}) stage.fix(n, 0, 1, 0.0, -0.01);
  const Side a = run("a", deck.text(), 1), b = run("b", deck.text(), 1, {}, 2);
  ASSERT_EQ(a.error() + b.error(), "");
  EXPECT_FALSE(uniform_ends(a, 0));
  const Comparison c = compare(a, b, {});
  EXPECT_EQ(find(c.rows, "sides", "stress of the top / strain of the height"), nullptr);
  // The top's stress is that of the part which is there: 1 of 2 wide.
  double top = 0.0;
  for (const Face& face : a.faces())
    if (face.name == "top") top = face.area;
  EXPECT_EQ(top, 1.0);
  const Side uniform = run("u", Specimen{}.text(), 1);
  EXPECT_TRUE(uniform_ends(uniform, 0));
}

// A side that fails keeps the other's numbers, and both texts say so.
TEST(Compare, OneSideFails) {
  Specimen failing;
  failing.law = 4;
  failing.parameters = {kE, kNu, 5.0, 30.0, 0.0};
  failing.strain = 0.0;
  failing.stage_load = 1e5;  // pulls the side away: beyond any strength
  const Side a = run("a", Specimen{}.text(), 2), b = run("b", failing.text(), 2);
  EXPECT_EQ(a.error(), "");
  EXPECT_NE(b.error(), "");
  const Comparison c = compare(a, b, {});
  EXPECT_NE(to_text(c, a, b).find("NOT COMPLETE"), std::string::npos);
  EXPECT_NE(to_text(c, a, b).find("The runs end at different loads"), std::string::npos);
  EXPECT_NEAR(find(c.rows, "sides", "top: mean normal stress")->a, kCell + 0.01 * kE, 1e-8);
  EXPECT_NE(pair_svg(a, b, "stress_yy").find("NOT COMPLETE"), std::string::npos);

  const Side none("B: nothing", "the deck can't be read");
  const Comparison half = compare(a, none, {line_from_text("0,0.5,1,0.5:cut")});
  EXPECT_NE(to_text(half, a, none).find("NO RESULTS: the deck can't be read"), std::string::npos);
  EXPECT_NE(to_csv(half, a, none).find("line cut"), std::string::npos);
  EXPECT_NE(pair_svg(a, none, "stress_yy").find("B has no results"), std::string::npos);
}

// Both pictures use the range of both fields: sigma_zz is 50 in the one and 50 + nu sigma in the other.
TEST(PairPicture, OneScaleOfColours) {
  const std::string deck = Specimen{}.text();
  const Side a = run("a", deck, 1), b = run("b", deck, 2);
  const std::string svg = pair_svg(a, b, "stress_zz");
  const auto count = [&](const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = svg.find(word); at != std::string::npos; at = svg.find(word, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<svg"), 2u);
  EXPECT_EQ(count("</svg>"), 2u);
  EXPECT_EQ(count(">50<"), 2u);  // the lowest label stands in both legends
  EXPECT_EQ(count("from 50 to 50"), 1u);
}

TEST(LineText, ReadsAndRefuses) {
  const Line line = line_from_text("0,1,2,3.5:a cut:21");
  EXPECT_EQ(line.to, Vector2(2.0, 3.5));
  EXPECT_EQ(line.name, "a cut");
  EXPECT_EQ(line.n, 21);
  EXPECT_EQ(line_from_text("0,1,2,3").n, 11);
  for (const char* bad : {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,3,4:n:1", "1,2,3,4:n:2.5", "1,2,3,nan"})
    EXPECT_THROW(line_from_text(bad), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace sage::compare
