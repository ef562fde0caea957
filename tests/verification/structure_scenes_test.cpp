// The decks of legacy_inputs/structures are the scenes that `sagefe verify` checks.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/studies/scenes/soil_structure.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;
using namespace sage::scenes;

std::string shipped(const std::string& name) {
  std::ifstream file(fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/structures" / name / "deck.dat");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// With SAGE_WRITE_DECKS set it writes them instead.
TEST(StructureDecks, AreTheScenes) {
  for (const ShippedDeck& deck : structure_decks()) {
    const fs::path folder = fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/structures" / deck.name;
    if (std::getenv("SAGE_WRITE_DECKS") != nullptr) {
      fs::create_directories(folder);
      std::ofstream(folder / "deck.dat") << deck.text();
    }
    EXPECT_TRUE(shipped(deck.name) == deck.text()) << deck.name;
  }
}

// Interfaces of two pairs around a pipe: a warning where they let it slip, none where they bond it or have nodes on the curve.
TEST(StructureDecks, ASmoothPipeOfChordsIsNamed) {
  const std::string words = "interface set 3 follows a curve", stiffness = "10000000. 10000000.";
  std::string text = shipped("culvert_bonded");
  EXPECT_FALSE(run_text(text).warns(words));
  const std::size_t at = text.find(stiffness);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 9, "    0.001");
  EXPECT_TRUE(run_text(text).warns(words));
  EXPECT_FALSE(run_text(shipped("culvert_slipping")).warns(words));
}

struct WallNumbers {
  std::string name;
  WallInGround scene;
  double outside, inside, struts, moment;
};

class ShippedWall : public testing::TestWithParam<WallNumbers> {};

// It stands between earth and struts, and carries what the README says; tolerance: its last digit, since soil that yields
// leaves no closed form.
TEST_P(ShippedWall, IsInBalance) {
  const WallNumbers& e = GetParam();
  const WholeRun run = run_text(shipped(e.name));
  ASSERT_TRUE(run.completed()) << run.failure;
  const WallForces f = wall_forces(e.scene, run);
  EXPECT_NEAR(f.balance(), 0.0, 1e-6 * e.outside);
  EXPECT_NEAR(-f.outside.x(), e.outside, 0.06);
  EXPECT_NEAR(f.inside.x(), e.inside, 0.06);
  EXPECT_NEAR(f.struts, e.struts, 0.06);
  EXPECT_NEAR(f.largest_moment, e.moment, 0.06);
}

INSTANTIATE_TEST_SUITE_P(
    Structures, ShippedWall,
    testing::Values(WallNumbers{"braced_cut", braced_excavation(1), 322.8, 275.2, 47.7, 42.4},
                    WallNumbers{"braced_shaft", braced_excavation(2), 283.1, 263.6, 19.5, 31.4},
                    WallNumbers{"sheet_pile", cantilever_sheet_pile(), 227.5, 227.5, 0.0, 36.7},
                    WallNumbers{"anchored_sheet_pile", anchored_sheet_pile(), 321.0, 240.8, 80.2, 41.5}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace sage::test
