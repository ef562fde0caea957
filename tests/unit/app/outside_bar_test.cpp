// A structure that the program does not know, the two-node bar of tests/install/consumer/bar.hpp, through run, CSV,
// listing, VTU, result file, pictures, refinement, conversion and restart.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "tests/install/consumer/bar.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/two_bars.hpp"

namespace sage {
namespace {

namespace fs = std::filesystem;
using scenes::DeckWriter;
using scenes::WholeRun;

constexpr int kBar = 50, kRod = 80;
#ifdef SAGE_WITH_RESULT_FILES
constexpr bool kResultFiles = true;
#else
constexpr bool kResultFiles = false;
#endif

Catalogue with_bar() {
  Catalogue catalogue = app::full_catalogue();
  catalogue.elements.add(kBar, own::bar2());
  catalogue.materials.add(kRod, own::rod());
  return catalogue;
}

scenes::Workbench bench() {
  return {with_bar(), [](const SystemSize&) { return 1; }};
}

DeckWriter truss() {
  return test::two_bars(kBar, kRod);
}

// Statics: N = P / (2 cos a), pulled; the node sinks by N L / (E A cos a), cos a = 4/5, L = 5.
TEST(OutsideBar, ATrussHasTheForcesOfStatics) {
  DeckWriter deck = truss();
  deck.stage(2).load(3, 0.0, -16.0);
  const WholeRun run = bench().run(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  const double N = 16.0 / 1.6;
  EXPECT_NEAR(run.u(3).y(), -N * 5.0 / (200.0 * 0.8), 1e-12);
  EXPECT_NEAR(run.u(3).x(), 0.0, 1e-14);
  for (int bar = 0; bar < 2; ++bar) EXPECT_NEAR(run.stress[0](0, bar), N, 1e-12);
  EXPECT_NEAR(run.reaction(1).y(), 8.0, 1e-12);
}

// A bar has one component of stress: a second value on its initial card is one that was meant for another group.
TEST(OutsideBar, ValuesThatABarHasNoUseForAreNoted) {
  const auto notes_of = [](const std::string& card) {
    DeckWriter deck = truss();
    deck.initials.push_back(card);
    deck.stage().load(3, 0.0, -16.0);
    const WholeRun run = bench().run(deck.text());
    std::string notes;
    for (const Diagnostic& d : run.model->diagnostics.list()) notes += d.message + "\n";
    return notes;
  };
  EXPECT_EQ(notes_of("    1    0      -10.").find("not used"), std::string::npos);
  EXPECT_NE(
      notes_of("    1    0      -10.       5.                 7.")
          .find("not used of this initial stress card: value 2, value 4; own_bar2 has 1 component of stress"),
      std::string::npos);
}

TEST(OutsideBar, ANegativeRadiusIsRefused) {
  DeckWriter deck = truss();
  deck.geometry = 2;
  deck.stage().load(3, 0.0, -16.0);
  try {
    bench().run(deck.text());
    ADD_FAILURE() << "a bar at r = -3 was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("negative radius"), std::string::npos) << error.what();
  }
}

// A prestress of 10 in both bars balances a load of 16 from the start: nothing moves (kind 0, compression +).
TEST(OutsideBar, AnInitialForceIsThere) {
  DeckWriter deck = truss();
  deck.initials.push_back("    1    0      -10.");
  deck.stage().load(3, 0.0, -16.0);
  const WholeRun run = bench().run(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(run.u(3).norm(), 0.0, 1e-14);
  EXPECT_NEAR(run.stress[0](0, 1), 10.0, 1e-12);
}

TEST(OutsideBar, WhatDoesNotFitIsRefusedByName) {
  const auto message = [](const DeckWriter& deck) -> std::string {
    try {
      bench().build(deck.text());
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  DeckWriter geostatic = truss();
  geostatic.initials.push_back("    1    1        4.       20.        .5");
  geostatic.stage();
  EXPECT_NE(message(geostatic).find("kind 1 (geostatic) is for solids"), std::string::npos)
      << message(geostatic);
  DeckWriter wrong_law = truss();
  wrong_law.materials.clear();
  wrong_law.material(1, 1, {1000.0, 0.2});
  wrong_law.stage();
  EXPECT_NE(message(wrong_law).find(
                "own_bar2 needs a law for structures of 1 component, material 1 is linear_elastic"),
            std::string::npos)
      << message(wrong_law);
  DeckWriter pressed = truss();
  pressed.stage().pressure(1, 1, 1.0, 1.0);
  EXPECT_NE(message(pressed).find("(own_bar2 one point) has no edges"), std::string::npos) << message(pressed);
}

// Two blocks 1 x 1 (E = 1000, nu = 0) with two props of length 2 and EA = 200 between them, the left one held at
// x = 0, the right one pushed at x = 4 by 8: each prop carries 4, the end moves by 8/1000 + 4 * 2/200 + 8/1000.
DeckWriter props(int law, std::vector<double> parameters) {
  DeckWriter deck(1);
  const double x[] = {0.0, 1.0, 3.0, 4.0};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) deck.node(2 * i + j + 1, x[i], j);
  deck.material(1, law, parameters);
  deck.material(2, kRod, {1000.0, 0.2});
  deck.group(1, 1, 0, 1);
  deck.group(2, kBar, 0, 2);
  deck.element(1, 1, {1, 3, 4, 2});
  deck.element(2, 1, {5, 7, 8, 6});
  deck.element(3, 2, {3, 5});
  deck.element(4, 2, {4, 6});
  for (const int node : {1, 2}) deck.fix(node, 1, 0);
  for (const int node : {1, 3, 5, 7}) deck.fix(node, 0, 1);
  for (const int increments : {3, 2}) deck.stage(increments).pressure(2, 2, 4.0, 4.0);
  return deck;
}

// A cone with much strength is never reached: the groups beside the bars are then no constant region.
const std::vector<double> kElastic{1000.0, 0.0}, kStrong{1000.0, 0.0, 1e5, 0.0, 0.0};
constexpr double kEnd = -(8.0 / 1000.0 + 4.0 * 2.0 / 200.0 + 8.0 / 1000.0);

TEST(OutsideBar, PropsBetweenBlocksShareTheLoad) {
  for (const auto& [law, parameters] : {std::pair{1, kElastic}, {3, kStrong}})
    for (const bool skip : {true, false}) {
      SCOPED_TRACE(law);
      RunSettings settings;
      settings.skips.elements = settings.skips.states = settings.skips.condensation = skip;
      const WholeRun run = bench().run(props(law, parameters).text(), {}, settings);
      ASSERT_TRUE(run.completed()) << run.failure;
      for (const int node : {7, 8}) EXPECT_NEAR(run.u(node).x(), kEnd, 1e-10);
      for (int bar = 0; bar < 2; ++bar) EXPECT_NEAR(run.stress[1](0, bar), -4.0, 1e-9);
    }
}

// Finer solids: a prop keeps its nodes, and the answer, which is linear, stays.
TEST(OutsideBar, StaysWholeInARefinedMesh) {
  BuildOptions options;
  options.refine = 2;
  const WholeRun run = bench().run(props(1, kElastic).text(), options);
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_EQ(run.model->groups[0].elements(), 32);
  EXPECT_EQ(run.model->groups[1].elements(), 2);
}

TEST(OutsideBar, ARestartEndsWhereTheWholeRunDoes) {
  for (const auto& [law, parameters] : {std::pair{1, kElastic}, {3, kStrong}}) {
    const std::string deck = props(law, parameters).text();
    std::vector<std::string> checkpoints;
    RunSettings settings;
    settings.checkpoint_due = [] { return true; };
    settings.save_checkpoint = [&](const std::string& bytes) { checkpoints.push_back(bytes); };
    const WholeRun whole = bench().run(deck, {}, settings);
    ASSERT_EQ(checkpoints.size(), 4u);
    for (const std::string& bytes : checkpoints) {
      RunSettings again;
      again.resume_from = bytes;
      const WholeRun resumed = bench().run(deck, {}, again);
      ASSERT_TRUE(resumed.completed());
      EXPECT_TRUE(resumed.last().u == whole.last().u);
      EXPECT_TRUE(resumed.stress[1] == whole.stress[1]);
    }
  }
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> rows_of(const std::string& csv) {
  std::vector<std::string> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with('#')) rows.push_back(line);
  return rows;
}

app::RunOutcome run_with_all_outputs(const std::string& name, const DeckWriter& deck) {
  const fs::path folder = test::scratch_folder("outside_bar");
  std::ofstream(folder / (name + ".dat")) << deck.text();
  app::RunRequest request;
  request.deck = (folder / (name + ".dat")).string();
  request.quiet = true;
  request.output.folder = folder;
  request.output.points = request.output.nodes = request.output.vtu = true;
  request.output.result = kResultFiles;
  request.output.tables = Tables::all;
  request.output.pictures = {"stress_xx"};
  return app::run_deck(request, with_bar());
}

TEST(OutsideBar, IsInEveryOutput) {
  const app::RunOutcome outcome = run_with_all_outputs("props", props(1, kElastic));
  ASSERT_EQ(outcome.exit_code, app::kOk);
  const auto file_like = [&](const std::string& end) {
    for (const fs::path& file : outcome.files)
      if (file.string().ends_with(end)) return contents(file);
    ADD_FAILURE() << "no file *" << end;
    return std::string();
  };
  const std::vector<std::string> rows = rows_of(file_like(".structures.csv"));
  ASSERT_GE(rows.size(), 3u);
  EXPECT_EQ(
      rows[0],
      "stage,increment,group,element,point,x[m],y[m],axial_force[kN],axial_strain[-],stress_level[-],status")
      << rows[0];
  EXPECT_EQ(rows.back(), "2,2,2,4,1,2,1,4,0.02,0,elastic");  // 4 on EA = 200
  for (const std::string& row : rows_of(file_like(".points.csv")))
    EXPECT_EQ(row.find(",2,3,1,"), std::string::npos) << row;
  EXPECT_NE(file_like("_0001.vtu").find("Name=\"axial_force\""), std::string::npos);
  if (kResultFiles) {
    EXPECT_NE(file_like(".h5").find("axial_force"), std::string::npos);
  }
  EXPECT_NE(file_like(".lst").find("Structure of group 2"), std::string::npos);
  EXPECT_NE(file_like(".lst").find("axial_force [kN]"), std::string::npos);
  EXPECT_NE(file_like(".svg").find("#1f4e9c"), std::string::npos) << "the bars are drawn";
}

// Without any solid, too: nothing has a stress to draw, the truss is drawn all the same.
TEST(OutsideBar, ATrussAloneHasAllOutputs) {
  DeckWriter deck = truss();
  deck.stage().load(3, 0.0, -16.0);
  EXPECT_EQ(run_with_all_outputs("truss", deck).exit_code, app::kOk);
}

TEST(OutsideBar, InpLeavesItOutWithAWarningAndMshHoldsItsLine) {
  Model model = bench().build(props(1, kElastic).text());
  const auto left_out = [](const Diagnostics& diagnostics) {
    return std::ranges::any_of(diagnostics.list(), [](const Diagnostic& d) {
      return d.message.find("2 own_bar2 one point element(s) left out") != std::string::npos;
    });
  };
  Diagnostics of_inp, of_msh;
  EXPECT_FALSE(inp_text(model, of_inp).empty());
  EXPECT_TRUE(left_out(of_inp));
  EXPECT_NE(msh_text(model, of_msh).find("\n1 2 1 2\n"), std::string::npos)
      << "two lines of two nodes in group 2";
  EXPECT_FALSE(left_out(of_msh));
  // A sage1 deck holds it: the same model again.
  Diagnostics none;
  const WholeRun back = bench().run(sage1_text(model, none));
  ASSERT_TRUE(back.completed()) << back.failure;
  EXPECT_NEAR(back.u(7).x(), kEnd, 1e-10);
}

}  // namespace
}  // namespace sage
