// What a mesh file of another program says (Gmsh MSH 2 and 4.1, Abaqus and CalculiX .inp); mesh_model.hpp gives it meaning.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"

namespace sage {

struct MeshShape {
  int dimension = 0, nodes = 0;
  int code = 0;                           // of the catalogue's element; 0 = a line or point
  const ElementEntry* element = nullptr;  // the same
};

struct ForeignMeshElement {
  int number = 0;
  std::vector<int> nodes;  // indices, in this program's order
  int line = 0;            // of the file; 0: it has none
};

// Elements of one shape with the same names.
struct MeshBlock {
  MeshShape shape;
  std::vector<std::string> names;  // of physical groups or sets
  std::string otherwise;           // the name of an area without one: "surface 3"
  std::vector<ForeignMeshElement> elements;
};

// Nodes, and edges of surface elements, by a name.
struct MeshSet {
  std::vector<int> nodes;                       // indices
  std::vector<std::pair<int, int>> edges = {};  // element number, edge from 0
};

enum class MeshFamily { any, plane, axisymmetric };  // what the elements' types say

struct ForeignMesh {
  std::map<int, Vector2> nodes;  // by number
  std::map<int, double> z;       // the same
  std::map<int, int> index;      // number -> index
  std::vector<MeshBlock> blocks;
  std::map<std::string, MeshSet> sets;  // besides the blocks
  MeshFamily family = MeshFamily::any;
  Diagnostics diagnostics;  // what was left out

  void number_nodes();
  void note(Severity severity, Code code, const std::string& file, const std::string& text) {
    diagnostics.add({severity, code, {file, 0, 0, 0}, text, {}});
  }
};

// Gmsh's type of a point, and of a line of so many nodes; 0 = it has none.
inline constexpr int kGmshPoint = 15;
int gmsh_line_type(std::size_t nodes);

// "a count of 3 nodes": the numbers of a file as text; empty, or text that is no number, gives false.
bool read_number(std::string_view text, double& value);
bool read_number(std::string_view text, int& value);

// Both throw InputError with the line.  The catalogue's elements outlive the result.
ForeignMesh read_msh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements);
ForeignMesh read_inp(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements);

// By what stands in it: the text of MSH begins with $MeshFormat, everything else is .inp.
ForeignMesh read_mesh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements);

}  // namespace sage
