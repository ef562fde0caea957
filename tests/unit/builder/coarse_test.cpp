// Footings on coarse meshes: a warning where the collapse load is 5 % and more too large, none where it is not, and none
// where what is pushed is no footing.  docs/benchmarks/collapse.csv has the errors.
#include <gtest/gtest.h>

#include <cmath>

#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

enum class Push { moved, pressed, whole_top, trapdoor, tangential };

// Half of a strip of half width 1, or a whole one, on ground 3 deep.  Cells get finer towards its end as `power` of
// the place.
struct Footing {
  const char* name;
  int cells;  // under the half width
  double power;
  Cell cell;
  int formulation;
  Push push = Push::moved;
  const char* says = nullptr;  // nullptr: nothing
  int law = 4;
  bool both_ends = false;
};

void PrintTo(const Footing& one, std::ostream* out) {
  *out << one.name;
}

// From the middle of the strip (or its other side) to the end of the ground.
double place_across(const Footing& footing, double at) {
  const int n = footing.cells;
  const auto half = [&](double cell) {
    return cell <= n ? 1.0 - std::pow(1.0 - cell / n, footing.power)
                     : 1.0 + 4.0 * std::pow((cell - n) / n, footing.power);
  };
  if (!footing.both_ends) return half(at);
  return at >= 2 * n ? half(at - 2 * n) : -half(2 * n - at);
}

std::string deck_text(const Footing& footing) {
  const int n = footing.cells, columns = footing.both_ends ? 4 * n : 2 * n;
  Block block;
  block.cell = footing.cell;
  block.columns = columns;
  block.rows = n + 1;
  block.straight = true;
  block.place = [&](double s, double t) -> Vector2 {
    return {place_across(footing, s * columns), -3.0 * std::pow(1.0 - t, footing.power)};
  };
  DeckWriter deck(1);
  block.write_nodes(deck);
  deck.material(
      1, footing.law,
      footing.law == 1 ? std::vector<double>{298.0, 0.3} : std::vector<double>{298.0, 0.3, 1.0, 0.0, 0.0});
  deck.group(1, static_cast<int>(footing.cell), footing.formulation, 1);
  block.write_elements(deck, 1);
  const bool trapdoor = footing.push == Push::trapdoor;
  for (int node : block.left()) deck.fix(node, 1, 0);
  for (int node : block.right()) deck.fix(node, 1, 0);
  for (int node : block.bottom()) deck.fix(node, trapdoor ? 0 : 1, 1);
  StageCards& stage = deck.stage();
  const std::vector<int> row = trapdoor ? block.bottom() : block.top();
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double x = place_across(footing, static_cast<double>(i) / block.order());
    if (footing.push != Push::whole_top && std::abs(x) > 1.0 + 1e-9) continue;
    if (footing.push == Push::pressed) continue;
    if (footing.push == Push::tangential)
      stage.fix(row[i], 1, 0, 0.01, 0.0);
    else
      stage.fix(row[i], 0, 1, 0.0, trapdoor ? 0.01 : -0.01);
  }
  for (int i = 0; footing.push == Push::pressed && i < n; ++i)
    stage.pressure(block.element(i, block.rows - 1), 3, 1.0, 1.0);
  return deck.text();
}

class Coarse : public testing::TestWithParam<Footing> {};

TEST_P(Coarse, IsNamedWhereTheCollapseLoadIsFarOff) {
  const WholeRun run = run_text(deck_text(GetParam()));
  std::string text;
  for (const Diagnostic& d : run.model->diagnostics.list())
    if (d.message.find("too coarse for a collapse load") != std::string::npos) text += d.message + "\n";
  if (GetParam().says == nullptr)
    EXPECT_EQ(text, "");
  else
    EXPECT_NE(text.find(GetParam().says), std::string::npos) << text;
}

constexpr const char* kMoved = "too large; 0.005 leaves about 2 %";
constexpr const char* kPressed = ": loads are 10 % and more too large";
constexpr const char* kLocks = "the elements lock where the ground flows";

INSTANTIATE_TEST_SUITE_P(
    Moved, Coarse,
    testing::Values(Footing{"b-bar 4: 14 to 20 % off", 4, 2.2, Cell::quad4, 2, Push::moved, kMoved},
                    Footing{"b-bar 8: 4 to 7 %", 8, 2.2, Cell::quad4, 2},
                    Footing{"quad8 reduced 4: 5 to 10 %", 4, 2.2, Cell::quad8, 1, Push::moved, kMoved},
                    Footing{"quad8 reduced 8: 1 to 2.5 %", 8, 2.2, Cell::quad8, 1},
                    Footing{"quad8 reduced 8, uniform: 8 to 14 %", 8, 1.0, Cell::quad8, 1, Push::moved, kMoved},
                    Footing{"tri6 4: 6 to 8 %", 4, 2.2, Cell::tri6, 1, Push::moved, kMoved},
                    Footing{"quad4 full 8: 80 to 100 %", 8, 2.2, Cell::quad4, 1, Push::moved, kLocks},
                    Footing{"both ends, 4", 4, 2.2, Cell::quad4, 2, Push::moved, kMoved, 4, true},
                    Footing{"both ends, 8", 8, 2.2, Cell::quad4, 2, Push::moved, nullptr, 4, true}));
INSTANTIATE_TEST_SUITE_P(
    Pressed, Coarse,
    testing::Values(Footing{"b-bar 2: 23 %", 2, 1.0, Cell::quad4, 2, Push::pressed, kPressed},
                    Footing{"b-bar 4: 10 %", 4, 1.0, Cell::quad4, 2, Push::pressed},
                    Footing{"quad8 reduced 1: 16 %", 1, 1.0, Cell::quad8, 1, Push::pressed, kPressed},
                    Footing{"quad8 reduced 2: 9 %", 2, 1.0, Cell::quad8, 1, Push::pressed},
                    Footing{"quad4 full 8: locks", 8, 1.0, Cell::quad4, 1, Push::pressed, kLocks}));
INSTANTIATE_TEST_SUITE_P(NoFooting, Coarse,
                         testing::Values(Footing{"no strength", 4, 2.2, Cell::quad4, 2, Push::moved, nullptr,
                                                 1},
                                         Footing{"the whole top", 4, 2.2, Cell::quad4, 1, Push::whole_top},
                                         Footing{"a trapdoor", 4, 2.2, Cell::quad4, 1, Push::trapdoor},
                                         Footing{"along itself", 4, 2.2, Cell::quad4, 1, Push::tangential}));

}  // namespace
}  // namespace sage::test
