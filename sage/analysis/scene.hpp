// What a scene needs, found before anything is computed.  What isn't needed isn't done.
#pragma once

#include <string>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct Scene {
  bool linear = true;                    // every law is linear: one factorisation serves all increments
  bool symmetric = true;                 // every law has a symmetric tangent: LDL^T or Cholesky will do
  std::vector<char> group_linear;        // per group: its element matrices never change
  std::vector<std::vector<int>> shapes;  // per linear group: the shape of each element (shapes_of)
  int elements = 0, points = 0, dofs = 0;
  int linear_elements = 0;
  int linear_shapes = 0;   // element matrices to be made for them
  int nonlinear_dofs = 0;  // that belong to an element of a nonlinear group
};

Scene analyse_scene(const Model& model);

// One line for the summary: "nonlinear, unsymmetric; 392 of 406 elements linear (14 shapes), 60 of 870 dofs
// touch the others".
std::string describe(const Scene& scene);

}  // namespace sage
