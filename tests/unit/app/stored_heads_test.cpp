// Water cards of kind 7: heads that an earlier run left in its result file.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/run_source.hpp"
#include "sage/app/stored_heads.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/record/stored_result.hpp"
#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/seepage.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

using scenes::Block;
using scenes::Cell;
using scenes::DeckWriter;
namespace fs = std::filesystem;

Block block_of(Cell cell, int columns, int rows, double width = 4.0) {
  Block block;
  block.cell = cell;
  block.columns = columns;
  block.rows = rows;
  block.place = scenes::rectangle(0.0, width, 0.0, 3.0);
  return block;
}

void hold_head(DeckWriter& deck, const std::vector<int>& nodes, double head) {
  for (const int node : nodes) deck.stages.front().fixities.push_back(scenes::head_card(node, head));
}

// Water from left to right; of two layers (k 1 and 50) it is not uniform.
DeckWriter flow(const Block& block, int geometry, double k2) {
  DeckWriter deck(geometry);
  block.write_nodes(deck);
  deck.material(1, scenes::kDarcyLaw, {1.0, k2, 25.0});
  deck.group(1, scenes::flow_element(block.cell), 0, 1);
  block.write_elements(deck, 1);
  deck.stage();
  hold_head(deck, block.left(), 4.0);
  hold_head(deck, block.right(), 1.5);
  return deck;
}

DeckWriter soil(const Block& block) {
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.3}, 20.0);
  deck.group(1, static_cast<int>(block.cell), 0, 1);
  block.write_elements(deck, 1);
  for (const int node : block.bottom()) deck.fix(node, 1, 1);
  deck.stage().gravity_y = -1.0;
  return deck;
}

void add_water(DeckWriter& deck, const std::string& file, int action = 0, int stage = 0) {
  char card[100];
  std::snprintf(card, sizeof card, "%5d%5d%5d%5d%9d.%10s%5d", 7, 0, 1, action, stage, "0.", 0);
  deck.waters.push_back(card + file);
}

// Flow and soil in one deck, the heads taken as they are.
DeckWriter both(const Block& block, double k2, int action) {
  DeckWriter deck = soil(block);
  deck.stages.front().gravity_y = 0.0;
  deck.material(2, scenes::kDarcyLaw, {1.0, k2, 25.0});
  deck.groups.push_back("    2   " + std::to_string(scenes::flow_element(block.cell)) + "    0    2" +
                        std::string(40, ' ') + "    1");
  Block water = block;
  water.first_element = 1001;
  water.write_elements(deck, 2);
  hold_head(deck, block.left(), 4.0);
  hold_head(deck, block.right(), 1.5);
  deck.stage().gravity_y = -1.0;
  deck.water(4, 1, 2, action, {});
  return deck;
}

class StoredHeads : public ::testing::Test {
 protected:
  RunOutcome run(const std::string& name, const DeckWriter& deck) {
    std::ofstream(folder_ / (name + ".dat")) << deck.text();
    RunRequest request;
    request.deck = (folder_ / (name + ".dat")).string();
    request.quiet = true;
    request.keep_result = true;
    request.output.listing = request.output.increments = false;
    request.output.result = deck.waters.empty();  // what others read
    request.output.folder = folder_;
    request.input.build.heads = stored_heads(catalogue_);
    return run_deck(request, catalogue_);
  }

  static Eigen::VectorXd moved(const RunOutcome& outcome) {
    const Frame& last = outcome.result->ends().back();
    return last.view().u->head(2 * outcome.model->mesh.nodes());
  }

  // What a deck is refused for.
  Diagnostics refusal(const DeckWriter& deck) {
    try {
      run("refused", deck);
    } catch (const InputError& error) {
      return error.diagnostics();
    }
    return {};
  }

  const Catalogue catalogue_ = full_catalogue();
  const fs::path folder_ = test::scratch_folder("stored_heads");
};

#ifdef SAGE_WITH_RESULT_FILES

// The same mesh: the same numbers, as pressure and as seepage force.
TEST_F(StoredHeads, OfTheSameMeshAreThoseOfOneRun) {
  for (const Cell cell : {Cell::quad4, Cell::tri6}) {
    const Block block = block_of(cell, 3, 2);
    const std::string name = "same" + std::to_string(static_cast<int>(cell));
    ASSERT_EQ(run(name, flow(block, 1, 0.1)).exit_code, kOk);
    for (const int action : {0, 2}) {
      DeckWriter deck = soil(block);
      add_water(deck, name + ".h5", action);
      const Eigen::VectorXd stored = moved(run("soil", deck)),
                            direct = moved(run("both", both(block, 0.1, action))),
                            dry = moved(run("dry", soil(block)));
      const double size = direct.cwiseAbs().maxCoeff();
      EXPECT_LT((stored - direct).cwiseAbs().maxCoeff(), 1e-12 * size);
      EXPECT_GT((stored - dry).cwiseAbs().maxCoeff(), 0.05 * size) << "water does something";
    }
  }
}

