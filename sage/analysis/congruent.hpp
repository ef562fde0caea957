// Elements of the same shape: one matrix serves them all.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// For every element of a group the number of its shape, counted from 0 in order of appearance.  Elements of one
// shape differ by a translation (along the axis only, when axisymmetric), to 1e-12 of their size: what element
// matrices can depend on.
std::vector<int> shapes_of(const Mesh& mesh, const Group& group, Geometry geometry);

}  // namespace sage
