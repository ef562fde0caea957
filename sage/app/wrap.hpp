// Text for a screen: lines that are too long go on below, broken between words.
#pragma once

#include <string>
#include <string_view>

namespace sage::app {

// Columns that help texts are written for.
inline constexpr int kHelpColumns = 80;

// Every line of `text` in at most so many columns, unless a single word is longer.  A line goes on below the text
// behind its first gap of two blanks ("  status      completed"), else below its own beginning.  Cards that are shown
// under a message ("   12 | ...") keep their columns.  Escapes that colour count nothing.
std::string wrapped(std::string_view text, int columns);

}  // namespace sage::app
