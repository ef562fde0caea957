// Cards that a deck of any layout may have in place of stages.  Expected values: closed forms for a column of
// squares, 1 wide, nu = 0.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "sage/analysis/external_loads.hpp"
#include "sage/analysis/initial_balance.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/summary.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

// Two 4-node squares of side 1 over each other, held below; sides and parameters as the deck says.
constexpr const char* kLayout = R"toml(
name = "column"
blanks = "null"
[[card]]
name = "control"
made = true
fields = [{ name = "geometry", value = "1" }]
[[card]]
name = "node"
format = "*"
repeat = "6"
fields = [{ name = "number", kind = "integer", value = "order" }, { name = "x", kind = "real" }, { name = "y", kind = "real" }]
[[card]]
name = "material"
opens = true
format = "*"
fields = [{ name = "number", kind = "integer", value = "1" }, { name = "law", kind = "integer" }, { name = "unit_weight", kind = "real" }, { name = "k0", kind = "real" }]
[[card]]
name = "parameters"
format = "*"
fields = [{ name = "values", kind = "real", count = "if(material.law == 1, 2, 5)" }]
[[card]]
name = "group"
made = true
opens = true
fields = [{ name = "number", value = "1" }, { name = "element", value = "1" }, { name = "formulation", value = "1" }, { name = "material", value = "1" }]
[[card]]
name = "element"
format = "*"
repeat = "2"
fields = [{ name = "number", kind = "integer" }, { name = "n1", kind = "integer" }, { name = "n2", kind = "integer" }, { name = "n3", kind = "integer" }, { name = "n4", kind = "integer" }]
[[card]]
name = "held"
format = "*"
ignored = true
fields = [{ name = "count", kind = "integer" }]
[[card]]
name = "fixity"
format = "*"
repeat = "held.count"
fields = [{ name = "first", kind = "integer" }, { name = "x_code", kind = "integer" }, { name = "y_code", kind = "integer" }]
)toml";

constexpr const char* kMesh = "0. 0.\n1. 0.\n0. 1.\n1. 1.\n0. 2.\n1. 2.\n";
constexpr const char* kElements = "7 1 2 4 3\n8 3 4 6 5\n";
// x is held on both sides, so that a column is a bar.
constexpr const char* kHeld = "6\n1 1 1\n2 1 1\n3 1 0\n4 1 0\n5 1 0\n6 1 0\n";
constexpr const char* kElastic = "1 20. .5\n1000. 0.\n";

constexpr const char* kLoad = R"toml(
[[card]]
name = "load"
format = "*"
repeat = "2"
fields = [{ name = "first", kind = "integer" }, { name = "y_force", kind = "real" }]
)toml";

// The first error of what refuses a deck; empty where it does not.
std::string first_error(const std::function<void()>& make) {
  try {
    make();
  } catch (const InputError& error) {
    return error.diagnostics().list().front().message;
  }
  return "";
}

struct Column {
  std::string layout, deck;
  Model model() const {
    return build_model(read_deck_text(deck, "column.dat", load_layout_text(kLayout + layout, "column.toml")),
                       full_catalogue());
  }
  scenes::WholeRun run() const { return make_workbench().run(model()); }
  std::string complaint() const {
    return first_error([this] { model(); });
  }
};

std::string elastic_deck(const std::string& more) {
  return std::string(kMesh) + kElastic + kElements + kHeld + more;
}

double settlement(const scenes::WholeRun& run, std::size_t increment) {
  return run.increments.at(increment).u[2 * run.index(5) + 1];
}

// E = 1000, 2 high: u = 2 F / E.  Loads that are added, or reached; in a list or a card a step.
TEST(StageCards, LoadsComeByFactors) {
  const std::string loads = "5 -5.\n6 -5.\n";
  const std::string list = R"toml([[card]]
name = "increments"
format = "*"
fields = [{ name = "NAME", kind = "real", count = "3" }]
)toml";
  const std::string cards = R"toml([[card]]
