// Hyperbolic E of Duncan with the hyperbolic bulk modulus of Selig (1988), as culvert programs have them.
// docs/theory/duncan_selig.md
#pragma once

#include "materials/parameters.hpp"

namespace sage {

MaterialEntry duncan_selig_entry();

}  // namespace sage
