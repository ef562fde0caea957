// What a scene needs, found before anything is computed.  What isn't needed isn't done.
#pragma once

#include <string>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct Scene {
  bool linear = true;              // every law is linear: one factorisation serves all increments
  bool symmetric = true;           // every law has a symmetric tangent: LDL^T or Cholesky will do
  std::vector<char> group_linear;  // per group: its element matrices never change
  int elements = 0, points = 0, dofs = 0;
};

Scene analyse_scene(const Model& model);

// One line for the summary: "linear, symmetric: one factorisation a stage, Cholesky".
std::string describe(const Scene& scene);

}  // namespace sage
