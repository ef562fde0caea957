// Models of legacy_inputs/models that draw what decks of legacy_inputs give node by node.  Right values are those of the decks
// on their own mesh and on the one with halved elements; a drawn mesh lies between or beyond them, and the tolerance is
// the difference of the two meshes, or 2 % where that is less.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/record/extremes.hpp"
#include "sage/safety/safety.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

const scenes::Workbench& drawing_bench() {
  static const scenes::Workbench bench = app::make_workbench();
  return bench;
}

std::string text_of(const std::string& name) {
  std::ifstream file(std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/models/" + name + ".sage.toml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Model drawn_model(const std::string& name) {
  return build_model(read_model_file_text(text_of(name), name + ".sage.toml"), drawing_bench().catalogue());
}

class StageExtremes final : public Observer {
 public:
  void on_stage_end(const Model& model, int stage, const EquilibriumAudit&, const Solution& solution) override {
    for (const ExtremeRow& row : extremes(model, stage, solution)) rows.push_back(row);
  }
  std::vector<ExtremeRow> rows;
};

// Largest amount of a force or moment of a structure in a stage, from 1; 0 = in all.
struct Expected {
  const char *group, *quantity;
  int stage;
  double deck, halved;
};

void expect_extremes(const std::string& name, std::initializer_list<Expected> all) {
  const std::string text = text_of(name);
  EXPECT_LE(std::ranges::count(text, '\n'), 60) << name;
  const Model model = drawn_model(name);
  StageExtremes found;
  Observer* observers[] = {&found};
  const RunResult result = drawing_bench().run(model, observers);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  const FieldList fields = structure_forces(model);
  for (const Expected& one : all) {
    double largest = 0.0;
    for (const ExtremeRow& row : found.rows)
      if (model.groups[row.group].name == one.group && fields[row.field]->name == one.quantity &&
          (one.stage == 0 || row.stage + 1 == one.stage))
        largest = std::max({largest, std::abs(row.low), std::abs(row.high)});
    const double tolerance = std::max(std::abs(one.deck - one.halved), 0.02 * one.halved);
    EXPECT_NEAR(largest, one.halved, tolerance) << name << ": " << one.group << " " << one.quantity;
  }
}

TEST(DrawnModel, Raft) {
  expect_extremes("raft",
                  {{"raft", "bending_moment", 1, 6.0411, 5.9389}, {"raft", "axial_force", 1, 8.6204, 8.6166}});
}

TEST(DrawnModel, Tank) {
  expect_extremes("tank",
                  {{"wall", "hoop_force", 1, 228.42, 229.07}, {"wall", "bending_moment", 1, 19.281, 18.389}});
}

TEST(DrawnModel, SheetPile) {
  expect_extremes("sheet_pile", {{"wall", "bending_moment", 4, 36.743, 40.05}});
}

TEST(DrawnModel, BracedCut) {
  expect_extremes("braced_cut", {{"wall", "bending_moment", 5, 42.406, 43.067},
                                 {"strut 1", "force_each", 3, 63.204, 62.083},
                                 {"strut 1", "force_each", 5, 112.15, 112.82},
                                 {"strut 3", "force_each", 4, 101.49, 103.44},
                                 {"slab", "force_each", 5, 30.816, 31.99}});
}

// Of a bonded pipe the deck, whose elements are straight, has the thrust; its moment does not converge.
TEST(DrawnModel, Culvert) {
  expect_extremes("culvert",
                  {{"pipe", "axial_force", 5, 200.67, 200.59}, {"pipe", "axial_force", 1, 43.29, 42.366}});
}

// The deck's bracket is 1.36953 to 1.37656, the log-spiral through the toe 1.36482.
TEST(DrawnModel, Slope) {
  Model model = drawn_model("slope");
  safety::Options options;
  options.limits = {.start = 1.36482 * 0.99, .tolerance = 0.04, .largest = 1.36482 * 1.02};
  const safety::Safety found =
      safety::find_safety(model, drawing_bench().catalogue(), drawing_bench().settings(), options);
  ASSERT_TRUE(found.complete()) << found.incomplete;
  EXPECT_GE(*found.lower, 0.99 * 1.36482);
  EXPECT_LE(*found.upper, 1.02 * 1.36482 * (1.0 + 1e-9));
}

}  // namespace
}  // namespace sage::test
