// Whole models under large strain: Hencky bar, thick cylinder, pinned cylinders, groups that come and go in the deformed
// state, loads that follow, restart, and what large strain rejects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/builder/model_input.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/record/report.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"
#include "tests/studies/scenes/scenes.hpp"

namespace sage::test {
namespace {

using namespace scenes;

const Catalogue& everything() {
  static const Catalogue catalogue = [] {
    Catalogue all;
    register_elements(all);
    register_materials(all);
    register_solvers(all);
    return all;
  }();
  return catalogue;
}
const Workbench& bench() {
  static const Workbench workbench(everything(), choose_solver);
  return workbench;
}

WholeRun run(const ModelInput& input, const RunSettings& settings = {}) {
  return bench().run(build_model(input, everything()), settings);
}

// Elements on a grid x columns, y rows; middle nodes of quad8 halfway.
struct Grid {
  std::vector<double> x, y;
  std::string element = "quad8";
  ModelInput input{.units = {"m", "kN", "kPa", 101.325, 9.81}, .large_strain = true};

  int step() const { return element == "quad8" ? 2 : 1; }
  int columns() const { return step() * static_cast<int>(x.size() - 1); }
  int rows() const { return step() * static_cast<int>(y.size() - 1); }
  static double at(const std::vector<double>& list, int i, int step) {
    const auto lower = static_cast<std::size_t>(i / step);
    return i % step == 0 ? list[lower] : 0.5 * (list[lower] + list[lower + 1]);
  }
  std::map<std::pair<int, int>, int> numbers = {};

