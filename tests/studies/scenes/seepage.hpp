// Scenes of water that flows through soil: barriers in a layer, wells, dams.
#pragma once

#include <vector>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// Codes of the catalogue.
inline constexpr int kDarcyLaw = 41, kFreeSurfaceLaw = 42;
int flow_element(Cell cell);

// Cards of fixity: a given head (code 1) or an exit (code 2).  Of load: an inflow.
std::string head_card(int node, double value, int code = 1);
std::string inflow_card(int node, double value);
// Report of what flows through a line of nodes.
std::string discharge_card(const std::vector<int>& nodes);

// A block of flow elements of one material.
DeckWriter flow_deck(const Block& block, int geometry, int law, const std::vector<double>& permeability);
void hold_heads(StageCards& stage, const std::vector<int>& nodes, double head);

// Lattice lines at the ends of some intervals, each cut in n; `fine` names the end that cells get finer towards, with
// the cube of their number.
struct Interval {
  double to = 0.0;
  int n = 1;
  int fine = 0;  // -1 its beginning, 0 even, 1 its end
};
std::vector<double> lattice_lines(double from, const std::vector<Interval>& intervals);
Block lattice(const std::vector<double>& xs, const std::vector<double>& ys, Cell cell);

// At the end of a run: the head of a deck node, and what the supports of some let in.
double head_of(const WholeRun& run, int node);
double inflow_of(const WholeRun& run, const std::vector<int>& nodes);

// Right half of a layer of thickness 1 under a pile of depth s, or a floor of half-width b with a cut-off of depth s in
// its middle, head 1 from side to side, k = 1: below them the head is half way by antisymmetry.
struct Barrier {
  double b = 0.0, s = 0.0;
  Cell cell = Cell::quad8;
  int n = 12;                       // cells of each interval of the lattice
  std::vector<double> depths = {};  // where lattice lines are wanted, from the greatest

  Block block() const;
  std::vector<int> exit() const;  // nodes of the ground, from right to left
  DeckWriter deck() const;
};

// A dam with vertical faces, water H high on its left and h on its right; what leaves above h is found.
// Q = k (H^2 - h^2) / 2 W in plane strain (Charny).
struct Dam {
  double H = 7.0, W = 7.0, h = 2.0, k = 1e-3, ramp = 0.0;
  double top = 7.0;   // of the dam
  double left = 0.0;  // x of its left face, or the inner radius of a ring
  int geometry = 1, columns = 28, rows = 28;
  Cell cell = Cell::quad4;

  Block block() const;
  DeckWriter deck() const;
  double charny() const { return k * (H * H - h * h) / (2.0 * W); }
};

}  // namespace sage::scenes
