// A triaxial specimen on a hyperbolic platen interface, as in the source chapter (Tables 7.3, 7.4), in variants
// that must not change the answer: units, numbering, order of elements, place and direction of the axis.
#pragma once

#include <functional>

#include "sage/scenes/deck_writer.hpp"

namespace sage::scenes {

struct SpecimenVariant {
  double length = 1.0, stress = 1.0;  // factors on every length and every stress
  std::function<int(int)> number;     // of a node, from its number in the plain deck; empty = the same
  bool elements_backwards = false;    // cards from the last element to the first
  double shift = 0.0;                 // of the whole specimen along z, before `length`
  bool mirrored = false;              // z -> -z: the platen comes from below
};

struct SpecimenDeck {
  int columns = 6, rows = 12, increments = 20, method = 0, max_iterations = 0, output_every = 0;
  bool drucker_prager = false;
  double axial_strain = 0.10;
  double normal_stiffness = 1e9;  // of the interface, in stress / length; E of the specimen is 3000
  SpecimenVariant variant;

  std::string text() const;
  std::vector<int> platen() const;       // node numbers
  std::vector<int> solid_nodes() const;  // of the specimen, in the plain deck's order
};

}  // namespace sage::scenes
