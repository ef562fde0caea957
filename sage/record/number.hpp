// Numbers as text, fast: a table of results is mostly numbers, and a general formatter takes 100 to 140 ns for
// each.  Six digits take about 20 ns here.
#pragma once

#include <span>
#include <string>

namespace sage {

// "  1.2345E+01", right-justified in `width`: one digit, point, `digits` - 1 digits, two-digit exponent (three
// if needed).  digits 2 .. 15.  Zero (of either sign) is 0.0000E+00.
void append_scientific(std::string& text, double value, int width, int digits);
// The same of several, one after the other.
void append_scientific(std::string& text, std::span<const double> values, int width, int digits);

// Up to `digits` significant digits without trailing zeros, for files that programs read: 0.25, 1.5e-07, nan.
// 17 digits give back every number as it is.
void append_plain(std::string& text, double value, int digits);

inline constexpr int kCsvDigits = 10;  // where nobody asks for more

// ",value" of a table for programs, which holds no inf and no nan.  A result is a finite number: anything else
// throws AnalysisError and leaves `text` as it was.  An optional one is blank where it is not known, does not
// apply or is beyond all numbers (the stress level of a point without strength).
void append_result_cell(std::string& text, double value, int digits = kCsvDigits);
void append_optional_cell(std::string& text, double value, int digits = kCsvDigits);

void append_integer(std::string& text, long value, int width);

}  // namespace sage
