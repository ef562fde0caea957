// Numbers as text, fast: a table of results is mostly numbers, and a general formatter takes 100 to 140 ns for
// each.  Six digits take about 20 ns here.
#pragma once

#include <string>

namespace sage {

// "  1.2345E+01", right-justified in `width`: one digit, point, `digits` - 1 digits, two-digit exponent (three
// if needed).  digits 2 .. 15.  Zero (of either sign) is 0.0000E+00.
void append_scientific(std::string& text, double value, int width, int digits);

// Up to `digits` significant digits without trailing zeros, for files that programs read: 0.25, 1.5e-07, nan.
void append_plain(std::string& text, double value, int digits);

void append_integer(std::string& text, long value, int width);

}  // namespace sage
