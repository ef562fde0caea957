// Writes decks of layout sage1, card by card as docs/manual/deck_format.md has them: for verification cases,
// stress tests and tests that run whole models.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sage/core/types.hpp"

namespace sage::scenes {

// A real number in ten columns, with its point and as many digits as fit.
std::string ten_columns(double value);

// One stage; cards are stored as text.
struct StageCards {
  std::string title = "stage";
  int increments = 1, method = 0, max_iterations = 0, output_every = 0;
  double gravity_x = 0.0, gravity_y = 0.0, tolerance = 0.0;
  std::vector<int> births, deaths;
  std::vector<std::string> fixities, loads, pressures, initials;

  // Codes: 0 as before, 1 fixed, -1 released.
  void fix(int node, int x_code, int y_code, double x = 0.0, double y = 0.0);
  void load(int node, double x, double y);
  // Edge counts from 1; pressure > 0 pushes into the element.
  void pressure(int element, int edge, double normal1, double normal2, double shear1 = 0.0,
                double shear2 = 0.0);
  void initial(int group, int kind, double v1, double v2 = 0.0, double v3 = 0.0, double v4 = 0.0);
};

struct DeckWriter {
  explicit DeckWriter(int geometry_code) : geometry(geometry_code) {}

  int geometry = 1;  // 1 plane strain, 2 axisymmetric
  bool large_strain = false;
  double atmospheric_pressure = 101.325, water_unit_weight = 9.81;
  std::string title = "verification";
  std::vector<std::string> nodes, fills, materials, groups, elements, fixities, initials, reports, waters;
  std::vector<StageCards> stages;

  void node(int number, double x, double y, bool polar = false);
  // A row from the node card before to this one, numbers `step` apart; ratio: last interval over the first.
  void node_row(int number, int step, double x, double y, double ratio = 0.0, bool polar = false);
  // Nodes of a block whose sides are known: columns x rows of elements.
  void fill(int first, int columns, int column_step, int rows, int row_step, double column_ratio = 0.0,
            double row_ratio = 0.0);
  void material(int number, int law, const std::vector<double>& parameters, double unit_weight = 0.0,
                const std::string& name = "law");
  void group(int number, int element, int formulation, int material, const std::string& name = "");
  void element(int number, int group, const std::vector<int>& element_nodes);
  // columns x rows of elements, numbered row by row.
  void elements_block(int number, int group, const std::vector<int>& element_nodes, int columns, int rows,
                      int column_step, int row_step);
  void fix(int node, int x_code, int y_code);
  void fix_row(int first, int last, int step, int x_code, int y_code);
  // Values one by one: GCC 12.2 (-O2 -march=native) stores a list {x, x, x, 0} of constants as {x, x, x, x}.
  void initial(int group, int kind, double v1, double v2 = 0.0, double v3 = 0.0, double v4 = 0.0);
  StageCards& stage(int increments = 1);
  // Axial force of nodes first ... last against a frictionless test, from a stage (from 1) on.
  void triaxial_report(int group, int first, int last, int stage, double height, double cell_pressure = 0.0);

  // Pore pressure from a stage (from 1) on; group 0 = all.  values: those that the card lists.
  void water(int kind, int group, int stage, int action, const std::vector<double>& values, double v1 = 0.0,
             double v2 = 0.0);

  std::string text() const;
};

enum class Cell { quad4 = 1, quad8 = 2, tri3 = 3, tri6 = 4, quad9 = 5 };  // the catalogue's codes

// A block of columns x rows cells; triangles are two to a cell.  The place of a lattice node is what `place`
// makes of its position in the unit square.
struct Block {
  int columns = 1, rows = 1;
  Cell cell = Cell::quad4;
  int first_node = 1, first_element = 1;
  std::function<Vector2(double, double)> place;  // cartesian, or radius and degrees when polar
  bool polar = false;
  bool straight = false;  // mid-side nodes halfway between their corners instead of where `place` puts them

  int order() const { return cell == Cell::quad4 || cell == Cell::tri3 ? 1 : 2; }
  int across() const { return order() * columns + 1; }
  int up() const { return order() * rows + 1; }
  // Deck number of the lattice node in column i, row j; quadratic blocks count mid-side places too.
  int node(int i, int j) const { return first_node + j * across() + i; }
  // Deck number of the (first) element in cell i, j.
  int element(int i, int j) const;
  bool exists(int i, int j) const;  // no node in the middle of a quadrilateral
  Vector2 at(int i, int j) const;

  void write_nodes(DeckWriter& deck) const;
  void write_elements(DeckWriter& deck, int group) const;
  // Node numbers along an edge of the block.
  std::vector<int> left() const, right() const, bottom() const, top() const;
};

// Interface elements, numbered from `first`, between two rows of nodes: node 1 to 2 along `lower`, `upper` on
// its left.  order: 1 linear, 2 quadratic (every second node is mid-side).
void join(DeckWriter& deck, int first, int group, const std::vector<int>& lower, const std::vector<int>& upper,
          int order);
// New nodes, numbered from `first`, at the places of a row of the block's nodes.
std::vector<int> copy_row(DeckWriter& deck, const Block& block, const std::vector<int>& row, int first);

// The rectangle [x0, x1] x [y0, y1].
std::function<Vector2(double, double)> rectangle(double x0, double x1, double y0, double y1);

}  // namespace sage::scenes