name = "increment"
format = "*"
repeat = "3"
fields = [{ name = "NAME", kind = "real" }]
)toml";
  const auto named = [](std::string text, const std::string& name) {
    return text.replace(text.find("NAME"), 4, name);
  };
  const std::string added = "0.5 0.3 -0.2\n", reached = "0.5 0.8 0.6\n";
  const std::string added_cards = "0.5\n0.3\n-0.2\n", reached_cards = "0.5\n0.8\n0.6\n";
  for (const auto& [layout, values] :
       {std::pair{named(list, "factors"), added}, std::pair{named(list, "totals"), reached},
        std::pair{named(cards, "factor"), added_cards}, std::pair{named(cards, "total"), reached_cards}}) {
    const scenes::WholeRun run = Column{kLoad + layout, elastic_deck(loads + values)}.run();
    ASSERT_TRUE(run.completed());
    ASSERT_EQ(run.increments.size(), 3u);
    EXPECT_NEAR(settlement(run, 0), -0.5 * 20.0 / 1000.0, 1e-14);
    EXPECT_NEAR(settlement(run, 1), -0.8 * 20.0 / 1000.0, 1e-14);
    EXPECT_NEAR(settlement(run, 2), -0.6 * 20.0 / 1000.0, 1e-14);
  }
  // Without factors all comes at once.
  const scenes::WholeRun once = Column{kLoad, elastic_deck(loads)}.run();
  ASSERT_EQ(once.increments.size(), 1u);
  EXPECT_NEAR(settlement(once, 0), -20.0 / 1000.0, 1e-14);
}

TEST(StageCards, DisplacementsInEqualIncrements) {
  const std::string layout = R"toml([[card]]
name = "displacement"
format = "*"
fields = [{ name = "first", kind = "integer" }, { name = "last", kind = "integer" }, { name = "direction", kind = "integer" }]
[[card]]
name = "increments"
format = "*"
fields = [{ name = "increments", kind = "integer" }, { name = "displacement", kind = "real" }]
)toml";
  const scenes::WholeRun run = Column{layout, elastic_deck("5 6 2\n4 -0.01\n")}.run();
  ASSERT_EQ(run.increments.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const double moved = -0.01 * static_cast<double>(k + 1);
    EXPECT_NEAR(settlement(run, k), moved, 1e-15);
    EXPECT_NEAR(run.reaction(run.increments[k], {5, 6}, 1), 1000.0 * moved / 2.0, 1e-11);
  }
  ASSERT_EQ(run.model->reports.size(), 1u);
  EXPECT_EQ(run.model->reports[0].nodes.size(), 2u);
  EXPECT_NE(Column({layout, elastic_deck("5 6 3\n4 -0.01\n")}).complaint().find("direction 3"),
            std::string::npos);
}

constexpr const char* kStart = R"toml([[card]]
name = "start_stress"
format = "*"
fields = [{ name = "level", kind = "real" }]
)toml";

// sigma_y = 20 (2 - y), sigma_x = k0 sigma_y, and nothing moves: neither with both sides held nor with the right
// one free, where pressures stand for what was there.
TEST(StageCards, StartStressIsInEquilibrium) {
  const std::string free_right = "4\n1 1 1\n2 1 1\n3 1 0\n5 1 0\n";
  for (const std::string& held : {std::string(kHeld), free_right}) {
    const Column column{kStart, std::string(kMesh) + kElastic + kElements + held + "2.\n"};
    const scenes::WholeRun run = column.run();
    ASSERT_TRUE(run.completed());
    EXPECT_LT(run.largest_u(), 1e-15);
    EXPECT_NEAR(run.reaction(run.last(), {1, 2}, 1), 40.0, 1e-10);
    const std::size_t faces = run.model->stages[0].pressures.size();
    EXPECT_EQ(faces, held == free_right ? 2u : 0u);
    if (faces > 0) {
      // Both ends of the lower right edge: k0 x 20 x depth.
      EXPECT_NEAR(run.model->stages[0].pressures[0].normal[0], 20.0, 1e-12);
      EXPECT_NEAR(run.model->stages[0].pressures[0].normal[1], 10.0, 1e-12);
    }
    const double mean = run.stress[0].row(0).mean();
    EXPECT_NEAR(mean, -10.0, 1e-12) << "k0 x 20 x 1 at mid height, tension positive";
  }
}