// Heads along x alone are linear: any mesh of flow holds them without error, and another one reads them so.
TEST_F(StoredHeads, OfAnotherMeshAreInterpolated) {
  for (const Cell other : {Cell::quad4, Cell::tri3, Cell::quad8}) {
    const std::string name = "other" + std::to_string(static_cast<int>(other));
    ASSERT_EQ(run(name, flow(block_of(other, 3, 2), 1, 1.0)).exit_code, kOk);
    const Block block = block_of(Cell::quad8, 4, 3);
    DeckWriter deck = soil(block);
    add_water(deck, name + ".h5", 0, 1);
    const Eigen::VectorXd stored = moved(run("soil", deck)), direct = moved(run("both", both(block, 1.0, 0)));
    EXPECT_LT((stored - direct).cwiseAbs().maxCoeff(), 1e-11 * direct.cwiseAbs().maxCoeff());
  }
}

// Nodes that the program makes stand on no card: a converted deck can't name them, and runs.
TEST_F(StoredHeads, ConvertedDecksNameNodesOfCardsAlone) {
  ASSERT_EQ(run("heads", flow(block_of(Cell::quad4, 3, 2), 1, 1.0)).exit_code, kOk);
  DeckWriter deck = soil(block_of(Cell::quad4, 4, 3));
  deck.groups.front().replace(5, 5, "    2");  // eight nodes from the corners
  add_water(deck, "heads.h5");
  const RunOutcome outcome = run("corners", deck);
  ASSERT_EQ(outcome.exit_code, kOk);
  Diagnostics diagnostics;
  const std::string text = sage1_text(*outcome.model, diagnostics);
  const auto warns = [&](const std::string& words) {
    return std::ranges::any_of(diagnostics.list(), [&](const Diagnostic& d) {
      return to_string(d.code) == "S720" && d.message.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(warns("pressures at 31 node(s) that the deck does not name"));  // the sides of 4 x 3 elements
  EXPECT_TRUE(warns("negative pressures of water"));
  std::ofstream(folder_ / "back.dat") << text;
  RunRequest request;
  request.deck = (folder_ / "back.dat").string();
  request.quiet = true;
  request.output.folder = folder_;
  EXPECT_EQ(run_deck(request, catalogue_).exit_code, kOk);
}

TEST_F(StoredHeads, WhatCannotServeIsNamedAtItsField) {
  const Block block = block_of(Cell::quad4, 2, 2);
  run("flow", flow(block_of(Cell::quad4, 3, 2), 1, 1.0));
  run("ring", flow(block_of(Cell::quad4, 3, 2), 2, 1.0));
  run("dry", soil(block));
  run("narrow", flow(block_of(Cell::quad4, 2, 2, 3.0), 1, 1.0));
  std::ofstream(folder_ / "words.h5") << "no result file";
  const auto expect = [&](const std::string& file, int stage, const std::string& words) {
    DeckWriter deck = soil(block);
    add_water(deck, file, 0, stage);
    const Diagnostics all = refusal(deck);
    ASSERT_FALSE(all.list().empty()) << file;
    const Diagnostic& found = all.list().front();
    EXPECT_EQ(to_string(found.code), "S250") << file;
    EXPECT_NE(found.message.find(words), std::string::npos) << found.message;
    EXPECT_GT(found.where.line, 0);
    EXPECT_EQ(found.where.first_column, 46);
  };
  expect("missing.h5", 0, "can't be opened");
  expect("words.h5", 0, "no whole file of HDF5");
  expect("dry.h5", 0, "solves for no heads");
  expect("ring.h5", 0, "axisymmetric, this deck in plane strain");
  expect("flow.h5", 2, "it has no stage 2; its last is 1");
  expect("narrow.h5", 0, "3 node(s) lie outside");
  // A pipe that nobody writes to would be waited for, a device without end be read.
  ASSERT_EQ(mkfifo((folder_ / "pipe.h5").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "zero.h5");
  fs::create_directory(folder_ / "folder.h5");
  expect("pipe.h5", 0, "is no ordinary file");
  expect("zero.h5", 0, "is no ordinary file");
  expect("folder.h5", 0, "is a folder");
  DeckWriter deck = soil(block);
  add_water(deck, "");
  const Diagnostics unnamed = refusal(deck);
  ASSERT_FALSE(unnamed.list().empty());
  EXPECT_EQ(to_string(unnamed.list().front().code), "S248");
}

// A file whose deck is spoilt: the message is of the file, not of cards and lines that the reader's deck has not.
TEST_F(StoredHeads, OfASpoiltDeckAreNamedByTheirFile) {
  DeckWriter other = flow(block_of(Cell::quad4, 3, 2), 1, 1.0);
  run("spoilt", other);
  const fs::path file = folder_ / "spoilt.h5";
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  const std::string text = other.text(), card = text.substr(text.find("\n", text.find("m       kN")) + 1, 70);
  for (std::size_t at = bytes.find(card); at != std::string::npos; at = bytes.find(card, at + 1))
    bytes.replace(at, 5, "    7");  // the geometry of the control card
  std::ofstream(file, std::ios::binary) << bytes;
  DeckWriter deck = soil(block_of(Cell::quad4, 2, 2));
  add_water(deck, "spoilt.h5");
  const Diagnostics all = refusal(deck);
  ASSERT_FALSE(all.list().empty());
  EXPECT_EQ(to_string(all.list().front().code), "S250");
  EXPECT_NE(all.list().front().message.find("the file is damaged"), std::string::npos)
      << all.list().front().message;
}

// The result file of a run that took heads keeps them: it is shown when theirs is gone.
TEST_F(StoredHeads, AreKeptInTheResultFile) {
  ASSERT_EQ(run("kept_flow", flow(block_of(Cell::quad4, 3, 2), 1, 0.1)).exit_code, kOk);
  DeckWriter deck = soil(block_of(Cell::quad8, 4, 3));
  add_water(deck, "kept_flow.h5");
  std::ofstream(folder_ / "takes.dat") << deck.text();
  RunRequest request;
  request.deck = (folder_ / "takes.dat").string();
  request.quiet = true;
  request.output.result = true;
  request.output.folder = folder_;
  request.input.build.heads = stored_heads(catalogue_);
  request.input.build.refine = 1;
  ASSERT_EQ(run_deck(request, catalogue_).exit_code, kOk);
  fs::remove(folder_ / "kept_flow.h5");
  const StoredResult stored(folder_ / "takes.h5");
  const Model model = model_of(stored.source(), stored.deck_name(), catalogue_);
  stored.expect_model(model);
  EXPECT_EQ(model.water.size(), 1u);
  EXPECT_FALSE(model.water[0].nodes.empty());
}

#endif

// Water on the nodes of soil stays on them, whatever nodes are made within elements.
TEST(WaterInSoil, SharesNodesThatAreMade) {
  const Catalogue catalogue = full_catalogue();
  for (const auto& [cell, refine] :
       {std::pair{Cell::quad4, 2}, {Cell::quad8, 1}, {Cell::quad9, 0}, {Cell::quad9, 1}}) {
    BuildOptions options;
    options.refine = refine;
    Block block = block_of(cell, 2, 2);
    DeckWriter deck = both(block, 1.0, 0);
    const fs::path file = test::scratch_folder("water_in_soil") / "deck.dat";
    std::ofstream(file) << deck.text();
    const Model model = build_model(read_input(file.string(), {}), catalogue, options);
    std::vector<std::vector<int>> nodes;
    for (const Group& group : model.groups) {
      nodes.push_back(group.nodes);
      std::sort(nodes.back().begin(), nodes.back().end());
    }
    ASSERT_EQ(nodes.size(), 2u);
    EXPECT_EQ(nodes[0], nodes[1]) << static_cast<int>(cell) << " " << refine;
  }
}

// Water that does not say that it lies on soil is refused, whatever shapes both have.
TEST(WaterInSoil, SaysSoWhateverShapesBothHave) {
  const Catalogue catalogue = full_catalogue();
  const auto code_of = [&](Cell soil_cell, Cell water_cell, bool beside) {
    Block block = block_of(soil_cell, 2, 2);
    DeckWriter deck = soil(block);
    deck.material(2, scenes::kDarcyLaw, {1.0});
    deck.group(2, scenes::flow_element(water_cell), 0, 2);
    Block water = block;
    water.cell = water_cell;
    water.first_element = 1001;
    if (beside) {
      water.first_node = 501;
      water.place = scenes::rectangle(4.0, 8.0, 0.0, 3.0);
      water.write_nodes(deck);
    }
    water.write_elements(deck, 2);
    const fs::path file = test::scratch_folder("water_on_soil") / "deck.dat";
    std::ofstream(file) << deck.text();
    try {
      build_model(read_input(file.string(), {}), catalogue);
    } catch (const InputError& error) {
      return to_string(error.diagnostics().list().front().code);
    }
    return std::string("none");
  };
  for (const auto& [soil_cell, water_cell] :
       {std::pair{Cell::quad4, Cell::tri3}, {Cell::tri3, Cell::quad4}, {Cell::quad4, Cell::quad4}}) {
    EXPECT_EQ(code_of(soil_cell, water_cell, false), "S326");
    EXPECT_EQ(code_of(soil_cell, water_cell, true), "none");
  }
}

// Who builds a model without a reader of result files is told.
TEST_F(StoredHeads, NeedAReader) {
  DeckWriter deck = soil(block_of(Cell::quad4, 2, 2));
  add_water(deck, "flow.h5");
  std::ofstream(folder_ / "alone.dat") << deck.text();
  try {
    build_model(read_input((folder_ / "alone.dat").string(), {}), catalogue_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(to_string(error.diagnostics().list().front().code), "S250");
  }
}

}  // namespace
}  // namespace sage::app
