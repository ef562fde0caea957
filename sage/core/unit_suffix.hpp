// A unit behind a name, for people.
#pragma once

#include <string>

namespace sage {

// " [psi]"; empty where the unit is not known: blank, or made of a "-" of the units card.
std::string unit_suffix(const std::string& unit);

}  // namespace sage
