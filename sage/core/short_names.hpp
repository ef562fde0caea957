// Parameters by the letters that engineers write for them.
#pragma once

#include <string_view>

#include "sage/core/catalogue.hpp"

namespace sage {

// Place of a parameter by its name, or by E, nu, c, phi, psi, gamma; -1 = there is none.
int parameter_place(const MaterialEntry& entry, std::string_view key);

}  // namespace sage