  void make_nodes() {
    for (int j = 0; j <= rows(); ++j)
      for (int i = 0; i <= columns(); ++i) {
        if (step() == 2 && i % 2 == 1 && j % 2 == 1) continue;
        input.nodes.emplace_back(at(x, i, step()), at(y, j, step()));
        numbers[{i, j}] = static_cast<int>(input.nodes.size());
      }
  }
  std::vector<int> nodes_of(int column, int row) const {
    const int s = step(), i = s * column, j = s * row;
    std::vector<int> nodes{numbers.at({i, j}), numbers.at({i + s, j}), numbers.at({i + s, j + s}),
                           numbers.at({i, j + s})};
    if (s == 2)
      for (const auto& [a, b] : {std::pair{i + 1, j}, {i + 2, j + 1}, {i + 1, j + 2}, {i, j + 1}})
        nodes.push_back(numbers.at({a, b}));
    return nodes;
  }
  // Rows first ... last - 1.
  void add_group(int first, int last, const std::string& formulation, int material = 1) {
    GroupInput group{.element = element, .material = material, .elements = {}, .formulation = formulation};
    for (int row = first; row < last; ++row)
      for (int column = 0; column + 1 < static_cast<int>(x.size()); ++column)
        group.elements.push_back(nodes_of(column, row));
    input.groups.push_back(group);
  }
  std::vector<int> row(int j) const {
    return line([j](int, int b) { return b == j; });
  }
  std::vector<int> column(int i) const {
    return line([i](int a, int) { return a == i; });
  }
  template <class Choose>
  std::vector<int> line(const Choose& choose) const {
    std::vector<int> list;
    for (const auto& [at, number] : numbers)
      if (choose(at.first, at.second)) list.push_back(number);
    return list;
  }
};

MaterialInput elastic(double E, double nu) {
  return {.law = "linear_elastic", .parameters = {{"youngs_modulus", E}, {"poissons_ratio", nu}}};
}

Grid cylinder(const std::string& element, const std::string& formulation, const MaterialInput& law) {
  Grid grid{.x = {0.0, 0.4, 1.0}, .y = {0.0, 0.8, 2.0}, .element = element};
  grid.input.geometry = Geometry::axisymmetric;
  grid.input.materials = {law};
  grid.make_nodes();
  grid.add_group(0, 2, formulation);
  grid.input.supports = {{.nodes = grid.row(0), .y = FixityCode::fixed},
                         {.nodes = grid.column(0), .x = FixityCode::fixed}};
  return grid;
}

SupportInput pushed(const std::vector<int>& nodes, double y) {
  return {.nodes = nodes, .y = FixityCode::fixed, .y_value = y};
}

// F/(A0 E) = -ln(l)/l of a bar of Hencky's law whose side is free.
TEST(LargeStrainModels, ABarHasHenckysForce) {
  for (const auto& [element, formulation] :
       {std::pair{"quad8", "reduced"}, {"quad8", "full"}, {"quad4", "b-bar"}}) {
    Grid grid = cylinder(element, formulation, elastic(1.0, 0.3));
    StageInput stage{.increments = 3, .tolerance = 1e-12};
    stage.supports = {pushed(grid.row(grid.rows()), -0.6)};
    grid.input.stages = {stage};
    const WholeRun whole = run(grid.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    for (std::size_t i = 0; i < 3; ++i) {
      const double l = 1.0 - 0.1 * static_cast<double>(i + 1);
      const double force = -whole.reaction(whole.increments[i], grid.row(grid.rows()), 1) / kPi;
      EXPECT_NEAR(force, -std::log(l) / l, 1e-8 * force) << element << " " << formulation << " " << l;
    }
    EXPECT_FALSE(whole.warns("small strains")) << element;
  }
}

// The force of the same sand (c = 0, phi = 30) in a cell whose pressure follows its side: three times the pressure on the
// present area, which grows with the dilation of the flow (psi = 30: as the law's plastic strain says; here psi = 0).
TEST(LargeStrainModels, SandInACellThatFollowsItsSide) {
  for (const char* law : {"mohr_coulomb", "drucker_prager"}) {
    Grid grid = cylinder("quad8", "reduced",
                         {.law = law,
                          .parameters = {{"youngs_modulus", 5000.0},
                                         {"poissons_ratio", 0.3},
                                         {"cohesion", 0.0},
                                         {"friction_angle", 30.0}}});
    grid.input.initials = {{1, InitialKind::uniform, {100.0, 100.0, 100.0, 0.0}}};
    StageInput cell{.tolerance = 1e-11}, press{.increments = 8, .tolerance = 1e-11};
    cell.pressures = {{.elements = {2, 4}, .edge = 2, .normal1 = 100.0, .normal2 = 100.0},
                      {.elements = {3, 4}, .edge = 3, .normal1 = 100.0, .normal2 = 100.0}};
    press.supports = {pushed(grid.row(grid.rows()), -0.4)};
    grid.input.stages = {cell, press};
    const WholeRun whole = run(grid.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    EXPECT_LT(whole.increments.front().u.cwiseAbs().maxCoeff(), 1e-10) << law;
    for (Eigen::Index p = 0; p < whole.stress[0].cols(); ++p) {
      EXPECT_NEAR(whole.stress[0](1, p), -300.0, 1e-6 * 300.0) << law;
      EXPECT_NEAR(whole.stress[0](0, p), -100.0, 1e-6 * 300.0) << law;
    }
    EXPECT_LT(whole.out_of_balance, 1e-9) << law;
  }
}

// A platen above the cylinder that bears what comes on top of the pressure on its end, without friction; the nodes of its line.
std::vector<int> add_line_above(Grid& grid) {
  ModelInput& input = grid.input;
  input.nodes.emplace_back(4.0, 2.0);
  input.nodes.emplace_back(0.0, 2.0);
  const int last = static_cast<int>(input.nodes.size());
  input.materials.push_back(
      {.law = "goodman", .parameters = {{"shear_stiffness", 0.0}, {"normal_stiffness", 1e8}}});
  GroupInput contact{.element = "contact5", .material = 2, .elements = {}};
  for (int i = 0; i < grid.columns(); i += 2)
    contact.elements.push_back({grid.numbers.at({i, grid.rows()}), grid.numbers.at({i + 2, grid.rows()}),
                                grid.numbers.at({i + 1, grid.rows()}), last - 1, last});
  input.groups.push_back(contact);
  input.supports.push_back({.nodes = {last - 1, last}, .x = FixityCode::fixed, .y = FixityCode::fixed});
  return {last - 1, last};
}

// Sand without friction at its ends in a cell: a report on nodes that widen with the specimen, which bear the cell pressure,
// and on a platen that bears only what comes on top of it, while that pressure acts on the end too.
TEST(LargeStrainModels, ReportsOfSpecimensHaveNominalAndCorrectedStresses) {
  for (const bool on_platen : {false, true}) {
    Grid grid = cylinder("quad8", "full",
                         {.law = "mohr_coulomb",
                          .parameters = {{"youngs_modulus", 5000.0},
                                         {"poissons_ratio", 0.3},
                                         {"cohesion", 0.0},
                                         {"friction_angle", 30.0}}});
    grid.input.initials = {{1, InitialKind::uniform, {100.0, 100.0, 100.0, 0.0}}};
    StageInput cell{.tolerance = 1e-11}, press{.increments = 8, .tolerance = 1e-11};
    cell.pressures = {{.elements = {2, 4}, .edge = 2, .normal1 = 100.0, .normal2 = 100.0}};
    std::vector<int> moved = grid.row(grid.rows());
    if (on_platen) {
      cell.pressures.push_back({.elements = {3, 4}, .edge = 3, .normal1 = 100.0, .normal2 = 100.0});
      moved = add_line_above(grid);
    } else {
      grid.input.supports.push_back({.nodes = moved, .y = FixityCode::fixed});
    }
    press.supports = {pushed(moved, -0.4)};
    grid.input.stages = {cell, press};
    grid.input.reports = {{.kind = ReportKind::triaxial,
                           .nodes = moved,
                           .group = 1,
                           .stage = 2,
                           .height = 2.0,
                           .area = kPi,
                           .cell_pressure = 100.0}};
    Reports reports;
    Observer* observers[] = {&reports};
    const Model model = build_model(grid.input, everything());
    ASSERT_EQ(bench().run(model, observers).status, RunStatus::completed);
    ASSERT_EQ(reports.triaxial(0).size(), 8u);
    const TriaxialRow& last = reports.triaxial(0).back();
    EXPECT_NEAR(last.axial_strain, 0.2, 1e-12);
    EXPECT_NEAR(last.measured_corrected, 200.0, 1e-4 * 200.0)
        << on_platen;  // q of phi = 30; the platen's penalty
    EXPECT_NEAR(last.correct_corrected, 200.0, 1e-6 * 200.0) << on_platen;
    EXPECT_NEAR(last.ratio, 1.0, 1e-4) << on_platen;
    // Nominal: on an area that has grown, at nearly constant volume, by 1 / (1 - .2).
    EXPECT_NEAR(last.measured_deviator, 250.0, 0.02 * 250.0) << on_platen;
    // A card without area and pressure, or with another pressure, has the same deviators: those of the specimen.
    for (const double pressure : {0.0, 150.0}) {
      ModelInput other = grid.input;
      other.reports[0].area = 0.0;
      other.reports[0].cell_pressure = pressure;
      Reports others;
      Observer* watching[] = {&others};
      ASSERT_EQ(bench().run(build_model(other, everything()), watching).status, RunStatus::completed);
      const TriaxialRow& row = others.triaxial(0).back();
      EXPECT_NEAR(row.ratio, last.ratio, 1e-12) << on_platen << " " << pressure;
      EXPECT_NEAR(row.measured_deviator, last.measured_deviator, 1e-9) << on_platen << " " << pressure;
      EXPECT_EQ(others.messages(0).size(), 1u) << on_platen << " " << pressure;  // S531
    }
  }
}

// Forces of an initial stress don't follow the edges: while they are let go, pressures that grow can't stand in for them.
TEST(LargeStrainModels, PressuresOfAnInitialStressInAStageThatMovesAreWarnedOf) {
  for (const bool apart : {false, true}) {
    Grid grid = cylinder("quad8", "reduced", elastic(1000.0, 0.3));
    grid.input.initials = {{1, InitialKind::uniform, {100.0, 100.0, 100.0, 0.0}}};
    StageInput cell, press;
    cell.pressures = {{.elements = {2, 4}, .edge = 2, .normal1 = 100.0, .normal2 = 100.0}};
    press.supports = {pushed(grid.row(grid.rows()), -0.4)};
    if (!apart) press.pressures = cell.pressures;
    grid.input.stages = apart ? std::vector{cell, press} : std::vector{press};
    const Model model = build_model(grid.input, everything());
    const auto& list = model.diagnostics.list();
    EXPECT_EQ(std::ranges::count(list, Code("S558"), &Diagnostic::code), apart ? 0 : 1);
  }
}

// A pressure on all sides of a ball-like body, in two stages: p = -3 K ln(l) / l^3.
TEST(LargeStrainModels, AFollowingPressureHasTheClosedFormOfEvenCompression) {
  const double K = 1000.0 / (3.0 * (1.0 - 0.6)), l = 0.8, p = -3.0 * K * std::log(l) / (l * l * l);
  for (const auto& [element, formulation] : {std::pair{"quad8", "full"}, {"quad4", "b-bar"}}) {
    Grid grid = cylinder(element, formulation, elastic(1000.0, 0.3));
    for (int s = 0; s < 2; ++s) {
      StageInput stage{.increments = 4, .tolerance = 1e-12};
      stage.pressures = {{.elements = {2, 4}, .edge = 2, .normal1 = 0.5 * p, .normal2 = 0.5 * p},
                         {.elements = {3, 4}, .edge = 3, .normal1 = 0.5 * p, .normal2 = 0.5 * p}};
      grid.input.stages.push_back(stage);
    }
    const WholeRun whole = run(grid.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    EXPECT_NEAR(whole.u(static_cast<int>(grid.input.nodes.size())).y(), 2.0 * (l - 1.0), 1e-9) << element;
    EXPECT_NEAR(whole.u(static_cast<int>(grid.input.nodes.size())).x(), l - 1.0, 1e-9) << element;
    EXPECT_LT(whole.out_of_balance, 1e-9) << element;
    // What the supports at the bottom bear is the pressure on the present area.
    EXPECT_NEAR(whole.reaction(whole.last(), grid.row(0), 1), p * kPi * l * l, 1e-8 * p) << element;
  }
}

// A thick cylinder b/a = 2, incompressible in plane strain, held at the inner wall at r = lambda a.  Values of p/G by
// quadrature of the closed form for Hencky's law: p = int (sigma_t - sigma_r)/r dr.
double wall_pressure(double lambda, int elements) {
  Grid grid{.x = {}, .y = {0.0, 0.1}};
  for (int i = 0; i <= elements; ++i) grid.x.push_back(1.0 + static_cast<double>(i) / elements);
  grid.input.geometry = Geometry::axisymmetric;
  grid.input.materials = {
      {.law = "linear_elastic_kg", .parameters = {{"bulk_modulus", 2e7}, {"shear_modulus", 1.0}}}};
  grid.make_nodes();
  grid.add_group(0, 1, "reduced");
  grid.input.supports = {{.nodes = grid.line([](int, int) { return true; }), .y = FixityCode::fixed}};
  StageInput stage{.increments = 5, .tolerance = 1e-10};
  stage.supports = {{.nodes = grid.column(0), .x = FixityCode::fixed, .x_value = lambda - 1.0}};
  grid.input.stages = {stage};
  const WholeRun whole = run(grid.input);
  EXPECT_TRUE(whole.completed()) << whole.failure;
  return whole.reaction(whole.last(), grid.column(0), 0) / (2.0 * kPi * lambda * 0.1);
}

TEST(LargeStrainModels, AThickCylinderConvergesToTheClosedForm) {
  for (const auto& [lambda, exact] : {std::pair{1.1, .131211200057}, {1.5, .40724019528}}) {
    const double coarse = std::abs(wall_pressure(lambda, 4) / exact - 1.0);
    const double fine = std::abs(wall_pressure(lambda, 8) / exact - 1.0);
    EXPECT_LT(std::abs(wall_pressure(lambda, 16) / exact - 1.0), 1e-5) << lambda;
    EXPECT_GT(std::log2(coarse / fine), 3.7) << lambda;  // 4 by theory
  }
}

// A cavity in a finite cylinder, B/A = 10, in clay that yields at the shear stress c and keeps its volume in plane strain: a ring
// of first radius R lies at r = sqrt(R^2 + d), d = a^2 - A^2, and the difference of its stresses is 2 G ln(r^2/R^2), at most 2 c.
// The pressure in the cavity is its integral over dr/r = R dR/r^2, here by Simpson's rule on both sides of the place where yield
// begins.
double cavity_pressure(double G, double c, double a) {
  const double d = a * a - 1.0, B = 10.0;
  const auto integral = [&](double from, double to) {
    constexpr int kParts = 4000;
    double sum = 0.0;
    for (int i = 0; i <= kParts; ++i) {
      const double R = from + (to - from) * i / kParts;
      const double value = std::min(2.0 * G * std::log1p(d / (R * R)), 2.0 * c) * R / (R * R + d);
      sum += (i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * value;
    }
    return sum * (to - from) / kParts / 3.0;
  };
  const double yields = std::clamp(std::sqrt(d / std::expm1(c / G)), 1.0, B);
  return integral(1.0, yields) + integral(yields, B);
}

TEST(LargeStrainModels, ACavityInAFiniteCylinderHasThePressureOfItsIntegral) {
  constexpr double kShear = 50.0, kNu = 0.499999;
  constexpr int kElements = 48;
  Grid grid{.x = {}, .y = {0.0, 0.1}};
  for (int i = 0; i <= kElements; ++i) grid.x.push_back(std::pow(10.0, static_cast<double>(i) / kElements));
  grid.input.geometry = Geometry::axisymmetric;
  grid.input.materials = {{.law = "mohr_coulomb",
                           .parameters = {{"youngs_modulus", 2.0 * kShear * (1.0 + kNu)},
                                          {"poissons_ratio", kNu},
                                          {"cohesion", 1.0},
                                          {"friction_angle", 0.0},
                                          {"dilation_angle", 0.0}}}};
  grid.make_nodes();
  grid.add_group(0, 1, "reduced");
  grid.input.supports = {{.nodes = grid.line([](int, int) { return true; }), .y = FixityCode::fixed}};
  StageInput stage{.increments = 50, .tolerance = 1e-9};
  stage.supports = {{.nodes = grid.column(0), .x = FixityCode::fixed, .x_value = 1.0}};
  grid.input.stages = {stage};
  const WholeRun whole = run(grid.input);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  for (const std::size_t increment : {4u, 24u, 49u}) {
    const double a = 1.0 + static_cast<double>(increment + 1) / 50.0;
    const double p = whole.reaction(whole.increments.at(increment), grid.column(0), 0) / (2.0 * kPi * a * 0.1);
    const double exact = cavity_pressure(kShear, 1.0, a);
    EXPECT_NEAR(p / exact, 1.0, 1e-4) << a << ' ' << p << ' ' << exact;
  }
}

// Ratio to the homogeneous force of the same law, hp elements, good to 2e-6 (nu = .25).
TEST(LargeStrainModels, PinnedCylindersHaveTheConvergedRatio) {
  struct Case {
    double slenderness, ratio[3];  // at 5, 10 and 15 %
  };
  for (const Case& c :
       {Case{1.0, {1.0359693, 1.0351527, 1.0334903}}, Case{2.0, {1.0174627, 1.0170063, 1.0161213}}}) {
    RestrainedCylinder specimen{.slenderness = c.slenderness, .nu = 0.25};
    DeckWriter deck = specimen.between_rough_platens(0.15);
    deck.large_strain = true;
    deck.stages[0].increments = 3;
    const WholeRun whole = bench().run(deck.text());
    ASSERT_TRUE(whole.completed()) << whole.failure;
    for (std::size_t i = 0; i < 3; ++i) {
      const double l = 1.0 - 0.05 * static_cast<double>(i + 1);
      const double force = -whole.reaction(whole.increments[i], specimen.block().top(), 1) / kPi;
      EXPECT_NEAR(force / (-std::log(l) / l), c.ratio[i], 2e-5) << c.slenderness << " " << l;
    }
  }
}

// Columns without lateral strain, M = E (1 - nu)/((1 + nu)(1 - 2 nu)): Cauchy stress M ln(l)/l.
constexpr double kHigh = 1.0, kOedometer = 1000.0 * 0.7 / (1.3 * 0.4);
double column_stress(double l) {
  return kOedometer * std::log(l) / l;
}

Grid two_layers(const std::string& element, const std::string& formulation) {
  Grid grid{.x = {0.0, 1.0}, .y = {0.0, kHigh, 2.0 * kHigh}, .element = element};
  grid.input.materials = {elastic(1000.0, 0.3)};
  grid.make_nodes();
  grid.add_group(0, 1, formulation);
  grid.add_group(1, 2, formulation);
  grid.input.supports = {{.nodes = grid.row(0), .y = FixityCode::fixed},
                         {.nodes = grid.line([](int, int) { return true; }), .x = FixityCode::fixed}};
  const int middle = grid.step();
  StageInput first{.increments = 2, .tolerance = 1e-12}, second = first, third = first;
  first.supports = {pushed(grid.row(middle), -0.3)};
  second.births = {2};
  second.supports = {{.nodes = grid.row(middle), .y = FixityCode::released},
                     pushed(grid.row(2 * middle), -0.2)};
  third.deaths = {2};
  grid.input.stages = {first, second, third};
  return grid;
}

// The upper layer is free of stress where it is activated, 1.3 high; then both have one stress.  Without it the lower one
// has its first height.
TEST(LargeStrainModels, AGroupComesAndGoesInTheDeformedState) {
  for (const auto& [element, formulation] : {std::pair{"quad8", "reduced"}, {"quad4", "full"}}) {
    Grid grid = two_layers(element, formulation);
    const WholeRun whole = run(grid.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    double lower = 0.7, upper = 0.0;
    double low = 0.5, high = 1.0;
    for (int i = 0; i < 100; ++i) {  // bisection on the height of the lower layer
      lower = 0.5 * (low + high);
      upper = 1.8 - lower;
      (column_stress(lower) < column_stress(upper / 1.3) ? low : high) = lower;
    }
    const int middle = grid.row(grid.step()).front(), dof = 2 * (middle - 1) + 1;
    EXPECT_NEAR(whole.increments[1].u[dof], -0.3, 1e-12);
    EXPECT_NEAR(whole.increments[3].u[dof], lower - 1.0, 1e-9) << element;
    EXPECT_NEAR(whole.reaction(whole.increments[3], grid.row(0), 1), -column_stress(lower), 1e-7) << element;
    EXPECT_NEAR(whole.increments[5].u[dof], 0.0, 1e-9) << element;
  }
}

// A column under its own weight that starts with the stress of that weight stays.
TEST(LargeStrainModels, GroundWithItsStressStays) {
  Grid grid{.x = {0.0, 1.0, 3.0}, .y = {0.0, 1.0, 2.5}};
  grid.input.materials = {elastic(1000.0, 0.3)};
  grid.input.materials[0].unit_weight = 20.0;
  grid.make_nodes();
  grid.add_group(0, 2, "reduced");
  grid.input.supports = {{.nodes = grid.row(0), .y = FixityCode::fixed},
                         {.nodes = grid.column(0), .x = FixityCode::fixed},
                         {.nodes = grid.column(grid.columns()), .x = FixityCode::fixed}};
  grid.input.initials = {{1, InitialKind::geostatic, {2.5, 20.0, 0.4}}};
  grid.input.stages = {{.gravity = {0.0, -1.0}}};
  const WholeRun whole = run(grid.input);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  EXPECT_LT(whole.largest_u(), 1e-12);
}

TEST(LargeStrainModels, ARunIsResumedFromAnyCheckpointBitForBit) {
  Grid grid = two_layers("quad8", "reduced");
  grid.input.stages[1].pressures = {{.elements = {2}, .edge = 2, .normal1 = 20.0, .normal2 = 20.0}};
  std::vector<std::string> checkpoints;
  RunSettings settings;
  settings.checkpoint_due = [] { return true; };
  settings.save_checkpoint = [&](const std::string& state) { checkpoints.push_back(state); };
  const WholeRun whole = run(grid.input, settings);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  ASSERT_EQ(checkpoints.size(), 5u);
  for (const std::string& state : checkpoints) {
    RunSettings again;
    again.resume_from = state;
    const WholeRun resumed = run(grid.input, again);
    ASSERT_TRUE(resumed.completed()) << resumed.failure;
    EXPECT_TRUE(resumed.last().u == whole.last().u);
    EXPECT_TRUE(resumed.last().internal == whole.last().internal);
    for (std::size_t g = 0; g < 2; ++g) EXPECT_TRUE(resumed.stress[g] == whole.stress[g]);
  }
}

// Each residual at most the square of the one before, times a constant, near the end.
TEST(LargeStrainModels, NewtonConvergesQuadratically) {
  struct Residuals final : Observer {
    std::vector<IterationRecord> last;
    void on_increment(const Model&, const StepReport& report, const Solution&) override {
      last = report.iterations;
    }
  };
  for (const auto& [element, formulation] : {std::pair{"quad8", "reduced"}, {"quad4", "b-bar"}}) {
    Grid grid = cylinder(element, formulation, elastic(1000.0, 0.3));
    StageInput stage{.tolerance = 1e-12};
    stage.supports = {
        {.nodes = grid.row(grid.rows()), .x = FixityCode::fixed, .y = FixityCode::fixed, .y_value = -0.3}};
    grid.input.stages = {stage};
    Residuals residuals;
    Observer* observers[] = {&residuals};
    const Model model = build_model(grid.input, everything());
    ASSERT_EQ(bench().run(model, observers).status, RunStatus::completed);
    int squared = 0;
    for (std::size_t i = 1; i < residuals.last.size(); ++i) {
      const double before = residuals.last[i - 1].force, now = residuals.last[i].force;
      if (before > 0.03 || now < 1e-13) continue;
      EXPECT_LT(now, 5.0 * before * before) << element << " " << i;
      ++squared;
    }
    EXPECT_GE(squared, 1) << element;
    EXPECT_LE(residuals.last.size(), 7u) << element;
  }
}

// At nu = .495 the corner beside the platen folds near 12 % on fine meshes (hp elements); coarse ones go further.  The page
// names the element in that corner and its node on the rim.
TEST(LargeStrainModels, ACornerThatFoldsEndsTheRunWithItsPlace) {
  RestrainedCylinder specimen{.slenderness = 1.0, .nu = 0.495, .columns = 6, .rows = 6};
  DeckWriter deck = specimen.between_rough_platens(0.3);
  deck.large_strain = true;
  deck.stages[0].increments = 6;
  const WholeRun whole = bench().run(deck.text());
  ASSERT_EQ(whole.result.status, RunStatus::not_converged);
  EXPECT_EQ(whole.result.code, Code("S555")) << whole.result.reason;
  EXPECT_GT(whole.last().load_factor, 0.1 / 0.3);
  EXPECT_NE(whole.result.reason.find("element 36 "), std::string::npos) << whole.result.reason;
  EXPECT_NE(whole.result.reason.find("turns inside out: its corner at node"), std::string::npos);
}

// The force of a pinned cylinder at both sizes of strain: they differ in proportion to the strain (theory; slope 1 +- .02).
TEST(LargeStrainModels, TheDifferenceFromSmallStrainFallsInProportionToTheStrain) {
  for (const auto& [element, formulation] :
       {std::pair{"quad8", "reduced"}, {"quad8", "full"}, {"quad4", "b-bar"}}) {
    double difference[2];
    int at = 0;
    for (const double strain : {1e-3, 1e-6}) {
      double force[2];
      for (const bool large : {false, true}) {
        Grid grid = cylinder(element, formulation, elastic(1000.0, 0.3));
        grid.input.large_strain = large;
        StageInput stage{.tolerance = 1e-12};
        stage.supports = {{.nodes = grid.row(grid.rows()),
                           .x = FixityCode::fixed,
                           .y = FixityCode::fixed,
                           .y_value = -2.0 * strain}};
        grid.input.stages = {stage};
        const WholeRun whole = run(grid.input);
        ASSERT_TRUE(whole.completed()) << whole.failure;
        force[large ? 1 : 0] = whole.reaction(whole.last(), grid.row(grid.rows()), 1);
      }
      difference[at++] = std::abs(force[1] / force[0] - 1.0);
    }
    EXPECT_LT(difference[1], 1e-5) << element << " " << formulation;
    EXPECT_NEAR(std::log10(difference[0] / difference[1]) / 3.0, 1.0, 0.02) << element << " " << formulation;
  }
}

// The control card keeps it.
TEST(LargeStrainModels, AWrittenDeckIsTheSameModel) {
  RestrainedCylinder specimen{.columns = 2, .rows = 2};
  DeckWriter deck = specimen.between_rough_platens(0.1);
  deck.large_strain = true;
  const Model model = bench().build(deck.text());
  ASSERT_TRUE(model.large_strain);
  Diagnostics notes;
  const Model again = bench().build(sage1_text(model, notes));
  EXPECT_TRUE(again.large_strain);
  EXPECT_EQ(fingerprint(again), fingerprint(model));
  deck.large_strain = false;
  EXPECT_NE(fingerprint(bench().build(deck.text())), fingerprint(model));
}

// What a model's builder says, or "".
std::string complaint(const ModelInput& input) {
  try {
    build_model(input, everything());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
void expect_complaint(const ModelInput& input, const std::string& code, const std::string& words) {
  const std::string text = complaint(input);
  EXPECT_NE(text.find(code), std::string::npos) << text;
  EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST(LargeStrainModels, ElementsAndLawsThatCannotAreRejectedByName) {
  Grid enhanced = cylinder("quad4", "enhanced", elastic(1.0, 0.3));
  enhanced.input.stages = {{}};
  expect_complaint(enhanced.input, "S551", "quad4 enhanced is for small strain alone");
  Grid hyperbolic = cylinder("quad8", "reduced", {.law = "", .parameters = {}});
  hyperbolic.input.stages = {{}};
  const std::string name = everything().materials.find(6)->name;
  hyperbolic.input.materials[0].law = name;
  for (const Parameter& parameter : everything().materials.find(6)->parameters)
    if (parameter.required)
      hyperbolic.input.materials[0].parameters[parameter.name] =
          parameter.name == "friction_angle" ? 30.0 : 0.4;
  expect_complaint(hyperbolic.input, "S552", "has no elastic logarithmic strain");
  Grid bars = cylinder("quad8", "reduced", elastic(1.0, 0.3));
  bars.input.materials.push_back(
      {.law = everything().materials.find(31)->name, .parameters = {{"stiffness", 1.0}}});
  bars.input.groups.push_back({.element = "bar2", .material = 2, .elements = {{1, 2}}});
  bars.input.stages = {{}};
  expect_complaint(bars.input, "S551", "bar2");
}

// The bottom of a cylinder and a rigid line at that height, held at its ends and pushed up by `push`.
Grid above_a_line(const std::string& element, double height, double push, double radius = 5.0) {
  Grid grid = cylinder(element, element == "quad8" ? "reduced" : "b-bar", elastic(1.0, 0.3));
  ModelInput& input = grid.input;
  input.supports = {{.nodes = grid.row(grid.rows()), .y = FixityCode::fixed},
                    {.nodes = grid.column(0), .x = FixityCode::fixed}};
  input.nodes.emplace_back(0.0, height);
  input.nodes.emplace_back(radius, height);
  const int last = static_cast<int>(input.nodes.size());
  input.materials.push_back(
      {.law = "goodman", .parameters = {{"shear_stiffness", 0.0}, {"normal_stiffness", 50.0}}});
  GroupInput contact{.element = element == "quad8" ? "contact5" : "contact4", .material = 2, .elements = {}};
  const int step = grid.step();
  for (int i = 0; i < grid.columns(); i += step) {
    std::vector<int> nodes{grid.numbers.at({i, 0}), grid.numbers.at({i + step, 0})};
    if (step == 2) nodes.push_back(grid.numbers.at({i + 1, 0}));
    nodes.push_back(last - 1);
    nodes.push_back(last);
    contact.elements.push_back(nodes);
  }
  input.groups.push_back(contact);
  StageInput stage{.increments = 4, .tolerance = 1e-12};
  stage.supports = {
      {.nodes = {last - 1, last}, .x = FixityCode::fixed, .y = FixityCode::fixed, .y_value = push}};
  input.stages = {stage};
  return grid;
}

// A bar of Hencky's law of the length 2 l has the force -A0 E ln(l)/l on the area A0 l^(-2 nu).  The line comes to it
// through a gap of 0.1, and then enters it by the pressure over the stiffness.
TEST(LargeStrainModels, ABarOnALineHasThePenaltysCompliance) {
  const double l = 0.9, area = kPi * std::pow(l, -0.6), force = -kPi * std::log(l) / l;
  for (const char* element : {"quad8", "quad4"}) {
    const Grid grid = above_a_line(element, -0.1, 0.1 + 2.0 * (1.0 - l) + force / area / 50.0);
    const WholeRun whole = run(grid.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    const int last = static_cast<int>(grid.input.nodes.size());
    EXPECT_NEAR(whole.reaction(whole.last(), {last - 1, last}, 1), force, 1e-10 * force) << element;
    EXPECT_NEAR(whole.reaction(whole.last(), grid.row(grid.rows()), 1), -force, 1e-10 * force) << element;
  }
}

// Two blocks, one upon the other, with an interface between them; the lower one 10 wide under one of the width 1 to 2.
struct Blocks {
  ModelInput input{.units = {"m", "kN", "kPa", 101.325, 9.81}, .large_strain = true};
  std::vector<int> bottom{1, 2}, top{7, 8};
  explicit Blocks(double shear_stiffness) {
    input.nodes = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0},
                   {0.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}};
    input.materials = {
        elastic(1.0, 0.3),
        {.law = "goodman",
         .parameters = {{"shear_stiffness", shear_stiffness}, {"normal_stiffness", 50.0}, {"tension", 1.0}}}};
    input.groups = {
        {.element = "quad4", .material = 1, .elements = {{1, 2, 3, 4}, {5, 6, 7, 8}}},
        {.element = "interface4", .material = 2, .elements = {{4, 3, 6, 5}}, .formulation = "Gauss"}};
    input.supports = {{.nodes = bottom, .x = FixityCode::fixed, .y = FixityCode::fixed}};
  }
};

// Plates of a column without lateral strain, M = E (1 - nu)/((1 + nu)(1 - 2 nu)): each has the force -M ln(l) of the width 1,
// and the joint closes by that over its stiffness.  The whole is then turned by 60 degrees, and has the same forces.
TEST(LargeStrainModels, AJointBetweenBlocksHasItsComplianceAndTurnsWithThem) {
  Blocks blocks(10.0);
  const double l = 0.8, force = -0.7 / (1.3 * 0.4) * std::log(l) / l, closing = force / 50.0;
  std::vector<int> all{1, 2, 3, 4, 5, 6, 7, 8};
  StageInput press{.increments = 2, .tolerance = 1e-12};
  press.supports = {{.nodes = all, .x = FixityCode::fixed},
                    {.nodes = blocks.top,
                     .x = FixityCode::fixed,
                     .y = FixityCode::fixed,
                     .y_value = -2.0 * (1.0 - l) - closing}};
  blocks.input.stages = {press};
  const WholeRun whole = run(blocks.input);
  ASSERT_TRUE(whole.completed()) << whole.failure;
  EXPECT_NEAR(whole.reaction(whole.last(), blocks.top, 1), -force, 1e-9 * force);
  EXPECT_NEAR(whole.reaction(whole.last(), blocks.bottom, 1), force, 1e-9 * force);
  // Turned about the origin in six steps of ten degrees.
  const std::vector<Vector2> first = blocks.input.nodes;
  std::vector<Vector2> places;
  for (int n = 1; n <= 8; ++n) places.push_back(first[static_cast<std::size_t>(n - 1)] + whole.u(n));
  for (int step = 0; step < 6; ++step) {
    StageInput turn{.tolerance = 1e-12};
    for (const int n : {1, 2, 7, 8}) {
      const double a = kPi / 18.0 * step, b = kPi / 18.0 * (step + 1);
      const Vector2 p = places[static_cast<std::size_t>(n - 1)];
      const Vector2 from(std::cos(a) * p.x() - std::sin(a) * p.y(), std::sin(a) * p.x() + std::cos(a) * p.y()),
          to(std::cos(b) * p.x() - std::sin(b) * p.y(), std::sin(b) * p.x() + std::cos(b) * p.y());
      turn.supports.push_back({.nodes = {n},
                               .x = FixityCode::fixed,
                               .y = FixityCode::fixed,
                               .x_value = to.x() - from.x(),
                               .y_value = to.y() - from.y()});
    }
    // Inner corners are held across: they go on chords, so that they are left free here.
    turn.supports.push_back({.nodes = {3, 4, 5, 6}, .x = FixityCode::released});
    blocks.input.stages.push_back(turn);
  }
  const WholeRun turned = run(blocks.input);
  ASSERT_TRUE(turned.completed()) << turned.failure;
  const double fx = turned.reaction(turned.last(), blocks.top, 0),
               fy = turned.reaction(turned.last(), blocks.top, 1);
  // Inner corners that are free widen a little, so compare with the same blocks whose corners are let go without a turn.
  Blocks still(10.0);
  still.input.stages = {press, {.tolerance = 1e-12}};
  still.input.stages[1].supports = {{.nodes = {3, 4, 5, 6}, .x = FixityCode::released}};
  const WholeRun free = run(still.input);
  ASSERT_TRUE(free.completed()) << free.failure;
  const double expected = free.reaction(free.last(), still.top, 1);
  EXPECT_NEAR(std::hypot(fx, fy), std::abs(expected), 1e-7 * force);
  EXPECT_NEAR(std::atan2(fy, fx), -kPi / 2.0 + kPi / 3.0, 1e-6);
}

// A slip that the joint bears by its shear stiffness over the length that it has.
TEST(LargeStrainModels, SlipBeyondHalfAnElementIsWarnedOf) {
  for (const double slip : {0.4, 0.6}) {
    Blocks blocks(1e-3);
    StageInput slide{.increments = 4, .tolerance = 1e-11};
    slide.supports = {{.nodes = blocks.top, .x = FixityCode::fixed, .y = FixityCode::fixed, .x_value = slip}};
    blocks.input.stages = {slide};
    const WholeRun whole = run(blocks.input);
    ASSERT_TRUE(whole.completed()) << whole.failure;
    EXPECT_NEAR(whole.reaction(whole.last(), blocks.top, 0), 1e-3 * slip, 0.02 * 1e-3 * slip);
    EXPECT_EQ(whole.warns("more than half an element's length in element(s) 3"), slip > 0.5) << slip;
  }
}

// What an element of contact must be given; the parts that are not would let the edge pass the line.
TEST(LargeStrainModels, ContactLiesOnOneEdgeOfASolidBesideAHeldLine) {
  const auto contact = [](const std::vector<int>& nodes) {
    Grid grid = above_a_line("quad8", -0.1, 0.2);
    grid.input.groups[1].elements = {nodes};
    return grid.input;
  };
  Grid grid = above_a_line("quad8", -0.1, 0.2);
  const auto at = [&](int i, int j) { return grid.numbers.at({i, j}); };
  const int last = static_cast<int>(grid.input.nodes.size());
  ASSERT_EQ(complaint(contact({at(0, 0), at(2, 0), at(1, 0), last - 1, last})), "");
  expect_complaint(contact({at(0, 0), at(1, 0), at(2, 0), last - 1, last}), "S560", "ends first");
  expect_complaint(contact({at(0, 0), at(2, 2), at(1, 0), last - 1, last}), "S560", "no solid has an edge");
  expect_complaint(contact({at(0, 0), at(2, 0), at(1, 0), last, last - 1}), "S226", "exchange the two");
  ModelInput twice = contact({at(0, 0), at(2, 0), at(1, 0), last - 1, last});
  twice.groups[1].elements.push_back(twice.groups[1].elements.front());
  expect_complaint(twice, "S560", "given twice");
  ModelInput half = contact({at(0, 0), at(2, 0), last - 1, last});
  half.groups[1].element = "contact4";
  expect_complaint(half, "S560", "contact5");
  ModelInput loose = contact({at(0, 0), at(2, 0), at(1, 0), last - 1, last});
  loose.stages[0].supports = {pushed({last - 1, last}, 0.2)};
  expect_complaint(loose, "S561", "held by no support");
  // An edge on the line shows by the solid's side alone which way the line goes.
  Grid closed = above_a_line("quad8", 0.0, 0.1);
  std::swap(closed.input.groups[1].elements[0][3], closed.input.groups[1].elements[0][4]);
  expect_complaint(closed.input, "S561", "exchange the two");
}

// The nodes of the line may be at places of other nodes: no body is cut there.
TEST(LargeStrainModels, NodesOfALineOfContactMayCoincideWithOthers) {
  const Grid grid = above_a_line("quad8", 0.0, 0.01, 1.0);
  const Model model = build_model(grid.input, everything());
  for (const Diagnostic& one : model.diagnostics.list())
    EXPECT_EQ(one.message.find("at one place"), std::string::npos) << one.message;
}

TEST(LargeStrainModels, ContactNeedsLargeStrainAndItsOwnMesh) {
  Grid grid = above_a_line("quad8", -0.1, 0.2);
  grid.input.large_strain = false;
  expect_complaint(grid.input, "S556", "contact5, contact of a moved edge, which needs large strain");
  grid.input.large_strain = true;
  std::string text;
  try {
    BuildOptions options;
    options.refine = 1;
    build_model(grid.input, everything(), options);
  } catch (const InputError& error) {
    text = error.what();
  }
  EXPECT_NE(text.find("S557"), std::string::npos) << text;
  EXPECT_NE(text.find("can't be refined"), std::string::npos) << text;
}

}  // namespace
}  // namespace sage::test
