// What pictures draw over a field: arrows of displacement, principal crosses, integration points.
#pragma once

#include "sage/draw/scenery.hpp"

namespace sage {

inline constexpr double kLongestArrow = 44.0;  // px

// Each appends to a picture what was asked for, and gives the line that explains it.

// From the nodes as they are drawn, thinned out to what can be told apart.
std::string draw_arrows(std::string& out, const Scenery& scenery);
// At integration points of solids, thinned out likewise; a pull is dashed.
std::string draw_crosses(std::string& out, const Scenery& scenery);
// All integration points: full where they yield (slip, are open, at the apex, cut off), else dots.
std::string draw_yielded(std::string& out, const Scenery& scenery);

}  // namespace sage
