// Built-in layouts as bytes: the build reads their TOML files once, a run takes them from memory.  Parsing them
// anew took a tenth of a small run.  The bytes are those of the program they were built with.
#pragma once

#include "sage/core/archive.hpp"
#include "sage/deck/layout.hpp"

namespace sage {

void exchange(Archive& archive, Layout& layout);

// The bytes of a layout begin with its marks: what tells which layout a deck has reads no further.
void exchange(Archive& archive, std::vector<LayoutMark>& marks);

}  // namespace sage
