// sagefe safety as a user meets it: what it prints and writes, and what it refuses.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/regression/program.hpp"
#include "tests/support/sanitized.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

// c = 10, phi = 0 under 30 where 2 c = 20 is the limit: F = 2/3.
TEST(SafetyCommand, SaysBothEndsAndWhy) {
  const fs::path folder = empty_folder("safety");
  write(folder / "weak.dat", collapse_deck().text());
  const Finished run = sagefe(folder, "safety weak.dat --tolerance 1e-3 -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(has(run.out, "safety factor between 0.666")) << run.out;
  EXPECT_TRUE(has(run.out, "lower end") && has(run.out, "equilibrium to")) << run.out;
  EXPECT_TRUE(has(run.out, "upper end") && has(run.out, "no equilibrium")) << run.out;
  for (const char* ending : {".safety.lst", ".safety.csv", ".safety.svg", ".mechanism.svg"})
    EXPECT_TRUE(fs::exists(folder / "out" / (std::string("weak") + ending))) << ending;
  EXPECT_TRUE(has(read(folder / "out/weak.safety.csv"), "factor,from,verdict,displacement"));
  EXPECT_TRUE(has(read(folder / "out/weak.safety.lst"), "safety factor between 0.666"));
}

// The picture is drawn when all trials are over: the states that it shows refer to laws of their own trial.  With this
// tolerance the trial of the picture is not the last one.
TEST(SafetyCommand, DrawsAMechanismWithDividedJoints) {
  const fs::path folder = empty_folder("safety_joints");
  const Finished run = sagefe(folder, "safety " SAGE_SOURCE_DIR
                                      "/legacy_inputs/structures/sheet_pile/deck.dat"
                                      " --reduce soil,joints -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(has(read(folder / "out/sheet_pile.mechanism.svg"), "</svg>"));
}

TEST(SafetyCommand, ProfileHasTheWorkOfEveryTrial) {
  const fs::path folder = empty_folder("safety_profile");
  write(folder / "weak.dat", collapse_deck().text());
  const Finished run = sagefe(folder, "safety weak.dat --tolerance 1e-2 --profile --json -o out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out)["result"];
  // One run holds all trials: iterations of each, and a factorisation in every iteration at least.
  const auto& analysis = result["phases"]["phases"][0];
  EXPECT_EQ(analysis["phase"], "analysis");
  long iterations = 0;
  for (const auto& trial : result["trials"]) iterations += trial["iterations"].get<long>();
  long solutions = 0;
  const std::function<void(const nlohmann::json&)> count = [&](const nlohmann::json& phase) {
    if (phase["phase"] == "solution") solutions += phase["calls"].get<long>();
    if (phase.contains("phases"))
      for (const auto& part : phase["phases"]) count(part);
  };
  count(result["phases"]);
  EXPECT_GT(iterations, 0);
  EXPECT_GE(solutions, iterations);
}

TEST(SafetyCommand, NoBracketIsExitCodeThree) {
  const fs::path folder = empty_folder("safety_none");
  write(folder / "weak.dat", collapse_deck().text());
  const Finished low = sagefe(folder, "safety weak.dat --smallest .9");
  EXPECT_EQ(low.exit_code, 3);
  EXPECT_TRUE(has(low.err, "no equilibrium even at F = 0.9") && has(low.err, "[S515]")) << low.err;
  EXPECT_TRUE(has(low.out, "safety factor below 0.9") && has(low.out, "NOT PROVED")) << low.out;
  const Finished high = sagefe(folder, "safety weak.dat --start .3 --largest .5");
  EXPECT_EQ(high.exit_code, 3);
  EXPECT_TRUE(has(high.err, "still in equilibrium at F = 0.5")) << high.err;
  EXPECT_TRUE(has(high.out, "safety factor above 0.5")) << high.out;
}

TEST(SafetyCommand, RefusesWhatItCantDo) {
  const fs::path folder = empty_folder("safety_refused");
  write(folder / "elastic.dat", block_deck().text());
  write(folder / "weak.dat", collapse_deck().text());
  const Finished elastic = sagefe(folder, "safety elastic.dat");
  EXPECT_EQ(elastic.exit_code, 2);
  EXPECT_TRUE(has(elastic.err, "no chosen group has a law with strength") && has(elastic.err, "[S260]"))
      << elastic.err;
  for (const char* options : {"--stage 7", "--group 9"}) {
    const Finished run = sagefe(folder, std::string("safety weak.dat ") + options);
    EXPECT_EQ(run.exit_code, 2) << options;
    EXPECT_TRUE(has(run.err, "[S260]")) << run.err;
  }
  for (const char* options :
       {"--tolerance 0", "--tolerance -1", "--tolerance nan", "--start -2", "--largest 0", "--dilation some",
        "--from nowhere", "--iterations 0", "--cuts -1", "--stage 0", "--converge 2", "--group x"})
    EXPECT_EQ(sagefe(folder, std::string("safety weak.dat ") + options).exit_code, 1) << options;
  EXPECT_EQ(sagefe(folder, "safety none.dat").exit_code, 2);
}

TEST(SafetyCommand, ConvergeSaysTheEffectOfTheMesh) {
  const fs::path folder = empty_folder("safety_converge");
  write(folder / "weak.dat", collapse_deck().text());
  const Finished run = sagefe(folder, "safety weak.dat --converge .01");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(has(run.out, "mesh effect") && has(run.out, "--refine 1") && has(run.out, "+0 %")) << run.out;
  const Finished small = sagefe(folder, "safety weak.dat --converge .01 --max-dofs 10");
  EXPECT_EQ(small.exit_code, 3);
  EXPECT_TRUE(has(small.out, "NOT REACHED: the next mesh has")) << small.out;
}

// On finer meshes than their own: joints that all slip in one iterate leave a singular matrix there, and cohesion that
// went at once where a joint opens would leave no equilibrium.  All other decks: scripts/check_refined.
TEST(RefinedStructures, EndAsOnTheirOwnMeshes) {
  const fs::path folder = empty_folder("refined");
  int decks = 0;
  for (const auto& entry : fs::directory_iterator(SAGE_SOURCE_DIR "/legacy_inputs/structures")) {
    if (!entry.is_directory()) continue;
    ++decks;
    for (int refine = 0; refine <= (test::kSanitized ? 1 : 2); ++refine) {
      const Finished run = sagefe(folder, "run " + (entry.path() / "deck.dat").string() +
                                              " -q -o out --refine " + std::to_string(refine));
      EXPECT_EQ(run.exit_code, 0) << entry.path() << " --refine " << refine << ": " << run.err;
    }
  }
  EXPECT_GE(decks, 9);
}

}  // namespace
}  // namespace sage::test
