// A field of both runs beside each other in one SVG, with one range of colours.
#pragma once

#include "sage/compare/side.hpp"
#include "sage/draw/picture.hpp"

namespace sage::compare {

// Of the last states in equilibrium.  A side without a state leaves its place empty, and says so.
std::string pair_svg(const Side& a, const Side& b, std::string_view field);

}  // namespace sage::compare
