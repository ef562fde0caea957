// A safety factor for people: the page, the table and the two pictures.
#pragma once

#include <string>

#include "sage/safety/safety.hpp"

namespace sage::safety {

// "stands", "falls" or "undecided".
const char* verdict_word(Verdict verdict);
// "between 1.375 and 1.38125", "above 20": what is known.
std::string bracket_words(const Safety& found);

// "anchors: group 20 (tie)".
std::string part_words(const Group& group);

// What was divided, a row a factor, and both ends with their reasons.
std::string to_text(const Model& model, const Options& options, const Safety& found);
// A row a factor, as they were tried.
std::string to_csv(const Model& model, const Safety& found, int digits);
// The factor against the largest displacement since the strengths began to fall, with the bracket.
std::string curve_svg(const Model& model, const Safety& found);
// Increment of shear strain and of displacement of the mechanism; empty where there is none.
std::string mechanism_svg(Model& model, const Safety& found);

}  // namespace sage::safety
