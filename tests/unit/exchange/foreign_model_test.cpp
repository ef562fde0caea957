// Decks of other programs as models.  Expected values: the decks' own counts and
// QUAD4M's own echo of its areas.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/values.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/foreign_decks.hpp"

namespace sage::app {
namespace {

using test::kInputs, test::mentions, test::model_of, test::run_of;

std::string refusal(const std::string& deck, const std::string& layout) {
  try {
    model_of(deck, layout);
  } catch (const InputError& error) {
    return error.diagnostics().list().front().message;
  }
  return "";
}

TEST(ForeignModel, Quad4mAreasAgreeWithItsOwnEcho) {
  const Model model = model_of("quad4m/MDL.Q4I");
  EXPECT_EQ(model.mesh.nodes(), 2289);
  std::map<int, double> area;
  for (const Group& group : model.groups) {
    std::vector<double> geometry(static_cast<std::size_t>(group.element->traits().geometry_size()));
    const ElementTraits& traits = group.element->traits();
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      group.element->geometry(x, geometry);
      double& sum = area[group.element_numbers[e]];
      for (int p = 0; p < traits.points; ++p) sum += geometry[p * (1 + traits.law_size * traits.dofs)];
    }
  }
  std::ifstream in(SAGE_SOURCE_DIR "/tests/unit/exchange/data/quad4m_areas.csv");
  int compared = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    int number = 0;
    double echoed = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf", &number, &echoed), 2);
    // Printed with three decimals, computed there in single precision.
    EXPECT_NEAR(area.at(number), echoed, 0.0006 + 1e-5 * echoed) << "element " << number;
    ++compared;
  }
  EXPECT_EQ(compared, 2933);
}

TEST(ForeignModel, Quad4mCarriesItsWeight) {
  const RunOutcome outcome = run_of("quad4m/MDL.Q4I");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.record.result.reason;
  EXPECT_LT(outcome.record.out_of_balance, 1e-9);
  EXPECT_TRUE(mentions(outcome.model->diagnostics, Severity::note, "30 node(s) of a transmitting base"));
  // N/m^3 in the deck, kN/m^3 here; E = 2 G (1 + nu) of element 1.
  EXPECT_DOUBLE_EQ(outcome.model->materials.front().unit_weight, 22.0);
  EXPECT_NEAR(outcome.model->materials.front().parameters[0], 2 * 4855861.0 * 1.392, 1.0);
}

TEST(ForeignModel, Quad4mStatusSaysThatThereIsNoEarthquake) {
  EXPECT_EQ(completed_words(model_of("quad4m/MDL.Q4I"), 0.0),
            "completed, but PARTIAL: left out earthquake motion and damping");
}

TEST(ForeignModel, AxisymmetricForcesAreForOneRadian) {
  const Model model = model_of("smith_griffiths/p51_5.dat");
  EXPECT_EQ(model.geometry, Geometry::axisymmetric);
  EXPECT_NEAR(model.stages[0].loads[2].force.y(), -24.0 * 2 * 3.14159265358979, 1e-10);
  EXPECT_EQ(model.groups[0].element_name, "quad4 full 3x3");
}

