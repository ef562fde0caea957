#pragma once

#include <string>
#include <vector>

#include "sage/layout_draft/cards.hpp"
#include "sage/layout_draft/scan.hpp"

namespace sage::layout_draft {

// The layout file of these cards.
std::string toml_text(const std::vector<CardDraft>& cards, const Facts& facts, const std::string& layout_name,
                      const std::string& deck_name);

}  // namespace sage::layout_draft
