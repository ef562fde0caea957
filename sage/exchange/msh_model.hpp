// A mesh from Gmsh as the skeleton of a model: physical surfaces become groups, physical curves supports and
// pressures by their names.
#pragma once

#include <string>
#include <string_view>

#include "sage/core/catalogue.hpp"
#include "sage/model/model.hpp"

namespace sage {

// What a mesh can't say; zeros are placeholders that `sagefe check` refuses with the card to fill in.
struct MshOptions {
  Geometry geometry = Geometry::plane_strain;
  double youngs_modulus = 0.0, poissons_ratio = 0.0, unit_weight = 0.0;
};

// MSH 4.1 ASCII.  Curves named fix_x, fix_y, fix_xy hold their nodes; pressure=100 (or pressure:100) loads the
// edges in the only stage, together with gravity.  Other curves are left out with a warning.  Elements listed
// clockwise are turned round.  The laws are not made: the model is for writing, not for running.
// Throws InputError with the line, or for constants that no material has.
Model model_from_msh(std::string_view text, const std::string& file, const Catalogue& catalogue,
                     const MshOptions& options);

}  // namespace sage
