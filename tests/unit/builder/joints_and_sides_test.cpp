// Joints without a solid on one side, and straight sides that are held in part.
#include <gtest/gtest.h>

#include "sage/app/commands.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

std::string message_with(const Model& model, const std::string& words) {
  for (const Diagnostic& d : model.diagnostics.list())
    if (d.message.find(words) != std::string::npos) return to_string(d);
  return {};
}

constexpr char kBare[] = "no solid is active on one side of joint group ";
constexpr char kPart[] = " is held in part: ";

// Two unit squares on each other with a joint between them, nodes 3 4 below and 5 6 above; the upper one is
// loaded in the first stage.
DeckWriter joint_between_squares() {
  DeckWriter deck(1);
  const double y[] = {0.0, 1.0, 1.0, 2.0};
  for (int i = 0; i < 8; ++i) deck.node(i + 1, i % 2, y[i / 2]);
  deck.material(1, 1, {2e4, 0.3});
  deck.material(2, 22, {5.0, 20.0, 0.0, 0.8, 12000.0, 0.0, 1e6, 1e6, 10.0, 2.0});
  deck.group(1, 1, 0, 1);
  deck.group(2, 1, 0, 1);
  deck.group(3, 11, 2, 2);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 2, {5, 6, 8, 7});
  deck.element(3, 3, {3, 4, 6, 5});
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  StageCards& load = deck.stage();
  load.load(8, 3.0, 0.0);
  load.pressure(2, 3, 40.0, 40.0);
  return deck;
}

// Methods 1 and 2 find an equilibrium for whatever place of the hanging nodes, Newton's matrix is singular:
// each is warned before anything is solved.
TEST(BareJoints, AreNamedAfterARemoval) {
  for (const int method : {0, 1, 2}) {
    DeckWriter deck = joint_between_squares();
    StageCards& removal = deck.stage(2);
    removal.method = method;
    removal.deaths = {2};
    const Model model = app::make_workbench().build(deck.text());
    const std::string words = message_with(model, kBare);
    EXPECT_NE(words.find("warning: stage 2: no solid is active on one side of joint group 3, element(s) 3: "
                         "node(s) 5, 6 hang on the joint alone"),
              std::string::npos)
        << words;
    EXPECT_TRUE(run_text(deck.text()).warns(kBare)) << "the run says so too";
  }
}

// Pulled open, the joint leaves its upper nodes free along it: where that is stands on
// the record of the run too.
TEST(BareJoints, RunNamesANodeBehindAnOpenJoint) {
  DeckWriter deck = joint_between_squares();
  deck.stages.clear();
  deck.stage();  // an unstressed joint: adhesion would let go of its shear in one jump
  StageCards& removal = deck.stage(2);
  removal.method = 2;
  removal.deaths = {2};
  for (const int node : {5, 6}) removal.fix(node, 0, 1, 0.0, 0.01);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_TRUE(run.warns("all interfaces at node 5, direction x, are open and no solid is active there"));
}

TEST(BareJoints, OfAWaitingSolidAreNamedToo) {
  DeckWriter deck = joint_between_squares();
  deck.stages.clear();
  deck.stage();
  StageCards& birth = deck.stage();
  birth.births = {2};
  EXPECT_NE(message_with(app::make_workbench().build(deck.text()), kBare).find("stage 1"), std::string::npos);
}

TEST(BareJoints, NoFalseAlarm) {
  DeckWriter both = joint_between_squares();  // both go
  both.stage().deaths = {2, 3};
  DeckWriter held = joint_between_squares();  // a rigid body takes the solid's place
  StageCards& removal = held.stage();
  removal.deaths = {2};
  for (const int node : {5, 6}) removal.fix(node, 1, 1);
  DeckWriter plain = joint_between_squares();
  DeckWriter platen = joint_between_squares();  // nodes of the deck's own, without any solid
  platen.elements.erase(platen.elements.begin() + 1);
  platen.groups.erase(platen.groups.begin() + 1);
  platen.stages.clear();
  for (const int node : {5, 6}) platen.stage().load(node, 0.0, -1.0);
  for (const DeckWriter* deck : {&both, &held, &plain, &platen})
    EXPECT_EQ(message_with(app::make_workbench().build(deck->text()), kBare), "");
}

// A half model, two cells wide: four rows of ground and two of fill on it, born in the second stage.
struct HalfModel {
  int held_rows = 4;  // of the line of symmetry
  Cell cell = Cell::quad4;
  bool load_free_part = false, move_free_part = false;

  std::string note(const BuildOptions& options = {}) const {
    Block block;
    block.cell = cell;
    block.columns = 2;
    block.rows = 6;
    block.place = scenes::rectangle(0.0, 2.0, -4.0, 2.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, 1, {1e4, 0.3}, 20.0);
    deck.group(1, static_cast<int>(cell), 0, 1);
    block.write_elements(deck, 1);
    for (const int node : block.bottom()) deck.fix(node, 1, 1);
    for (const int node : block.right()) deck.fix(node, 1, 0);
    const std::vector<int> axis = block.left();
    const auto last = static_cast<std::size_t>(block.order() * held_rows);
    for (std::size_t i = 0; i <= last; ++i) deck.fix(axis[i], 1, 0);
    StageCards& stage = deck.stage();
    stage.gravity_y = -1.0;
    for (std::size_t i = last + 1; i < axis.size(); ++i) {
      if (load_free_part) stage.load(axis[i], 1.0, 0.0);
      if (move_free_part) stage.fix(axis[i], 1, 0, 0.01, 0.0);
    }
    return message_with(app::make_workbench().build(deck.text(), options), kPart);
  }
};

TEST(PartlyHeldSide, IsNotedWithBothNumbers) {
  EXPECT_NE(
      HalfModel{}.note().find("note: the straight side x = 0 is held in part: 5 nodes held along x, 2 free, "
                              "the first is node 16"),
      std::string::npos)
      << HalfModel{}.note();
  EXPECT_NE((HalfModel{4, Cell::quad8}.note().find("9 nodes held along x, 4 free")), std::string::npos);
  EXPECT_NE((HalfModel{2, Cell::tri3}.note().find("3 nodes held along x, 4 free")), std::string::npos);
  BuildOptions fine;
  fine.refine = 1;
  EXPECT_NE(HalfModel{}.note(fine).find("9 nodes held along x, 4 free"), std::string::npos);
}

TEST(PartlyHeldSide, NoFalseAlarm) {
  EXPECT_EQ(HalfModel{6}.note(), "") << "held all along";
  EXPECT_EQ(HalfModel{0}.note(), "") << "a free side: the base holds its corner";
  EXPECT_EQ((HalfModel{4, Cell::quad4, true, false}.note()), "") << "what is loaded is meant to move";
  EXPECT_EQ((HalfModel{4, Cell::quad4, false, true}.note()), "") << "what is moved too";
}

}  // namespace
}  // namespace sage::test
