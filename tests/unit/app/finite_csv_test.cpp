// No table of a run that exits 0 holds inf or nan, whatever the deck is.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/record/number.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;
using scenes::DeckWriter;

// A column of two quad4 between supports, its sides free or held; nodes 1 2 / 3 4 / 5 6 from the bottom.
struct Column {
  int geometry = 2, law = 1;
  std::vector<double> parameters{1000.0, 0.25};
  double size = 1.0, down = 0.01, weight = 0.0, side = 0.0;
  bool all_held = false;
  std::string report = {};

  std::string text() const {
    DeckWriter deck(geometry);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) deck.node(1 + i + 2 * j, size * i, size * j);
    deck.material(1, law, parameters, weight);
    deck.group(1, 1, 1, 1);
    deck.element(1, 1, {1, 2, 4, 3});
    deck.element(2, 1, {3, 4, 6, 5});
    for (int n = 1; n <= 6; ++n) deck.fix(n, n % 2 == 1 || all_held ? 1 : 0, n <= 2 || all_held ? 1 : 0);
    scenes::StageCards& stage = deck.stage(2);
    if (weight != 0.0) stage.gravity_y = -1.0;
    for (int n : {5, 6}) stage.fix(n, all_held ? 1 : 0, 1, 0.0, -down);
    if (side != 0.0) stage.pressure(1, 2, side, side);
    if (!report.empty()) deck.reports.push_back(report);
    return deck.text();
  }
};

// Nothing pushes the two blocks together: the joint's stress level has no bound.
std::string loose_joint() {
  DeckWriter deck(1);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      deck.node(1 + i + 2 * j, i, j);
      deck.node(11 + i + 2 * j, i, 1 + j);
    }
  deck.material(1, 1, {1000.0, 0.25});
  deck.material(2, 22, {0.0, 30.0, 0.0, 0.9, 10.0, 0.5, 1000.0, 0.0, 1.0});
  deck.group(1, 1, 1, 1);
  deck.group(2, 11, 0, 2);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 1, {11, 12, 14, 13});
  deck.element(3, 2, {3, 4, 12, 11});
  for (int n : {1, 2, 13, 14}) deck.fix(n, 1, 1);
  scenes::StageCards& stage = deck.stage(1);
  for (int n : {13, 14}) stage.fix(n, 1, 1, 1e-5, 0.0);
  return deck.text();
}

struct Outcome {
  int exit_code = kOk;
  std::string error;
};

Outcome run_with_all_tables(const std::string& name, const std::string& text, const fs::path& folder) {
  std::ofstream(folder / (name + ".dat")) << text;
  RunRequest request;
  request.deck = (folder / (name + ".dat")).string();
  request.quiet = true;
  request.output.folder = folder;
  request.output.nodes = request.output.points = true;
  request.input.build.points.push_back({{0.0, 0.0}, "", 0});
  try {
    return {run_deck(request, full_catalogue()).exit_code, ""};
  } catch (const InputError& error) {
    std::string all;
    for (const Diagnostic& d : error.diagnostics().list()) all += to_string(d) + "\n";
    return {kInput, all};
  } catch (const AnalysisError& error) {
    return {kNotConverged, error.what()};
  }
}

// The cells that are no number and no word of a table.
std::string strange_cells(const fs::path& folder, const std::string& name) {
  std::string found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(name + ".") || entry.path().extension() != ".csv") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("#")) continue;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        if (cell.find("inf") != std::string::npos || cell.find("nan") != std::string::npos)
          found += file + ": " + line + "\n";
    }
  }
  return found;
}

TEST(FiniteTables, HostileDecks) {
  const fs::path folder = test::scratch_folder("finite");
  const auto triaxial = [](const char* nodes, const char* area) {
    return std::string("    1    1") + nodes + "    1        2." + area;
  };
  std::vector<std::pair<std::string, std::string>> decks;
  const auto add = [&](const char* name, const Column& column) { decks.emplace_back(name, column.text()); };
  add("plain", {.report = triaxial("    5    6    1", "")});
  add("tiny_area", {.report = triaxial("    5    6    1", "    1.-300")});
  add("tiny_correct", {.down = 1e-300, .report = triaxial("    5    6    1", "")});
  add("no_strain", {.down = 0.0, .report = triaxial("    5    6    1", "")});
  add("huge", {.parameters = {1e99, 0.25}, .down = 1e99});
  add("huge_held", {.parameters = {1e99, 0.25}, .size = 1e-99, .down = 1e99, .all_held = true});
  add("huge_report", {.parameters = {1e99, 0.25},
                      .size = 1e-90,
                      .down = 1e99,
                      .all_held = true,
                      .report = triaxial("    5    6    1", "    1.-200")});
  add("cone_pulled", {.law = 3, .parameters = {1000.0, 0.25, 0.0, 30.0, 0.0}, .down = -0.01});
  add("mohr_pulled", {.law = 4, .parameters = {1000.0, 0.25, 0.0, 30.0, 0.0}, .down = -0.01});
  add("no_strength", {.law = 3, .parameters = {1000.0, 0.25, 0.0, 0.0, 0.0}, .weight = 20.0});
  decks.emplace_back("loose_joint", loose_joint());
  int done = 0;
  for (const auto& [name, text] : decks) {
    const Outcome outcome = run_with_all_tables(name, text, folder);
    if (outcome.exit_code != kOk) continue;
    ++done;
    EXPECT_EQ(strange_cells(folder, name), "") << name;
  }
  EXPECT_GE(done, 4);  // the others are refused or end with a message
}

// Blank where nodes without width leave nothing to divide by: refused at the card, with what helps.
TEST(FiniteTables, TriaxialReportWithoutAnAreaIsRefused) {
  const fs::path folder = test::scratch_folder("finite");
  Column column;
  column.report = "    1    1    1    5    2    1        2.";  // the axis
  Outcome outcome = run_with_all_tables("axis", column.text(), folder);
  EXPECT_EQ(outcome.exit_code, kInput);
  EXPECT_NE(
      outcome.error.find("give the area: it is left blank and can't be found from the report's nodes, all "
                         "of which lie on the axis"),
      std::string::npos)
      << outcome.error;
  column.geometry = 1;
  outcome = run_with_all_tables("upright", column.text(), folder);
  EXPECT_EQ(outcome.exit_code, kInput);
  EXPECT_NE(outcome.error.find("which have no width along x"), std::string::npos) << outcome.error;
  column.report += "        3.";
  EXPECT_EQ(run_with_all_tables("given", column.text(), folder).exit_code, kOk);
}

TEST(FiniteTables, CellsHoldNumbersOnly) {
  const double infinite = std::numeric_limits<double>::infinity();
  std::string text = "1";
  for (double value : {infinite, -infinite, std::nan("")}) {
    append_optional_cell(text, value);
    EXPECT_THROW(append_result_cell(text, value), AnalysisError);
  }
  EXPECT_EQ(text, "1,,,");
  append_result_cell(text, -0.25);
  EXPECT_EQ(text, "1,,,,-0.25");
}

}  // namespace
}  // namespace sage::app