// Squares of side 1 and layers of a material each, numbered from below, sides held in x: `columns` squares wide.
struct Ground {
  struct Layer {
    double unit_weight, k0;  // k0 < 0: left blank
  };
  std::vector<std::vector<int>> materials;  // of each row of squares, from below; a number a column
  std::vector<Layer> layers;
  std::string start = "";  // level and k0, columns 1-10 and 11-20

  std::string deck() const {
    const std::size_t columns = materials[0].size(), rows = materials.size();
    std::string text;
    const auto add = [&](const char* format, auto... values) {
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), format, values...);
      text += std::string(line.data()) + "\n";
    };
    add("%5zu%5zu%5zu%5zu", (columns + 1) * (rows + 1), layers.size(), columns * rows,
        2 * (rows + 1) + columns - 1);
    for (std::size_t i = 0; i <= rows; ++i)
      for (std::size_t k = 0; k <= columns; ++k)
        add("%10.1f%10.1f", static_cast<double>(k), static_cast<double>(i));
    for (const Layer& one : layers)
      if (one.k0 < 0.0)
        add("%10.1f", one.unit_weight);
      else
        add("%10.1f%10.2f", one.unit_weight, one.k0);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k) {
        const std::size_t n = 1 + k + (columns + 1) * i;
        add("%5d%5zu%5zu%5zu%5zu", materials[i][k], n, n + 1, n + columns + 2, n + columns + 1);
      }
    for (std::size_t i = 0; i <= rows; ++i)
      for (const std::size_t k : {std::size_t{0}, columns})
        add("%5zu%5d%5d", 1 + k + (columns + 1) * i, 1, i == 0 ? 1 : 0);
    for (std::size_t k = 1; k < columns; ++k) add("%5zu%5d%5d", 1 + k, 1, 1);
    return text + start + "\n";
  }
  std::string more_layout = "";  // behind the cards of the ground
  Deck read() const;
  Model model() const { return build_model(read(), full_catalogue()); }
  scenes::WholeRun run() const { return make_workbench().run(model()); }
  Diagnostics messages() const {
    try {
      return model().diagnostics;
    } catch (const InputError& error) {
      return error.diagnostics();
    }
  }
};

constexpr const char* kGround = R"toml(
name = "ground"
blanks = "null"
[[card]]
name = "control"
format = "(4I5)"
fields = [{ name = "total_nodes" }, { name = "soils" }, { name = "total_elements" }, { name = "held" }, { name = "geometry", kind = "integer", value = "1" }]
[[card]]
name = "node"
format = "(2F10.0)"
repeat = "control.total_nodes"
fields = [{ name = "number", kind = "integer", value = "order" }, { name = "x" }, { name = "y" }]
[[card]]
name = "soil"
format = "(2F10.0)"
repeat = "control.soils"
fields = [{ name = "weight" }, { name = "rest" }]
[[card]]
name = "material"
made_from = "soil"
opens = true
fields = [{ name = "number", kind = "integer", value = "order" }, { name = "law", kind = "integer", value = "1" }, { name = "unit_weight", value = "weight" }, { name = "k0", value = "rest" }]
[[card]]
name = "parameters"
made_from = "material"
fields = [{ name = "values", value = ["1e4", ".3"] }]
[[card]]
name = "group"
made_from = "soil"
fields = [{ name = "number", kind = "integer", value = "order" }, { name = "element", kind = "integer", value = "1" }, { name = "material", kind = "integer", value = "order" }]
[[card]]
name = "element"
format = "(5I5)"
repeat = "control.total_elements"
fields = [{ name = "number", kind = "integer", value = "order" }, { name = "group" }, { name = "n1" }, { name = "n2" }, { name = "n3" }, { name = "n4" }]
[[card]]
name = "fixity"
format = "(3I5)"
repeat = "control.held"
fields = [{ name = "first" }, { name = "x_code" }, { name = "y_code" }]
[[card]]
name = "start_stress"
format = "(2F10.0)"
fields = [{ name = "level" }, { name = "k0" }]
)toml";

Deck Ground::read() const {
  return read_deck_text(deck(), "ground.dat", load_layout_text(kGround + more_layout, "ground.toml"));
}

