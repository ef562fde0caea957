// A UMAT as a law, and its entry of the catalogue.
#pragma once

#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/umat/call.hpp"

namespace sage::umat {

inline constexpr int kUmatCode = 100;

// --umat [MATERIAL=]LIBRARY[:SYMBOL]: the routine of the materials of that name, or of all.
struct Binding {
  std::string material;  // lower case; empty: all that have none of their own
  Routine routine;
};
// Loads the library.  Throws std::runtime_error.
Binding bind(const std::string& text);

// Law `umat`; a material finds its routine by its name.
MaterialEntry umat_entry(std::vector<Binding> bindings);

// What SIGINI and SDVINI of the routine's library state, where it has them.
OwnStart own_start(Setup setup);

// The law of one routine.  Throws AnalysisError in update() where the routine breaks its contract, calls XIT or
// executes STOP: with routine, element, point, place and time.
std::unique_ptr<SolidLaw> umat_law(Setup setup);

// Where a routine last returned what is no finite number, in words behind its name; empty: nowhere since this was
// asked last.
std::string take_not_finite();

// What routines did that a user should know, a line each, once a routine; each is given once.
std::vector<std::string> take_notes();

}  // namespace sage::umat
