// What a Gmsh MSH 4.1 ASCII file says; the skeleton model gives it meaning.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::msh {

inline constexpr int kPoint = 15;  // Gmsh's type
// Gmsh's type of a line of so many nodes; 0 = it has none.
int line_type(std::size_t nodes);

struct Shape {
  int dimension = 0, nodes = 0;
  int code = 0;                           // of the catalogue's element; 0 = a line or point
  const ElementEntry* element = nullptr;  // the same
};

using EntityKey = std::pair<int, int>;  // dimension, tag

struct MshElement {
  int number = 0;
  std::vector<int> nodes;  // indices, in this program's order
};

struct MshBlock {
  EntityKey entity;
  Shape shape;
  std::vector<MshElement> elements;
};

struct MshFile {
  std::map<EntityKey, std::string> names;          // of physical groups
  std::map<EntityKey, std::vector<int>> physical;  // entity -> physical tags
  std::map<int, Vector2> nodes;                    // by tag
  std::map<int, int> index;                        // tag -> index
  std::vector<MshBlock> blocks;
};

// Throws InputError with the line.  The elements outlive the result.
MshFile read_msh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements);

}  // namespace sage::msh