TEST(ForeignModel, FootingPrograms) {
  const Model model = model_of("smith_griffiths/p66.dat", "sg_p66");
  EXPECT_EQ(model.stages.size(), 10u);
  EXPECT_EQ(model.mesh.nodes(), 121);
  std::set<std::pair<int, std::size_t>> held;
  for (const Fixity& f : model.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held.insert({f.node, c});
  EXPECT_EQ(static_cast<std::size_t>(DofMap(model).dofs()) - held.size(), 192u)
      << "equations, as p66.res counts them";
}

TEST(ForeignModel, EmbankmentInLifts) {
  const Model model = model_of("smith_griffiths/p69.dat", "sg_p69");
  EXPECT_EQ(model.stages.size(), 5u);
  std::vector<int> lifts;
  double area = 0.0;
  for (const Group& group : model.groups) {
    lifts.push_back(group.elements());
    for (int e = 0; e < group.elements(); ++e) {
      const std::size_t corners = group.node_count() == 8 ? 4 : 3;
      for (std::size_t i = 0; i < corners; ++i) {
        const Vector2 a = model.mesh.x.col(group.nodes_of(e)[i]);
        const Vector2 b = model.mesh.x.col(group.nodes_of(e)[(i + 1) % corners]);
        area += 0.5 * (a.x() * b.y() - b.x() * a.y());
      }
    }
  }
  EXPECT_EQ(lifts, (std::vector<int>{48, 7, 1, 6, 1, 5, 1, 4, 1})) << "74 elements";
  // 38 x 10 below; four lifts of 1 m whose toes stand at x = 20, 22, 24, 26, each slope 2 m long.
  EXPECT_NEAR(area, 380.0 + (18.0 - 1.0) + (16.0 - 1.0) + (14.0 - 1.0) + (12.0 - 1.0), 1e-10);
  EXPECT_EQ(model.mesh.nodes(), 263 - 8) << "two nodes of each slope element are left out";
  std::set<std::pair<int, std::size_t>> held;
  for (const Fixity& f : model.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held.insert({f.node, c});
  EXPECT_EQ(static_cast<std::size_t>(DofMap(model).dofs()) - held.size(), 452u - 16u)
      << "p69.res: 452 freedoms";
}

// Program 6.11 with water of bulk modulus Kw = 60 K': p' = 100 + q / 3 / 61, and at yield q = 1.2 p' (phi = 30),
// from which both follow; no plastic change of volume after it (psi = 0).
TEST(ForeignModel, UndrainedTriaxialTest) {
  std::ifstream file(kInputs + "smith_griffiths/p611_1.dat");
  std::string deck{std::istreambuf_iterator<char>(file), {}};
  const std::string drained = "0.25  0.0  -100.0";
  const std::size_t at = deck.find(drained);
  ASSERT_NE(at, std::string::npos);
  deck.replace(at, drained.size(), "0.25  1.0e6  -100.0");
  Model model = build_model(read_deck_text(deck, "p611_2.dat", load_layout("sg_p611")), full_catalogue());
  for (const char* words : {"overlap", "inside the body"})
    EXPECT_FALSE(mentions(model.diagnostics, Severity::warning, words)) << words;
  const scenes::WholeRun run = make_workbench().run(std::move(model));
  ASSERT_TRUE(run.completed());
  const double q = 120.0 / (1.0 - 1.2 / 183.0), u = q / 3.0 * 60.0 / 61.0;
  const Eigen::Vector4d soil = run.stress[0].col(0), water = run.stress[1].col(0);
  EXPECT_NEAR(soil[0] - soil[1], q, 1e-3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(-water[c], u, 1e-3) << c;
  EXPECT_NEAR(-(soil[0] + water[0]), 100.0, 1e-6) << "the cell pressure is borne by both";
}

TEST(ForeignModel, WhatCanNotBecomeAModelIsRefused) {
  EXPECT_NE(refusal("smith_griffiths/p52.dat", "sg_p52").find("three displacements a node"), std::string::npos);
  EXPECT_NE(refusal("cande_level3/candejar_cidmock_standard_lines.cid", "").find("no nodes"),
            std::string::npos);
}

// A layout of one's own whose card has the coordinates under another name.
TEST(ForeignModel, AMeshWithoutItsCoordinatesIsRefused) {
  std::ifstream file(kInputs + "layouts/sg_p61.toml");
  std::string layout{std::istreambuf_iterator<char>(file), {}};
  const std::string field = "{ name = \"y\", label";
  ASSERT_NE(layout.find(field), std::string::npos);
  layout.replace(layout.find(field), field.size(), "{ name = \"z\", label");
  const std::string path = test::scratch_folder("own_layout").string() + "/own.toml";
  std::ofstream(path) << layout;
  EXPECT_EQ(refusal("smith_griffiths/p61.dat", path),
            "field \"z\" of card \"rectangle_y\" is used by nothing; the nearest name is \"y\" (or mark it: "
            "ignored = "
            "true)");
}

}  // namespace
}  // namespace sage::app
