// Models as input of this and other programs.  What a format can't hold is left out with a warning; elements
// that it lacks are written by their corners, with one too.
#pragma once

#include <string>
#include <vector>

#include "sage/model/model.hpp"
#include "sage/model/msh_numbers.hpp"

namespace sage {

// A number in at most `width` characters as a FORMAT with F reads it.  The shortest text that reads back as the
// same double if one fits (then `exact`), else the nearest one that fits.
struct FieldText {
  std::string text;
  bool exact = true;
  double change = 0.0;  // relative
};
FieldText field_text(double value, int width);

enum class FieldWidth {
  as_needed,  // narrow, and wide where narrow cards can't hold the model as it is
  narrow,     // real numbers are rounded to ten columns; wide only where anything else needs it
  wide
};

// A deck of layout sage1, every node and element on a card of its own; of layout sage1_wide, which its first
// line names, where fields are wide.  Numbers that a field can't hold exactly are written as near as possible; a
// warning tells how many and the largest relative change.  Nodes that the program made between those of an
// element's card are left to be made again.  Throws InputError for what no card can hold (elements whose cards
// would give more than 15 nodes).
std::string sage1_text(const Model& model, Diagnostics& diagnostics, FieldWidth width = FieldWidth::as_needed);

// Gmsh MSH 4.1 ASCII: nodes and elements with their numbers, groups as physical surfaces, interfaces as the
// physical curves of their two sides, held boundary edges as physical curves fix_x, fix_y, fix_xy.
std::string msh_text(const Model& model, Diagnostics& diagnostics);

// The same for files that hold more than a mesh: without a word about what a mesh can't say.
struct MshMesh {
  std::string text;           // or bytes
  std::vector<int> elements;  // numbers in the order of the file, with those of lines
};
MshMesh msh_mesh(const Model& model, MshForm form, Diagnostics& diagnostics);

// Abaqus-style input for CalculiX: mesh, sets, elastic constants, supports and loads step by step.
std::string inp_text(const Model& model, Diagnostics& diagnostics);

}  // namespace sage