// Closed form: sigma_v = sum of unit weight x thickness above, sigma_h = K0 sigma_v.  Points of the last state.
void expect_stress_of_layers(const scenes::WholeRun& run,
                             const std::function<Vector2(double)>& vertical_and_k0) {
  const Model& model = *run.model;
  int points = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      for (int q = 0; q < 4; ++q, ++points) {
        const Vector2 expected = vertical_and_k0(group.element->position(x, q).y());
        const Eigen::Index p = 4 * e + q;
        EXPECT_NEAR(-run.stress[g](1, p), expected[0], 1e-11);
        EXPECT_NEAR(-run.stress[g](0, p), expected[0] * expected[1], 1e-11);
        EXPECT_NEAR(-run.stress[g](2, p), expected[0] * expected[1], 1e-11);
        EXPECT_NEAR(run.stress[g](3, p), 0.0, 1e-11);
      }
    }
  }
  EXPECT_GT(points, 0);
}

// Two below of weight 20, K0 .5, two above of weight 16, K0 .7: 32 + 20 (2 - y) below.  Nothing moves, and no force
// is out of balance by more than rounding.
TEST(StageCards, StartStressIsTheWeightOfTheLayersAbove) {
  const Ground ground{{{1, 1}, {1, 1}, {2, 2}, {2, 2}}, {{20.0, 0.5}, {16.0, 0.7}}};
  const scenes::WholeRun run = ground.run();
  ASSERT_TRUE(run.completed());
  EXPECT_LT(run.largest_u(), 1e-15);
  const InitialImbalance imbalance = initial_imbalance(*run.model);
  ASSERT_GE(imbalance.dof, 0);
  EXPECT_LE(std::abs(imbalance.force), 1e-14 * imbalance.largest);
  EXPECT_NEAR(run.reaction(run.last(), {1, 2, 3}, 1), 2.0 * (2 * 20.0 + 2 * 16.0), 1e-10);
  expect_stress_of_layers(run, [](double y) {
    return y > 2.0 ? Vector2(16.0 * (4.0 - y), 0.7) : Vector2(32.0 + 20.0 * (2.0 - y), 0.5);
  });
}

// A soil that lies above and below another, and a level above the top, whose layer reaches up to it.
TEST(StageCards, StartStressOfASoilInTwoLayers) {
  const Ground ground{{{1}, {2}, {1}}, {{20.0, 0.5}, {10.0, 0.4}}, "        4."};
  const scenes::WholeRun run = ground.run();
  ASSERT_TRUE(run.completed());
  EXPECT_LT(run.largest_u(), 1e-15);
  expect_stress_of_layers(run, [](double y) {
    if (y > 2.0) return Vector2(20.0 * (4.0 - y), 0.5);
    return y > 1.0 ? Vector2(40.0 + 10.0 * (2.0 - y), 0.4) : Vector2(50.0 + 20.0 * (1.0 - y), 0.5);
  });
  std::set<int> numbers;
  for (const Group& group : run.model->groups) numbers.insert(group.number);
  EXPECT_EQ(numbers.size(), 3u);
}

TEST(StageCards, StartStressThatCannotBeIsRefused) {
  const auto said = [](const Ground& ground, Severity severity, std::initializer_list<const char*> words) {
    const Diagnostics messages = ground.messages();
    for (const Diagnostic& d : messages.list()) {
      bool all = d.severity == severity;
      for (const char* word : words) all = all && d.message.find(word) != std::string::npos;
      if (all) return true;
    }
    for (const Diagnostic& d : messages.list()) ADD_FAILURE() << to_string(d);
    return false;
  };
  const std::vector<Ground::Layer> soils{{20.0, 0.5}, {16.0, 0.5}};
  // Element 3 (20) beside element 4 (16).
  EXPECT_TRUE(said({{{1, 1}, {1, 2}, {2, 2}}, soils}, Severity::error,
                   {"horizontal layers", "element 3 (20)", "element 4 (16)", "y = 1 and y = 2"}));
  EXPECT_TRUE(said({{{1}, {2}}, soils, "       1.5"}, Severity::error, {"level", "1.5", "node 5", "tension"}));
  EXPECT_TRUE(said({{{1}, {2}}, {{20.0, 0.5}, {16.0, -1.0}}}, Severity::error, {"material 2", "k0", "blank"}));
  // One weight, two coefficients side by side: a warning, and the run's first balance finds it.
  const Ground sides{{{1, 2}}, {{20.0, 0.5}, {20.0, 0.8}}};
  EXPECT_TRUE(said(sides, Severity::warning, {"not in balance", "element 1 (0.5)", "element 2 (0.8)"}));
  EXPECT_TRUE(initial_imbalance(sides.model()).counts());
  // K0 = 0 is a number; a card's own K0 stands for all.
  EXPECT_EQ((Ground{{{1}, {2}}, {{20.0, 0.0}, {16.0, 0.5}}}.messages().errors()), 0);
  EXPECT_EQ((Ground{{{1}, {2}}, {{20.0, 0.5}, {16.0, -1.0}}, "                  .6"}.messages().errors()), 0);
}

