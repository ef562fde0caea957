// Elements of the same shape: one matrix serves them all.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// For every element of a group the number of its shape, counted from 0 in order of appearance.  Elements of one
// shape differ by a translation (along the axis only, when axisymmetric) and the rounding of coordinates:
// element matrices can depend on nothing else.
std::vector<int> shapes_of(const Mesh& mesh, const Group& group, Geometry geometry);

}  // namespace sage
