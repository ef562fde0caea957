// What a Gmsh MSH 4.1 ASCII file says; the skeleton model gives it meaning.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sage/core/types.hpp"

namespace sage::msh {

struct Shape {
  const char* element;  // nullptr = a line or point
  int dimension, nodes, corners;
};

using EntityKey = std::pair<int, int>;  // dimension, tag

struct MshElement {
  int number = 0;
  std::vector<int> nodes;  // indices
};

struct MshBlock {
  EntityKey entity;
  const Shape* shape = nullptr;
  std::vector<MshElement> elements;
};

struct MshFile {
  std::map<EntityKey, std::string> names;  // of physical groups
  std::map<EntityKey, int> physical;       // entity -> physical tag
  std::map<int, Vector2> nodes;            // by tag
  std::map<int, int> index;                // tag -> index
  std::vector<MshBlock> blocks;
};

// Throws InputError with the line.
MshFile read_msh(std::string_view text, const std::string& file);

}  // namespace sage::msh
