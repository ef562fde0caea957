// A layout with fields twice as wide, for decks whose numbers its own fields can't hold.
#pragma once

#include <string>
#include <string_view>

#include "sage/deck/layout.hpp"

namespace sage {

// The layout of decks whose first lines name none and bear no layout's marks.
inline constexpr std::string_view kStandardLayout = "sage1";

// "sage1_wide": sage1 with I10 for I5 and F20.0 for F10.0.  Made from sage1 by rule, so that what a card holds is
// written in one place.
inline constexpr std::string_view kWideLayout = "sage1_wide";

inline constexpr int kWideNodes = 15;  // of an element card

// Number fields have twice the columns, texts keep theirs; there are no sequence columns.  Behind what the narrow
// cards have, an element has nodes 9 to 15, a stage its duration and its strength factor.
Layout wide_layout(Layout layout);

// "(3I5,F10.0,A20)" -> "(3I10,F20.0,A20)"
std::string wide_format(std::string_view format);

}  // namespace sage
