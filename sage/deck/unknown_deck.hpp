// What to say of a deck that bears the marks of no layout and that the standard layout does not fit.
#pragma once

#include <optional>

#include "sage/deck/layout.hpp"
#include "sage/deck/source.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// `problems`: from reading the deck as `standard`.  Nothing where it looks like a deck of that layout with
// mistakes in it: then the mistakes are what its author wants to see.  Otherwise an error that comes first and
// names the layouts (and those that read the deck without a mistake), then the first of the problems.
std::optional<Diagnostics> no_layout_fits(const SourceText& source, const Layout& standard,
                                          const Diagnostics& problems);

// A note that says so where a deck without marks was read as `standard` and its first cards, units and control, have
// mistakes: with the other layouts, and the way to a new one.
std::optional<Diagnostic> read_as_standard(const SourceText& source, const Layout& standard,
                                           const Diagnostics& problems);

// A note that names the built-in layouts, others than `layout`, that read the deck without an error or a warning:
// a deck with a mistake under its own layout, and with none under another, was perhaps written for that.  Empty
// where there are none.
std::optional<Diagnostic> other_layouts_that_read(const SourceText& source, const std::string& layout);

// An error that names what the deck computes, where it reads as one of those programs that do what this one does not.
std::optional<Diagnostics> outside_of_scope(const SourceText& source);

}  // namespace sage
