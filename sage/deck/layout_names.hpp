// The names that give a layout's cards and fields a meaning: those that the model builder asks for.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "sage/deck/layout.hpp"

namespace sage {

// What a layout file says of its names beyond the Layout; cards and fields by their places.
struct NameMarks {
  std::set<int> ignored_cards;
  std::set<std::pair<int, int>> ignored_fields;
  std::set<std::pair<int, int>> in_expressions;
  std::map<std::pair<int, int>, int> lines;
};

// Throws InputError with every name that nothing uses and that isn't marked as ignored, every name
// that the model builder needs and nobody gives, and every card that doesn't belong to the card
// that it is looked for under.
void check_names(const Layout& layout, const NameMarks& marks);

// The same, from the text of a layout file.
Layout load_checked_layout(std::string_view toml, const std::string& file);

}  // namespace sage
