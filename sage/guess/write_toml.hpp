#pragma once

#include <string>
#include <vector>

#include "sage/guess/cards.hpp"
#include "sage/guess/scan.hpp"

namespace sage::guess {

// The layout file of these cards.
std::string toml_text(const std::vector<CardGuess>& cards, const Facts& facts, const std::string& layout_name,
                      const std::string& deck_name);

}  // namespace sage::guess