constexpr const char* kRemoval = R"toml([[card]]
name = "removal"
format = "*"
fields = [{ name = "elements", kind = "integer", count = "COUNT" }]
)toml";

// Sand in two layers with clay between; of a pair of columns the right elements of both sand layers are taken away by
// one card: the base carries the rest, 100 - 40.
TEST(StageCards, ElementsOfTwoLayersAreRemovedTogether) {
  std::string removal = kRemoval;
  removal.replace(removal.find("COUNT"), 5, "2");
  const Ground ground{{{1, 1}, {2, 2}, {1, 1}}, {{20.0, 0.5}, {10.0, 0.4}}, "\n2 6", removal};
  const scenes::WholeRun run = ground.run();
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.reaction(run.increments[0], {1, 2, 3}, 1), 100.0, 1e-10);
  EXPECT_NEAR(run.reaction(run.last(), {1, 2, 3}, 1), 60.0, 1e-10);
  EXPECT_EQ(run.model->stages.back().deaths.size(), 2u);
}

// The upper element of a group is taken away by its number: the base carries 20 less.
TEST(StageCards, ElementsAreRemovedByNumber) {
  const auto removal = [](const std::string& count) {
    std::string text = kRemoval;
    return text.replace(text.find("COUNT"), 5, count);
  };
  const std::string increments =
      "[[card]]\nname = \"increments\"\nformat = \"*\"\nfields = [{ name = \"increments\", kind = \"integer\" "
      "}]\n";
  const Column column{kStart + increments + removal("1"), elastic_deck("2.\n4\n8\n")};
  const scenes::WholeRun run = column.run();
  ASSERT_TRUE(run.completed());
  ASSERT_EQ(run.increments.size(), 5u);
  EXPECT_NEAR(run.reaction(run.increments[0], {1, 2}, 1), 40.0, 1e-10);
  EXPECT_NEAR(run.reaction(run.last(), {1, 2}, 1), 20.0, 1e-10);
  EXPECT_EQ(run.model->groups.size(), 2u);
  EXPECT_NE(run.model->groups[0].number, run.model->groups[1].number);
  // Node 3 rises by 20 x 1 / E.
  EXPECT_NEAR(run.last().u[2 * run.index(3) + 1], 20.0 / 1000.0, 1e-12);
  EXPECT_NE(
      Column({kStart + removal("1"), elastic_deck("2.\n9\n")}).complaint().find("element 9 is to be removed"),
      std::string::npos);
  EXPECT_NE(Column({kStart + removal("2"), elastic_deck("2.\n8 8\n")}).complaint().find("removed already"),
            std::string::npos);
}

constexpr const char* kStrength = R"toml([[card]]
name = "strength_factors"
format = "*"
fields = [{ name = "factors", kind = "real", count = "4" }]
)toml";

