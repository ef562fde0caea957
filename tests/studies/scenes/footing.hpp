// Footings pushed into soil up to their collapse load.
#pragma once

#include <array>
#include <vector>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// Footing of half width or radius 1 on weightless ground.  Cells get finer towards the footing's edge.
struct Footing {
  int geometry = 1;
  bool rough = false;
  Cell cell = Cell::quad8;
  int formulation = 1;  // of that cell; 1 is quad8 reduced
  int law = 4;          // 3 Drucker-Prager, plane strain cone without volume change
  double phi = 0.0, psi = 0.0, c = 1.0, nu = 0.49, E = 298.0;
  double surcharge =
      0.0;  // pressure on the whole surface, and the first stress of the ground in all directions
  int inside = 12, outside = 14, down = 16;  // cells under the footing, beside it, and below
  double width = 4.0, depth = 3.0, power = 2.2;
  // Of each cell to the one before it, away from the edge: under the footing, beside it, below; 0 = by `power`.
  std::array<double, 3> growth{};
  Block block{};
  DeckWriter deck{1};
  std::vector<int> base{};  // nodes under the footing

  void build();
  void press(double settlement, int increments);
  // Mean pressure under the footing, without the surcharge.
  double load(const WholeRun& run, const Snapshot& at) const;
  // At the end, with the surcharge.
  double pressure(const WholeRun& run) const;
};

// N_q = exp(pi tan phi) tan^2(45 + phi/2), phi in degrees: Prandtl's mechanism, associated flow.
double prandtl_Nq(double phi);

}  // namespace sage::scenes
