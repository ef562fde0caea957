// Lattices of quadratic elements, as input of a model.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sage/builder/model_input.hpp"

namespace sage {

// A lattice of cells; quadratic sides have their middle where `place` puts it.
struct LatticeMesh {
  std::vector<double> x, y;         // lines of the cells' corners, ascending
  std::string element = "quad8p4";  // or quad8, quad9p4; tri6p3: two a cell, cut from lower left to upper right
  std::string formulation = {};
  std::function<Vector2(double, double)> place = [](double a, double b) { return Vector2(a, b); };

  int columns() const { return static_cast<int>(x.size()) - 1; }
  int rows() const { return static_cast<int>(y.size()) - 1; }
  // Number of the lattice node in column i of 0 .. 2 columns, row j; 0 where a quad8 has none.
  int node(int i, int j) const;
  bool is_corner(int i, int j) const { return i % 2 == 0 && j % 2 == 0; }
  // Of a line of lattice nodes.
  std::vector<int> row(int j) const;
  std::vector<int> column(int i) const;
  // Only those that have a pressure.
  std::vector<int> corner_row(int j) const;
  std::vector<int> corner_column(int i) const;
  // Adds nodes and a group of elements, with material 1; of elements that solve for the pressure of pore water also 2.
  void write(ModelInput& input) const;
  // Numbers of the elements along the upper or right side, and the edge (from 1) that lies there.
  std::vector<int> upper_elements() const, right_elements() const;
  int upper_edge() const { return element == "tri6p3" ? 2 : 3; }
  int right_edge() const { return 2; }
};

// From a to b, each interval `ratio` times the one before.
std::vector<double> graded(double a, double b, int intervals, double ratio = 1.0);

}  // namespace sage
