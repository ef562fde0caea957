// Cards that a deck of any layout may have in place of stages.  Expected values: closed forms for a column of
// squares, 1 wide, nu = 0.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/summary.hpp"
#include "sage/scenes/whole_run.hpp"
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

struct Column {
  std::string layout, deck;
  Model model() const {
    return build_model(read_deck_text(deck, "column.dat", load_layout_text(kLayout + layout, "column.toml")),
                       full_catalogue());
  }
  scenes::WholeRun run() const { return make_workbench().run(model()); }
  std::string complaint() const {
    try {
      model();
    } catch (const InputError& error) {
      return error.diagnostics().list().front().message;
    }
    return "";
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

constexpr const char* kRemoval = R"toml([[card]]
name = "removal"
format = "*"
fields = [{ name = "elements", kind = "integer", count = "COUNT" }]
)toml";

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

}  // namespace
}  // namespace sage::app