// phi = 0, free sides, p = 100 on top: stands to F = 2 c / p = 1.5; elastic before, u = p H (1 - nu^2) / E, and at
// F = 1.6 up to 2 c / 1.6 / p = .9375 of the load.
TEST(StageCards, StrengthFactorsAreAnalysesOfTheirOwn) {
  const std::string free_sides = "3\n1 1 1\n2 0 1\n3 0 0\n";
  const std::string deck = std::string(kMesh) + "4 0. .5\n1000. .3 75. 0. 0.\n" + kElements + free_sides;
  const std::string pressure = R"toml([[card]]
name = "pressure"
format = "*"
fields = [{ name = "element", kind = "integer" }, { name = "edge", kind = "integer" }, { name = "normal1", kind = "real" }, { name = "normal2", kind = "real" }]
)toml";
  const Column column{pressure + kStrength, deck + "8 3 100. 100.\n1. 1.25 1.4 1.6\n"};
  const Model model = column.model();
  EXPECT_EQ(model.stages.size(), 4u);
  EXPECT_EQ(model.groups.size(), 4u);
  EXPECT_DOUBLE_EQ(model.materials[3].parameters[2], 75.0 / 1.6);
  const std::filesystem::path folder = test::scratch_folder("stage_cards");
  std::ofstream(folder / "column.toml") << kLayout << column.layout;
  std::ofstream(folder / "column.dat") << column.deck;
  RunRequest request;
  request.deck = (folder / "column.dat").string();
  request.input.layout = (folder / "column.toml").string();
  request.quiet = true;
  request.output.folder = folder;
  const RunOutcome outcome = run_deck(request, full_catalogue());
  const std::vector<StrengthRow>& rows = outcome.record.strength.rows();
  ASSERT_EQ(rows.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[i].equilibrium, 1);
    EXPECT_NEAR(rows[i].largest, 100.0 * 2.0 * (1.0 - 0.09) / 1000.0, 1e-12) << i;
  }
  EXPECT_EQ(rows[3].equilibrium, 0);
  EXPECT_NEAR(rows[3].load_factor, 0.9375, 1e-3);
  const std::string table = strength_table(model, rows);
  for (const char* words : {"1.25", "found", "none above 0.93"})
    EXPECT_NE(table.find(words), std::string::npos) << table;
}

TEST(StageCards, FrictionIsReducedByItsTangent) {
  const std::string deck = std::string(kMesh) + "4 20. .5\n1000. .3 10. 30. 15.\n" + kElements + kHeld;
  const std::string gravity =
      "[[card]]\nname = \"gravity\"\nmade = true\nfields = [{ name = \"gravity_y\", value = \"-1\" }]\n";
  const Model model = Column{gravity + kStrength, deck + "1. 1.25 1.4 1.6\n"}.model();
  EXPECT_DOUBLE_EQ(model.materials[0].parameters[3], 30.0);
  EXPECT_NEAR(std::tan(model.materials[2].parameters[3] * M_PI / 180.0), std::tan(M_PI / 6.0) / 1.4, 1e-15);
  EXPECT_NEAR(std::tan(model.materials[2].parameters[4] * M_PI / 180.0), std::tan(M_PI / 12.0) / 1.4, 1e-15);
  EXPECT_NEAR(model.materials[2].parameters[2], 10.0 / 1.4, 1e-15);
  // They have no meaning behind start stress.
  EXPECT_NE(
      Column({kStart + std::string(kStrength), deck + "2.\n1. 1.25 1.4 1.6\n"}).complaint().find("one step"),
      std::string::npos);
}

