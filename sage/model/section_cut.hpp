// A straight cut through the solids, and the parts of it that lie in them.
#pragma once

#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// Part of a cut within one element, or along the edge of elements.  Ways from the first end of the cut.
struct CutPiece {
  double from = 0.0, to = 0.0;
};

// Rising, without overlap.  The parts in active groups (in `group` alone where that is not negative); `active` by group, empty
// = all are.  Between two pieces that do not touch there is no solid.
std::vector<CutPiece> cut_pieces(const Model& model, const Vector2& first, const Vector2& last,
                                 const std::vector<char>& active, int group);

}  // namespace sage
