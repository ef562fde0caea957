// One Fortran READ statement, run by the project's reader, with its outcome in a form that compares as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/deck/record.hpp"

namespace sage::test {

struct FortranCase {
  std::string format;  // "(I5)" or "*"
  BlankMode blanks = BlankMode::null;
  bool pad = true;
  std::string kinds;  // I, D (double), S (single), A (80 characters), L; one a value
  std::string text;   // the records, with their line ends
};

struct FortranOutcome {
  bool ok = false;
  std::string status;              // "ok", "error", "eof", "eor"
  std::vector<FieldValue> values;  // those read, up to the first that failed
  std::vector<std::string> items;  // the same as text: numbers by "%.17g", "unset" for a null value
  std::string next;                // the record that a following READ would see
};

FortranOutcome run_case(const FortranCase& given);

// "%.17g", with "-0" for minus zero.
std::string number_text(double value);

}  // namespace sage::test
