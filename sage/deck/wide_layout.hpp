// A layout with fields twice as wide, for decks whose numbers its own fields can't hold.
#pragma once

#include <string>
#include <string_view>

#include "sage/deck/layout.hpp"

namespace sage {

// "sage1_wide": sage1 with I10 for I5 and F20.0 for F10.0.  Made from sage1 by rule, so that what a card holds is
// written in one place.
inline constexpr std::string_view kWideLayout = "sage1_wide";

// Number fields and cards have twice the columns, texts keep theirs; there are no sequence columns.
Layout wide_layout(Layout layout);

// "(3I5,F10.0,A20)" -> "(3I10,F20.0,A20)"
std::string wide_format(std::string_view format);

}  // namespace sage