// One element between (0, 0), (2, 0), (3, 2), (0, 2), nodes 1 to 4, and mid-side nodes 5 to 8 where it is quadratic; a
// second one, 2-5-6-3, on its right side where `neighbour` is set.
struct EdgeCase {
  bool quadratic = false, neighbour = false;
  std::string edge;   // n1, n2, n3, element, then three pressures and three shears
  std::string sense;  // of the layout's edge_load card; empty: absent
  Model model() const {
    std::string text = neighbour ? "6 2\n" : quadratic ? "8 1\n" : "4 1\n";
    text += "0. 0.\n2. 0.\n3. 2.\n0. 2.\n";
    if (quadratic) text += "1. 0.\n2.5 1.\n1.5 2.\n0. 1.\n";
    if (neighbour) text += "5. 0.\n5. 2.\n";
    text += quadratic ? "1 2 3 4 5 6 7 8\n" : "1 2 3 4 0 0 0 0\n";
    if (neighbour) text += "2 5 6 3 0 0 0 0\n";
    text += edge + "\n";
    const auto field = [&](const std::string& name) {
      return "{ name = \"" + name + "\", kind = \"integer\" }, ";
    };
    const auto real = [&](const std::string& name) { return "{ name = \"" + name + "\", kind = \"real\" }, "; };
    const auto fixed = [](const std::string& name, const std::string& value) {
      return "{ name = \"" + name + "\", kind = \"integer\", value = \"" + value + "\" }, ";
    };
    const auto card = [](const std::string& name, const std::string& keys, const std::string& fields) {
      return "[[card]]\nname = \"" + name + "\"\n" + keys + "\nfields = [" + fields + "]\n";
    };
    const std::string list = "format = \"*\"\n", made = "made = true\n";
    const std::string layout =
        "name = \"edges\"\n" +
        card("control", list, field("nodes") + field("elements") + fixed("geometry", "1")) +
        card("node", list + "repeat = \"control.nodes\"", fixed("number", "order") + real("x") + real("y")) +
        card("material", made + "opens = true",
             fixed("number", "1") + fixed("law", "1") + fixed("unit_weight", "0")) +
        card("parameters", made, "{ name = \"values\", value = [\"1e4\", \".3\"] }") +
        card("group", made,
             fixed("number", "1") + fixed("element", quadratic ? "2" : "1") + fixed("material", "1")) +
        card("element", list + "repeat = \"control.elements\"",
             fixed("number", "order") + field("n1") + field("n2") + field("n3") + field("n4") + field("n5") +
                 field("n6") + field("n7") + field("n8")) +
        card("fixity", made, fixed("first", "1") + fixed("x_code", "1") + fixed("y_code", "1")) +
        card("fixity4", made + "as = \"fixity\"",
             fixed("first", "4") + fixed("x_code", "1") + fixed("y_code", "1")) +
        card("edge_load", list,
             field("n1") + field("n2") + field("n3") + field("element") + real("normal1") + real("normal2") +
                 real("normal3") + real("shear1") + real("shear2") + real("shear3") +
                 (sense.empty() ? "" : fixed("sense", sense)));
    return build_model(read_deck_text(text, "edge.dat", load_layout_text(layout, "edges.toml")),
                       full_catalogue());
  }
  // Force along x and y and moment about the origin, counter-clockwise.
  Eigen::Vector3d resultant() const {
    const Model m = model();
    const Eigen::VectorXd force = external_force(m, 0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int node = 0; node < m.mesh.nodes(); ++node) {
      const Vector2 f = force.segment<2>(2 * node), x = m.mesh.x.col(node);
      sum += Eigen::Vector3d(f.x(), f.y(), x.x() * f.y() - x.y() * f.x());
    }
    return sum;
  }
  std::string complaint() const {
    return first_error([this] { model(); });
  }
};

// Of a pressure p and a shear q with the values a, m, b at the ends and in the middle of the straight edge from A to B
// (parabolic between them): force integral (p n + q t) ds, by Simpson's rule, which is exact for it and for the moment.
// n: to the left of the way from A to B.
Eigen::Vector3d closed_form(const Vector2& from, const Vector2& to, const Eigen::Vector3d& p,
                            const Eigen::Vector3d& q) {
  const Vector2 along = to - from, left(-along.y(), along.x());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector2 x = from + 0.5 * i * along, f = (i == 1 ? 4.0 : 1.0) / 6.0 * (p[i] * left + q[i] * along);
    sum += Eigen::Vector3d(f.x(), f.y(), x.x() * f.y() - x.y() * f.x());
  }
  return sum;
}

