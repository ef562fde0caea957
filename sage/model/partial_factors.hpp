// Sets of partial factors on actions, effects of actions and strengths, as those of EN 1997-1.  docs/manual/partial_factors.md
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct PartialFactors {
  std::string name;
  double permanent = 1.0, variable = 1.0;                        // on actions
  double structural_permanent = 1.0, structural_variable = 1.0;  // on those that come from a structure
  double effects = 1.0;                                          // on section forces
  double friction = 1.0, cohesion = 1.0, undrained = 1.0;        // divide tan(phi), c, and c where phi = 0
  double resistance = 1.0;  // divides the resistance of the ground as a whole

  // What a factor of safety of the model with these factors has to reach.
  double required() const { return effects * resistance; }
};

// "DA1-2", "DA1-1,DA1-2", or a set of one's own, "NAME:variable=1.3,friction=1.25": the values of the set of that name, or
// 1, where nothing is given.  Throws std::invalid_argument with what was expected.
std::vector<PartialFactors> partial_factors(std::string_view text);
// As partial_factors() reads it.
std::string text_of(const PartialFactors& set);
// The name as a part of a file's name: "DA2star".
std::string factor_word(const PartialFactors& set);
// The names of all sets.
std::string names_of_factor_sets();

// Loads and pressures of these stages (from 1) are variable, or come from a structure; all others are permanent.
struct ActionStages {
  std::vector<int> variable, structural;
};

// Multiplies gravity, loads and pressures, and divides strengths of soil and interfaces; makes the laws anew.  A sentence
// that says what was done.
std::string apply_factors(Model& model, const PartialFactors& set, const ActionStages& stages);

// Materials of solids that are not elastic but name no strength that the set could divide, each with its groups:
// "2 clay (modified_cam_clay) of group 1 crust".  Their strength stays characteristic.
std::vector<std::string> undivided_materials(const Model& model, const PartialFactors& set);

}  // namespace sage
