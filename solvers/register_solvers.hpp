// Fills the catalogue with every entry of this folder.  Called once by the application and by tests.
#pragma once

#include "sage/core/catalogue.hpp"

namespace sage {

void register_solvers(Catalogue& catalogue);

}  // namespace sage
