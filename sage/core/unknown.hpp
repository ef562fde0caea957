// Fields of unknowns: what the equations are solved for at nodes.
#pragma once

#include <string>
#include <vector>

#include "sage/core/units.hpp"

namespace sage {

// Displacement has two components, along x (r) and y (z); any other field is one number a node.
struct UnknownField {
  std::string name;                       // "pore_pressure"
  Dimension dimension = Dimension::none;  // of the unknown
  std::string load = "load";              // what its equation balances: "force", "flux"
  Dimension load_dimension = Dimension::none;
  // What comes in through loads and held nodes goes out through others: no element keeps or makes any of it.
  bool balanced = true;
  // Turns with the body, counter-clockwise: held, it stops a rigid rotation; zero on an axis of symmetry.
  bool turns = false;

  // Excess pressure of pore water.  The stage says whether it is kept, shut in or lets water flow (Stage::pores); a held
  // one has its own value, whatever it was before (docs/decisions/0070).
  bool of_pores = false;

  bool displacement() const { return name == "displacement"; }
  int components() const { return displacement() ? 2 : 1; }
};

inline UnknownField displacement_field() {
  return {"displacement", Dimension::length, "force", Dimension::force};
}

// A field at some nodes of an element.
struct ElementUnknown {
  UnknownField field;
  std::vector<int> nodes{};  // local numbers; empty: all of them
};

inline constexpr int kMostFields = 8;  // of one model

}  // namespace sage
