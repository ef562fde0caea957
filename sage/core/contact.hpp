// Elements of contact (elements/contact.hpp) among those of interfaces: their two sides have no pairs of nodes.
#pragma once

#include "sage/core/catalogue.hpp"

namespace sage {

// An edge and the line that it may touch are apart, so what joins, cuts or checks pairs must leave them alone.
inline bool is_contact(const ElementEntry& entry) {
  return entry.interface() && entry.shape == ParentShape::line;
}

}  // namespace sage