// Counter-clockwise around the element its right edge runs from node 2 to node 3, the body on the left.  Either order of
// nodes, two or three of them, gives pressure x length into the body, and shear along the order of the card.
TEST(StageCards, EdgeLoadsInEitherOrder) {
  const Vector2 two(2.0, 0.0), three(3.0, 2.0);
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).cwiseAbs().maxCoeff() < 1e-13 * b.cwiseAbs().maxCoeff();
  };
  // p = 5: 5 sqrt(5) long along (-2, 1) / sqrt(5).
  const Eigen::Vector3d uniform = EdgeCase{false, false, "3 2 0 0 5. 5. 0. 0. 0. 0.", "3"}.resultant();
  EXPECT_LT((uniform.head<2>() - Vector2(-10.0, 5.0)).norm(), 1e-13);
  const Eigen::Vector3d linear(3.0, 5.0, 7.0), shear(2.0, 1.0, 0.0), bulging(3.0, 8.0, 7.0);
  const std::string ends = " 0 0 3. 7. 0. 2. 0. 0.", all = " 0 3. 8. 7. 2. 1. 0.";
  struct Row {
    bool quadratic;
    const char* nodes;
    Eigen::Vector3d p;
    std::string values;
    bool clockwise;
  };
  for (const Row& row : {Row{false, "2 3", linear, ends, false}, Row{false, "3 2", linear, ends, true},
                         Row{true, "2 6 3", bulging, all, false}, Row{true, "3 6 2", bulging, all, true}}) {
    const Vector2 from = row.clockwise ? three : two, to = row.clockwise ? two : three;
    const auto load = [&](const char* sense) {
      return EdgeCase{row.quadratic, false, row.nodes + row.values, sense};
    };
    // Into the body: to the right of a clockwise way.  Sense 4: always to the left of it.
    const Eigen::Vector3d into = closed_form(from, to, row.clockwise ? Eigen::Vector3d(-row.p) : row.p, shear);
    EXPECT_TRUE(near(load("3").resultant(), into)) << row.nodes;
    EXPECT_TRUE(near(load("4").resultant(), closed_form(from, to, row.p, shear))) << row.nodes;
    for (const char* sense : {"", "1", "2"}) {
      const bool allowed = row.clockwise == (std::string(sense) == "2");
      if (allowed) {
        EXPECT_TRUE(near(load(sense).resultant(), into)) << row.nodes;
        continue;
      }
      const std::string message = load(sense).complaint();
      for (const std::string word :
           {row.clockwise ? "run clockwise around element 1" : "run counter-clockwise around",
            row.quadratic ? (row.clockwise ? "edge 3-6-2" : "edge 2-6-3")
                          : (row.clockwise ? "edge 3-2" : "edge 2-3"),
            "sense"})
        EXPECT_NE(message.find(word), std::string::npos) << message;
    }
  }
}

// Edge 2-3 lies between elements 1 and 2: what pushes into one pulls at the other.
TEST(StageCards, EdgeLoadsBetweenElements) {
  const auto force = [](const std::string& edge, const char* sense) {
    return Vector2(EdgeCase{false, true, edge + " 5. 5. 0. 0. 0. 0.", sense}.resultant().head<2>());
  };
  for (const char* nodes : {"2 3 0", "3 2 0"}) {
    EXPECT_LT((force(nodes + std::string(" 1"), "3") - Vector2(-10.0, 5.0)).norm(), 1e-13);
    EXPECT_LT((force(nodes + std::string(" 2"), "3") - Vector2(10.0, -5.0)).norm(), 1e-13);
  }
  EXPECT_LT((force("2 3 0 0", "4") - Vector2(-10.0, 5.0)).norm(), 1e-13);
  EXPECT_LT((force("2 3 0 2", "4") - Vector2(-10.0, 5.0)).norm(), 1e-13);
  EXPECT_LT((force("3 2 0 0", "4") - Vector2(10.0, -5.0)).norm(), 1e-13);
  const auto complaint = [](const std::string& edge, const char* sense) {
    return EdgeCase{false, true, edge + " 5. 5. 0. 0. 0. 0.", sense}.complaint();
  };
  EXPECT_NE(complaint("3 2 0 0", "3").find("lies between elements 2 and 1"), std::string::npos);
  EXPECT_NE(complaint("3 2 0 1", "1").find("run clockwise around element 1"), std::string::npos);
  EXPECT_NE(complaint("1 2 0 2", "3").find("belongs to element 1, not 2"), std::string::npos);
  EXPECT_NE(complaint("2 3 0 1", "5").find("sense 5"), std::string::npos);
}

}  // namespace
}  // namespace sage::app
