#include "solvers/register_solvers.hpp"

namespace sage {

void register_solvers(Catalogue& /*catalogue*/) {}

}  // namespace sage
