#include "elements/register_elements.hpp"

namespace sage {

void register_elements(Catalogue& /*catalogue*/) {}

}  // namespace sage
