// A triaxial specimen on a hyperbolic platen interface, as in the source chapter (Tables 7.3, 7.4), in variants
// that must not change the answer: units, numbering, order of elements, place and direction of the axis.
#pragma once

#include <functional>
#include <optional>

#include "tests/studies/scenes/deck_writer.hpp"

namespace sage::scenes {

struct SpecimenVariant {
  double length = 1.0, stress = 1.0;  // factors on every length and every stress
  std::function<int(int)> number;     // of a node, from its number in the plain deck; empty = the same
  bool elements_backwards = false;    // cards from the last element to the first
  double shift = 0.0;                 // of the whole specimen along z, before `length`
  bool mirrored = false;              // z -> -z: the platen comes from below
};

// What holds the loaded end: a rigid platen on an interface, or its own nodes with (pinned) or without (smooth) their
// radial displacement.
enum class SpecimenEnd { platen, pinned, smooth };

// Of the platen's hyperbolic interface (law 22, no hyperbola): friction angle in degrees, k_j and n of its stiffness.
struct PlatenFriction {
  double phi = 28.5, k_j = 5000.0, exponent = 0.9;
};

struct SpecimenDeck {
  int columns = 6, rows = 12, increments = 20, method = 0, max_iterations = 0, output_every = 0;
  bool drucker_prager = false;
  double axial_strain = 0.10;
  // Sizes whose parts are short decimals: ten columns of a card then hold them exactly.
  double radius = 1.5, height = 3.0;  // of the quarter
  double cell = 50.0;                 // pressure; the specimen starts from it, the interface from zero
  double young = 3000.0;
  std::optional<double> poisson{};           // empty: .25, or .495 of the Drucker-Prager specimen
  std::optional<int> formulation{};          // of quad4; empty: full, or B-bar of the Drucker-Prager specimen
  std::optional<PlatenFriction> friction{};  // empty: k_j = 5000, or 120 with the Drucker-Prager specimen
  bool elastic_beyond_apex = false;          // Drucker-Prager: mean tension leaves the mean stress elastic
  SpecimenEnd end = SpecimenEnd::platen;
  double normal_stiffness = 1e9;  // of the interface, in stress / length
  SpecimenVariant variant;

  std::string text() const;
  std::vector<int> platen() const;       // node numbers of what is moved: the platen, or the end itself
  std::vector<int> solid_nodes() const;  // of the specimen, in the plain deck's order

 private:
  bool has_platen() const { return end == SpecimenEnd::platen; }
  void write_materials(DeckWriter& deck) const;
  void write_elements(DeckWriter& deck) const;
  void write_supports(DeckWriter& deck) const;
  void write_cell(StageCards& stage) const;
  void write_stages(DeckWriter& deck) const;
};

}  // namespace sage::scenes
