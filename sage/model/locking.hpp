// Which groups hardly change their volume, so that elements which lock do.
#pragma once

#include "sage/model/model.hpp"

namespace sage {

// Poisson's ratio above 0.45, or undrained.
bool nearly_incompressible(const Model& model, const Group& group);
// Poisson's ratio of a material, 0 where its law has none.
double poissons_ratio(const Material& material);

}  // namespace sage
