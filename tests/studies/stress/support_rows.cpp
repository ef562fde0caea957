// Parts that nothing holds: rigid motions, islands, blocks behind open joints.
#include <fmt/format.h>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// A block of 2 x 2 unit cells with given supports: node, x code, y code.
struct Support {
  int node, x, y;
};

std::string block_with(int geometry, const std::vector<Support>& supports, bool loaded = true) {
  Block block;
  block.columns = block.rows = 2;
  block.place = rectangle(geometry == 2 ? 1.0 : 0.0, geometry == 2 ? 3.0 : 2.0, 0.0, 2.0);
  DeckWriter deck(geometry);
  block.write_nodes(deck);
  deck.material(1, 1, {1000.0, 0.3});
  deck.group(1, 1, 2, 1);
  block.write_elements(deck, 1);
  for (const Support& support : supports) deck.fix(support.node, support.x, support.y);
  StageCards& stage = deck.stage();
  if (loaded) stage.load(9, 1.0, 1.0);
  return deck.text();
}

void rigid_modes(Sweep& s) {
  struct Case {
    const char* label;
    int geometry;
    std::vector<Support> supports;
    const char* mode;  // nullptr = held
  };
  const Case cases[] = {
      {"nothing held", 1, {}, "nothing holds the mesh against a rigid"},
      {"one pin", 1, {{1, 1, 1}}, "a rigid rotation"},
      {"rollers along the base", 1, {{1, 0, 1}, {2, 0, 1}, {3, 0, 1}}, "a rigid translation in x"},
      {"rollers along a side", 1, {{1, 1, 0}, {4, 1, 0}, {7, 1, 0}}, "a rigid translation in y"},
      {"three rollers through one point", 1, {{1, 1, 0}, {4, 1, 0}, {2, 1, 0}}, "a rigid translation in y"},
      {"a pin and a roller towards it", 1, {{1, 1, 1}, {3, 1, 0}}, "a rigid rotation"},
      {"a pin and a roller across", 1, {{1, 1, 1}, {3, 0, 1}}, nullptr},
      {"ring, nothing held", 2, {}, "a rigid translation along the axis"},
      {"ring, held radially", 2, {{1, 1, 0}, {4, 1, 0}}, "a rigid translation along the axis"},
      {"ring, one node held axially", 2, {{1, 0, 1}}, nullptr},
  };
  for (const Case& c : cases) {
    const Ran ran = s.run(block_with(c.geometry, c.supports));
    if (c.mode != nullptr)
      s.says(c.label, kUnknown, ran, c.mode);
    else
      s.right(c.label, kUnknown, ran, ran.completed() ? ran.run->out_of_balance : kUnknown, 1e-9);
  }
}

void islands(Sweep& s) {
  for (bool held : {false, true})
    for (int count : {1, 3}) {
      DeckWriter deck(1);
      deck.material(1, 1, {1000.0, 0.3});
      deck.group(1, 1, 2, 1);
      for (int k = 0; k <= count; ++k) {
        Block block;
        block.first_node = 100 * k + 1;
        block.first_element = 100 * k + 1;
        block.place = rectangle(2.0 * k, 2.0 * k + 1.0, 0.0, 1.0);
        block.write_nodes(deck);
        block.write_elements(deck, 1);
        if (k == 0 || held)
          for (int n : block.bottom()) deck.fix(n, 1, 1);
      }
      deck.stage().load(3, 1.0, 0.0);
      const Ran ran = s.run(deck.text());
      const std::string label = fmt::format("{} island(s), {}", count, held ? "held" : "loose");
      if (held) {
        s.right(label, kUnknown, ran, ran.completed() ? ran.run->out_of_balance : kUnknown, 1e-9);
        continue;
      }
      for (int k = 1; k <= count; ++k)
        s.says(label, kUnknown, ran,
               fmt::format("part that contains node {0}01 (4 nodes: {0}01, {0}02, {0}03, {0}04)", k));
    }
}

// A block on a joint that opens, pulled off by a force.
void open_joint(Sweep& s) {
  for (bool soft : {false, true}) {
    Block block;
    block.columns = 2;
    block.rows = 2;
    block.place = rectangle(0.0, 1.0, 0.0, 1.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    const std::vector<int> base = copy_row(deck, block, block.bottom(), 101);
    deck.material(1, 1, {1000.0, 0.2});
    deck.material(2, 21, {1e5, 1e5, soft ? 1.0 : 0.0});  // 1: never opens
    deck.group(1, 1, 2, 1);
    deck.group(2, 11, 0, 2);
    block.write_elements(deck, 1);
    join(deck, 101, 2, base, block.bottom(), 1);
    for (int n : base) deck.fix(n, 1, 1);
    StageCards& down = deck.stage();
    for (int i = 0; i < 2; ++i) down.pressure(block.element(i, 1), 3, 10.0, 10.0);
    StageCards& up = deck.stage(4);
    for (int i = 0; i < 2; ++i) up.pressure(block.element(i, 1), 3, -30.0, -30.0);
    const Ran ran = s.run(deck.text());
    if (soft) {
      const double exact = 20.0;
      s.right("bonded joint", kUnknown, ran,
              ran.completed() ? -ran.run->reaction(ran.run->last(), base, 1) / exact - 1.0 : kUnknown, 1e-9);
    } else {
      s.says("joint that opens", kUnknown, ran, "open and carries nothing");
      s.says("joint that opens: the load where it went", kUnknown, ran, "limit load: between");
    }
  }
}

}  // namespace

std::vector<Row> support_rows() {
  const std::string family = "Supports";
  return {
      {"rigid-modes", family, "too few supports", "the free motion is named", "", false, rigid_modes},
      {"islands", family, "parts without support", "the part's nodes are listed, every part", "", false,
       islands},
      {"open-joint", family, "a block held by a joint that opens", "the open interface is named, and the load",
       "", false, open_joint},
  };
}

}  // namespace sage::stress
