// List-directed decks of textbook programs that compute what this one does not.
#pragma once

#include <string>

#include "sage/deck/source.hpp"

namespace sage {

// "program 7.2 of Smith and Griffiths: steady seepage" if the deck reads as one of those programs reads it, from
// the first number to the last; empty otherwise.
std::string other_program(const SourceText& source);

}  // namespace sage
