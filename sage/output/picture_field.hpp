// The values that a picture shows.
#pragma once

#include "sage/output/nodal_values.hpp"
#include "sage/output/picture.hpp"

namespace sage {

// "sig-z [psi], compression positive"
std::string describe_field(const Model& model, Field field);

// The field at the entries of a layout, signs as people read them; 0 at interfaces.
std::vector<double> field_values(const Model& model, const Solution& solution, const NodalLayout& layout,
                                 Field field);

}  // namespace sage
