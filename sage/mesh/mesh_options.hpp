// What is to be done with the deck's mesh before the model is complete.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sage/messages/code.hpp"

namespace sage {

// Layers of smaller elements around a node.
struct Grading {
  int node = 0;  // the deck's number; 0 = every singular corner that the supports and loads show
  int layers = 5;
  double ratio = 0.15;  // of one layer's size to the next larger one's
};

struct MeshOptions {
  bool coarsen = false;           // first: no more elements than the geometry and the corners of gradings need
  int refine = 0;                 // every element into four, so many times
  std::vector<Grading> gradings;  // after refining
  int refine_graded = 0;          // last: every element into four, layers too
  // Gets a message before a large mesh is made; empty = nobody.
  std::function<void(const std::string&, Code)> say;
};

}  // namespace sage
