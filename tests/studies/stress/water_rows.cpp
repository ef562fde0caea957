// Water that flows: permeabilities far apart, free surfaces in awkward places.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/scenes/seepage.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// Two halves of a strip, one behind the other or side by side; head 1 from left to right.
Trial& two_soils(Sweep& s, double contrast, bool in_a_row, Cell cell) {
  Block block;
  block.columns = block.rows = 4;
  block.cell = cell;
  block.place = rectangle(0.0, 4.0, 0.0, 4.0);
  DeckWriter deck = flow_deck(block, 1, kDarcyLaw, {1.0});
  deck.material(2, kDarcyLaw, {contrast});
  deck.group(2, flow_element(cell), 0, 2);
  for (std::string& element : deck.elements) {
    const int number = (std::stoi(element.substr(0, 5)) - 1) / (cell == Cell::tri3 ? 2 : 1);
    if ((in_a_row ? number % 4 : number / 4) >= 2) element.replace(5, 5, "    2");
  }
  hold_heads(deck.stages.back(), block.left(), 1.0);
  hold_heads(deck.stages.back(), block.right(), 0.0);
  const double exact = in_a_row ? 4.0 / (2.0 + 2.0 / contrast) : 0.5 * (1.0 + contrast);
  const Ran ran = s.run(deck.text());
  // Taken where the soil is the less permeable one: in the other heads differ by rounding.
  const std::vector<int> side = contrast < 1.0 || !in_a_row ? block.right() : block.left();
  const double q = ran.completed() ? std::abs(inflow_of(*ran.run, side)) : kUnknown;
  return s.right(fmt::format("k2/k1 = {:.0e}, {}, {}", contrast, in_a_row ? "in a row" : "side by side",
                             cell == Cell::tri3    ? "tri3"
                             : cell == Cell::quad4 ? "quad4"
                                                   : "quad8"),
                 contrast, ran, q / exact - 1.0, 1e-10);
}

void contrast(Sweep& s) {
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri3})
    for (const bool in_a_row : {true, false})
      for (const double k : {1e-13, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e13})
        two_soils(s, k, in_a_row, cell).series = in_a_row ? "in a row" : "side by side";
}

// Water that stands: the surface is level, through the corners of elements or beside them by next to nothing.
void level_surface(Sweep& s) {
  for (const Cell cell : {Cell::quad4, Cell::tri3, Cell::quad8})
    for (const double beside : {0.0, 1e-8, -1e-8, 1e-6, -1e-6, 1e-3, -1e-3, 0.1}) {
      Dam dam;
      dam.cell = cell;
      dam.columns = dam.rows = cell == Cell::quad8 ? 7 : 14;
      dam.H = dam.h = 3.5 + beside;
      const Ran ran = s.run(dam.deck().text());
      double error = 0.0;
      if (ran.completed()) {
        const Block body = dam.block();
        for (int j = 0; j < body.up(); ++j)
          for (int i = 0; i < body.across(); ++i)
            if (body.exists(i, j))
              error = std::max(error, std::abs(head_of(*ran.run, body.node(i, j)) - dam.H));
      }
      s.right(fmt::format("level {:+.0e} beside corners, {}", beside,
                          cell == Cell::tri3    ? "tri3"
                          : cell == Cell::quad4 ? "quad4"
                                                : "quad8"),
              kUnknown, ran, error, 1e-9);
    }
}

// A dam on meshes of all sizes: the surface and its end come to lie on corners or not, as it happens.
void dams(Sweep& s) {
  for (const Cell cell : {Cell::quad4, Cell::tri3, Cell::quad8})
    for (int n = 7; n <= 28; n += cell == Cell::quad4 ? 1 : 7) {
      Dam dam;
      dam.cell = cell;
      dam.columns = dam.rows = n;
      const Ran ran = s.run(dam.deck().text());
      const double q = ran.completed() ? -inflow_of(*ran.run, dam.block().right()) : kUnknown;
      Trial& trial = s.right(fmt::format("{} rows, {}", n,
                                         cell == Cell::tri3    ? "tri3"
                                         : cell == Cell::quad4 ? "quad4"
                                                               : "quad8"),
                             n, ran, q / dam.charny() - 1.0, 0.1 / n);
      trial.series = cell == Cell::tri3 ? "tri3" : cell == Cell::quad4 ? "quad4" : "quad8";
    }
}

// From a dam that is nearly dry to one that is full, and from one as thin as a wall to one ten times as long as high.
void dry_and_full(Sweep& s) {
  for (const auto& [H, h] : {std::pair{7.0, 0.0}, {7.0, 6.9}, {7.0, 7.0}, {0.5, 0.0}, {1.0, 1.0}, {5.0, 0.25}})
    for (const double W : {1.0, 7.0, 70.0}) {
      Dam dam;
      dam.H = H;
      dam.h = h;
      dam.W = W;
      const Ran ran = s.run(dam.deck().text());
      const double q = ran.completed() ? -inflow_of(*ran.run, dam.block().right()) : kUnknown;
      // Of the flow of a full dam: what the ramp of one element adds or takes.
      s.right(fmt::format("H = {:g}, h = {:g}, L = {:g}", H, h, W), kUnknown, ran,
              (q - dam.charny()) / (dam.k * 49.0 / (2.0 * W)), 1e-2);
    }
}

}  // namespace

std::vector<Row> water_rows() {
  const std::string family = "Water";
  return {{"permeability", family, "permeabilities far apart",
           "layers in a row and side by side, closed form; rounding", "k2/k1", true, contrast},
          {"level-surface", family, "free surface of standing water through corners of elements",
           "the same head everywhere; the run's tolerance", "", false, level_surface},
          {"dam", family, "free surface wherever it comes to lie", "Charny 1951; first order in the mesh",
           "rows", false, dams},
          {"dry-and-full", family, "dams nearly dry or full, thin and long",
           "Charny 1951; 1e-2 of the flow of a full dam on 28 x 28 elements", "", false, dry_and_full}};
}

}  // namespace sage::stress
